#include "core/transform/free_space.h"

#include "core/base/parallel.h"

namespace pcl_symmetry {

std::vector<float> freeSpace(const GaussianEdt& edt, const Visibility* visibility, int num_threads) {
  if (!visibility) return {};
  const std::size_t n = edt.numCells();
  const std::vector<float>& f = edt.values();
  std::vector<float> free(f.size(), 0.0f);
  parallelBlocks(n, num_threads, [&](std::size_t slice) {
    Eigen::Matrix3Xd centers(3, static_cast<Eigen::Index>(n));
    for (std::size_t first = slice * n * n; first < (slice + 1) * n * n; first += n) {
      centers.colwise() = edt.cellCenter(first);
      for (std::size_t x = 1; x < n; ++x) centers(0, x) = edt.origin().x() + edt.cellSize() * static_cast<double>(x);
      const std::vector<char> is_free = visibility->areFree(centers);
      for (std::size_t x = 0; x < n; ++x)
        if (is_free[x] != 0) free[first + x] = 1.0f - f[first + x];
    }
  });
  return free;
}

}  // namespace pcl_symmetry
