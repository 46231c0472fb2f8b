#include "pcl_symmetry/impl/completion.hpp"

#include <pcl/point_types.h>
#include <pcl/impl/instantiate.hpp>

PCL_INSTANTIATE(completeBySymmetry, PCL_XYZ_POINT_TYPES)
