#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

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

/// Adds the milliseconds of one stage after another to a list.
class StageTimes {
public:
  explicit StageTimes(std::vector<std::pair<std::string, double>>& times) : times_(times) {}

  /// \param stage that ends here.
  void operator()(const char* stage) { times_.emplace_back(stage, watch_.lap()); }

private:
  std::vector<std::pair<std::string, double>>& times_;
  Stopwatch watch_;
};

}  // namespace pcl_symmetry
