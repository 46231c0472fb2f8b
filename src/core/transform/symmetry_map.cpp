#include "pcl_symmetry/core/symmetry_map.h"

#include "pcl_symmetry/core/gaussian_edt.h"

namespace pcl_symmetry {

SymmetryMap SymmetryMap::zero(const GaussianEdt& edt, const PlaneGrid& grid, TransformMethod method) {
  return {grid, std::vector<float>(grid.size(), 0.0f), method, edt.sigma(), grid.center()};
}

}  // namespace pcl_symmetry
