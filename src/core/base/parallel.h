/// The only place that starts threads. In every function and struct num_threads is >= 0, and 0 = one per core.
///
/// Work is cut into independent blocks whose number does not depend on the number of threads. Results that are merged
/// in block order are therefore the same bytes for any number of threads.
#pragma once

#include <cstddef>
#include <functional>

namespace pcl_symmetry {

/// \return number of threads to start, at least 1.
int resolveNumThreads(int num_threads);

/// Calls block(0) ... block(num_blocks - 1), each once, in any order. Of a call in a block of another call, threads
/// that have finished the other call's blocks take their part.
/// \throws whatever a block throws; the first exception if several do.
void parallelBlocks(std::size_t num_blocks, int num_threads, const std::function<void(std::size_t)>& block);

/// Cuts [0, size) into pieces of \p block_size and calls range(begin, end) for each, in any order.
/// \throws whatever a call throws; the first exception if several do.
void parallelRanges(std::size_t size, std::size_t block_size, int num_threads,
                    const std::function<void(std::size_t, std::size_t)>& range);

/// The same for points, whose pieces are large enough that threads start seldom and small enough for the first cache.
void parallelPoints(std::size_t size, int num_threads, const std::function<void(std::size_t, std::size_t)>& range);

}  // namespace pcl_symmetry
