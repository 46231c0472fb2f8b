#pragma once

#include <sstream>
#include <stdexcept>

namespace pcl_symmetry {

/// Throws std::invalid_argument "field = value, must be rule" unless \p valid.
template <typename T>
void check(bool valid, const char* field, const T& value, const char* rule) {
  if (valid) return;
  std::ostringstream message;
  message << field << " = " << value << ", must be " << rule;
  throw std::invalid_argument(message.str());
}

inline void checkNumThreads(int num_threads) {
  check(num_threads >= 0, "num_threads", num_threads, ">= 0");
}

}  // namespace pcl_symmetry
