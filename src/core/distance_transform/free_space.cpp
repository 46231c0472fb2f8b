#include "core/distance_transform/free_space.h"

#include "core/base/parallel.h"

namespace pcl_symmetry {

std::vector<float> freeSpace(const GaussianEdt& edt, const Visibility& visibility, int num_threads) {
  const std::size_t n = edt.numCells();
  const std::vector<float>& f = edt.values();
  std::vector<float> free(f.size(), 0.0f);
  parallelBlocks(n, num_threads, [&](std::size_t slice) {
    for (std::size_t i = slice * n * n; i < (slice + 1) * n * n; ++i)
      if (visibility.depthBehind(edt.cellCenter(i)) < 0.0) free[i] = 1.0f - f[i];
  });
  return free;
}

}  // namespace pcl_symmetry
