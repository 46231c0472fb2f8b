#pragma once

#include <chrono>

namespace pcl_symmetry {

/// Wall-clock time of the stages of a computation.
class Stopwatch {
public:
  /// \return milliseconds since the last call, or since construction.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double elapsed = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return elapsed;
  }

private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace pcl_symmetry
