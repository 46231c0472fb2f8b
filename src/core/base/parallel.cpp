#include "core/base/parallel.h"

#include <omp.h>

#include <algorithm>
#include <exception>

namespace pcl_symmetry {

int resolveNumThreads(int num_threads) {
  return num_threads > 0 ? num_threads : std::max(1, omp_get_num_procs());
}

void parallelBlocks(std::size_t num_blocks, int num_threads, const std::function<void(std::size_t)>& block) {
  const int threads = static_cast<int>(std::min<std::size_t>(resolveNumThreads(num_threads), num_blocks));
  if (threads <= 1) {
    for (std::size_t b = 0; b < num_blocks; ++b) block(b);
    return;
  }
  std::exception_ptr failure;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (std::size_t b = 0; b < num_blocks; ++b) {
    try {
      block(b);
    } catch (...) {
#pragma omp critical
      if (!failure) failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
}

void parallelRanges(std::size_t size, std::size_t block_size, int num_threads,
                    const std::function<void(std::size_t, std::size_t)>& range) {
  parallelBlocks((size + block_size - 1) / block_size, num_threads,
                 [&](std::size_t b) { range(b * block_size, std::min(size, (b + 1) * block_size)); });
}

}  // namespace pcl_symmetry
