#include <pcl/point_types.h>

#include <cmath>

#include "pcl_symmetry/features/impl/prst.hpp"

namespace pcl_symmetry {

float descriptorDistance(const PRSTSignature32768& a, const PRSTSignature32768& b) {
  return planeDescriptorDistance(a.prst, b.prst, kPRSTSize);
}

float descriptorDistance(const PRSDSignature1024& a, const PRSDSignature1024& b) {
  return planeDescriptorDistance(a.prsd, b.prsd, kPRSDSize);
}

float descriptorDistance(const GEDTSignature32768& a, const GEDTSignature32768& b) {
  return std::sqrt(sqDistance(a.gedt, b.gedt, kGEDTSize));
}

float productDistance(const PRSTSignature32768& prst_a, const GEDTSignature32768& gedt_a,
                      const PRSTSignature32768& prst_b, const GEDTSignature32768& gedt_b) {
  return descriptorDistance(prst_a, prst_b) * descriptorDistance(gedt_a, gedt_b);
}

}  // namespace pcl_symmetry

PCL_INSTANTIATE_PRSTEstimation(pcl::PointXYZ, pcl_symmetry::PRSTSignature32768)
    PCL_INSTANTIATE_PRSTEstimation(pcl::PointXYZI, pcl_symmetry::PRSTSignature32768)
        PCL_INSTANTIATE_PRSTEstimation(pcl::PointXYZRGB, pcl_symmetry::PRSTSignature32768)
            PCL_INSTANTIATE_PRSTEstimation(pcl::PointXYZRGBA, pcl_symmetry::PRSTSignature32768)
                PCL_INSTANTIATE_PRSTEstimation(pcl::PointNormal, pcl_symmetry::PRSTSignature32768)
                    PCL_INSTANTIATE_PRSTEstimation(pcl::PointXYZRGBNormal, pcl_symmetry::PRSTSignature32768)
