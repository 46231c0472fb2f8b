#pragma once

#include <cstddef>
#include <functional>

namespace pcl_symmetry {

/// The only place that starts threads: runs independent blocks, whose number does not depend on the number of threads,
/// so that results merged in block order are the same bytes for any number of threads.

/// \param num_threads 0 = one per core. \return at least 1.
int resolveNumThreads(int num_threads);

/// Calls block(0) ... block(num_blocks - 1), each once, in any order; the first exception is thrown again here.
void parallelBlocks(std::size_t num_blocks, int num_threads, const std::function<void(std::size_t)>& block);

/// Splits [0, size) into pieces of \p block_size and calls range(begin, end) for each, in any order.
void parallelRanges(std::size_t size, std::size_t block_size, int num_threads,
                    const std::function<void(std::size_t, std::size_t)>& range);

}  // namespace pcl_symmetry
