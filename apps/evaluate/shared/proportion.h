/// A rate among counted cases, and what the count says about the true rate.
#pragma once

#include <string>

namespace pcl_symmetry::apps {

struct Interval {
  double low, high;
};

struct Proportion {
  int count = 0, total = 0;

  void add(bool yes) {
    count += yes ? 1 : 0;
    ++total;
  }

  Proportion& operator+=(const Proportion& more) {
    count += more.count;
    total += more.total;
    return *this;
  }

  /// \return in [0, 1]; NaN where nothing was counted.
  double rate() const;

  /// The 95 % interval of Wilson (1927), which holds for few cases and for rates near 0 and 1 too. It treats the cases
  /// as independent.
  /// \return within [0, 1]; [0, 1] where nothing was counted.
  Interval wilson() const;

  /// \return e.g. "97.7 % of 217 (94.7 to 99.0)"; a dash where nothing was counted.
  std::string text() const;
};

}  // namespace pcl_symmetry::apps
