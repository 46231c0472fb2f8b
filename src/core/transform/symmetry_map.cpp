#include "pcl_symmetry/core/symmetry_map.h"

#include <algorithm>

namespace pcl_symmetry {

std::size_t SymmetryMap::strongest() const {
  return std::max_element(values.begin(), values.end()) - values.begin();
}

}  // namespace pcl_symmetry
