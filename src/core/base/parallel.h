/// The only place that starts threads. In every function and struct num_threads is >= 0, and 0 = one per core.
///
/// Work is cut into independent blocks whose number does not depend on the number of threads. Results that are merged
/// in block order are therefore the same bytes for any number of threads.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>

namespace pcl_symmetry {

/// \return number of threads to start, at least 1.
int resolveNumThreads(int num_threads);

/// Calls block(0) ... block(num_blocks - 1), each once, in any order. Threads that have finished the blocks of an outer
/// call help with calls within its other blocks.
/// \throws whatever a block throws; the first exception if several do.
void parallelBlocks(std::size_t num_blocks, int num_threads, const std::function<void(std::size_t)>& block);

/// Cuts [0, size) into pieces of \p block_size and calls range(begin, end) for each, in any order.
/// \throws whatever a call throws; the first exception if several do.
void parallelRanges(std::size_t size, std::size_t block_size, int num_threads,
                    const std::function<void(std::size_t, std::size_t)>& range);

/// The same for points, in pieces that are large enough to start threads rarely and small enough for the first-level
/// cache.
void parallelPoints(std::size_t size, int num_threads, const std::function<void(std::size_t, std::size_t)>& range);

/// Reports the progress of the outermost loop of this thread several times a second while it lives. The callback can
/// cancel the computation.
class ProgressMonitor {
public:
  /// \param report receives the share of the blocks of parallelBlocks() that are done, in [0, 1]. An exception that it
  /// throws cancels that loop and all loops inside it.
  explicit ProgressMonitor(std::function<void(double)> report);
  ~ProgressMonitor();
  ProgressMonitor(const ProgressMonitor&) = delete;
  ProgressMonitor& operator=(const ProgressMonitor&) = delete;

private:
  friend struct Loop;

  std::function<void(double)> report_;
  ProgressMonitor* previous_;
  std::chrono::steady_clock::time_point last_;
  int depth_ = 0;  // number of nested loops that run
  double share_ = 0.0;
};

/// Throws if the progress callback of this thread has cancelled the computation. For code of one thread, between steps
/// of some microseconds or more; loops do this after each block.
/// \throws the exception of the callback; within a block, also if the loop of that block was cancelled.
void checkCancelled();

}  // namespace pcl_symmetry
