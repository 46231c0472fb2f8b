#include "evaluate/shared/proportion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "evaluate/shared/table_text.h"

namespace pcl_symmetry::apps {

namespace {

constexpr double kQuantile = 1.959963984540054;  ///< derived: of 97.5 % of the standard normal distribution

}  // namespace

double Proportion::rate() const {
  return total > 0 ? static_cast<double>(count) / total : std::numeric_limits<double>::quiet_NaN();
}

Interval Proportion::wilson() const {
  if (total == 0) return {0.0, 1.0};
  const double n = total, p = rate(), sq_z = kQuantile * kQuantile;
  const double middle = (p + sq_z / (2.0 * n)) / (1.0 + sq_z / n);
  const double half = kQuantile / (1.0 + sq_z / n) * std::sqrt(p * (1.0 - p) / n + sq_z / (4.0 * n * n));
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

std::string Proportion::text() const {
  if (total == 0) return "-";
  const Interval interval = wilson();
  return fixed(rate(), 1, 100) + " % of " + std::to_string(total) + " (" + fixed(interval.low, 1, 100) + " to " +
         fixed(interval.high, 1, 100) + ")";
}

}  // namespace pcl_symmetry::apps
