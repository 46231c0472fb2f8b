#include <pcl/point_types.h>

#include "pcl_symmetry/impl/symmetry_registration.hpp"

PCL_INSTANTIATE_SymmetryRegistration(pcl::PointXYZ, pcl::PointXYZ, float)
    PCL_INSTANTIATE_SymmetryRegistration(pcl::PointXYZ, pcl::PointXYZ, double)
        PCL_INSTANTIATE_SymmetryRegistration(pcl::PointXYZI, pcl::PointXYZI, float)
            PCL_INSTANTIATE_SymmetryRegistration(pcl::PointXYZRGB, pcl::PointXYZRGB, float)
                PCL_INSTANTIATE_SymmetryRegistration(pcl::PointXYZRGBA, pcl::PointXYZRGBA, float)
                    PCL_INSTANTIATE_SymmetryRegistration(pcl::PointNormal, pcl::PointNormal, float)
                        PCL_INSTANTIATE_SymmetryRegistration(pcl::PointNormal, pcl::PointNormal, double)
                            PCL_INSTANTIATE_SymmetryRegistration(pcl::PointXYZRGBNormal, pcl::PointXYZRGBNormal, float)
