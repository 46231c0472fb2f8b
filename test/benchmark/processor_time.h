/// Times that other programs on the machine hardly change.
#pragma once

#include <ctime>

#include <algorithm>
#include <limits>

namespace pcl_symmetry::benchmarks {

/// \return processor time of this thread, milliseconds.
inline double processorMilliseconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// Processor time of stages that follow each other in one thread.
class ProcessorStopwatch {
public:
  /// \return milliseconds since the last call, or since construction.
  double lap() {
    const double now = processorMilliseconds(), elapsed = now - last_;
    last_ = now;
    return elapsed;
  }

private:
  double last_ = processorMilliseconds();
};

/// Calls body() \p repeats times.
/// \return its least processor time in one thread, milliseconds.
template <typename Body>
double leastMilliseconds(int repeats, const Body& body) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < repeats; ++i) {
    ProcessorStopwatch watch;
    body();
    least = std::min(least, watch.lap());
  }
  return least;
}

}  // namespace pcl_symmetry::benchmarks
