#pragma once

#include <chrono>
#include <functional>

namespace pcl_symmetry {

/// Tells, some times a second, how far the outermost loop of this thread is, as long as the object lives: a long call
/// becomes one that shows its progress and that can be ended.
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

}  // namespace pcl_symmetry
