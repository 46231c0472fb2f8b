#include "pcl_symmetry/impl/symmetry_alignment.hpp"

#include <pcl/point_types.h>
#include <pcl/impl/instantiate.hpp>

PCL_INSTANTIATE(SymmetryAlignment, PCL_XYZ_POINT_TYPES)
