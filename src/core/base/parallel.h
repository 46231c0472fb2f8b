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

/// Calls block(0) ... block(num_blocks - 1), each once, in any order. Threads that
/// have finished the blocks of an outer call help with calls within its other blocks.
/// \throws whatever a block throws; the first exception if several do.
void parallelBlocks(std::size_t num_blocks, int num_threads, const std::function<void(std::size_t)>& block);

/// Cuts [0, size) into pieces of \p block_size and calls range(begin, end) for each, in any order.
/// \throws whatever a call throws; the first exception if several do.
void parallelRanges(std::size_t size, std::size_t block_size, int num_threads,
                    const std::function<void(std::size_t, std::size_t)>& range);

/// The same for points, whose pieces are large enough that threads start seldom and small enough for the first cache.
void parallelPoints(std::size_t size, int num_threads, const std::function<void(std::size_t, std::size_t)>& range);

/// While it lives, reports several times a second how far the outermost loop of this thread is, so that a long call can
/// show its progress and be ended.
class Watch {
public:
  /// \param tell takes the share of the blocks of parallelBlocks() that are done, in [0, 1]. What it throws ends that
  /// loop and those inside.
  explicit Watch(std::function<void(double)> tell);
  ~Watch();
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

private:
  friend struct Loop;

  std::function<void(double)> tell_;
  Watch* former_;
  std::chrono::steady_clock::time_point last_;
  int depth_ = 0;  // of the loops that run
  double share_ = 0.0;
};

/// Ends the call where its Watch asks for that: for code of one thread, between steps of some microseconds and more.
/// Loops do this after each block.
/// \throws what the watch throws; in a block of a loop, also where the loop was ended.
void lookAtWatch();

}  // namespace pcl_symmetry
