#include "pcl_symmetry/impl/planar_symmetry_transform.hpp"

#include <pcl/point_types.h>
#include <pcl/impl/instantiate.hpp>

PCL_INSTANTIATE(PlanarSymmetryTransform, PCL_XYZ_POINT_TYPES)
