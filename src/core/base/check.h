#pragma once

#include <sstream>
#include <stdexcept>

namespace pcl_symmetry {

/// Throws for a bad parameter, with a message that names field, value and rule: "sigma = -1, must be > 0".
/// \param valid whether the value obeys the rule.
/// \param rule the rule as it reads after "must be".
/// \throws std::invalid_argument unless \p valid.
template <typename T>
void check(bool valid, const char* field, const T& value, const char* rule) {
  if (valid) return;
  std::ostringstream message;
  message << field << " = " << value << ", must be " << rule;
  throw std::invalid_argument(message.str());
}

/// \throws std::invalid_argument for a negative number; 0 means one thread per core.
inline void checkNumThreads(int num_threads) {
  check(num_threads >= 0, "num_threads", num_threads, ">= 0");
}

}  // namespace pcl_symmetry
