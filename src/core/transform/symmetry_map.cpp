#include "pcl_symmetry/core/symmetry_map.h"

#include <algorithm>

#include "pcl_symmetry/core/gaussian_edt.h"

namespace pcl_symmetry {

std::size_t SymmetryMap::strongest() const {
  return std::max_element(values.begin(), values.end()) - values.begin();
}

SymmetryMap SymmetryMap::zero(const GaussianEdt& edt, const PlaneGrid& grid, TransformMethod method) {
  return {grid, std::vector<float>(grid.size(), 0.0f), method, edt.sigma(), grid.center()};
}

}  // namespace pcl_symmetry
