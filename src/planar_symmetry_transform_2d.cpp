#include "pcl_symmetry/impl/planar_symmetry_transform_2d.hpp"

#include <pcl/point_types.h>
#include <pcl/impl/instantiate.hpp>

PCL_INSTANTIATE(PlanarSymmetryTransform2D, PCL_XYZ_POINT_TYPES)
