/// The values of flags: numbers in a range, lists, vectors and viewpoints, each read from text or rejected with its
/// rule.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "command_line/tool_errors.h"
#include "pcl_symmetry/viewpoint.h"

namespace pcl_symmetry::apps {

/// An interval of allowed values; the ends belong to it unless marked open.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_open = false;
  bool max_open = false;

  static Range atLeast(double min) { return {min, std::numeric_limits<double>::infinity(), false, false}; }
  static Range above(double min) { return {min, std::numeric_limits<double>::infinity(), true, false}; }
  static Range closed(double min, double max) { return {min, max, false, false}; }
  static Range upTo(double above, double max) { return {above, max, true, false}; }
  static Range open(double min, double max) { return {min, max, true, true}; }

  bool contains(double value) const;

  /// \return the rule in words, e.g. "must be >= 0".
  std::string rule() const;
};

/// \throws UsageError `name = value, rule`.
[[noreturn]] void rejectValue(const std::string& name, const std::string& value, const std::string& rule);

// All throw UsageError starting with `name = text` if the text is not such a value as a whole.

double parseNumber(const std::string& name, const std::string& text, const Range& range = {});
std::int64_t parseInteger(const std::string& name, const std::string& text, const Range& range = {});
int parseInt(const std::string& name, const std::string& text, const Range& range = {});
/// "A,B,C", at least one.
std::vector<double> parseNumbers(const std::string& name, const std::string& text, const Range& range = {});
/// "X,Y,Z", all finite.
Eigen::Vector3d parseVector(const std::string& name, const std::string& text);
/// "auto", "none" or "X,Y,Z".
Viewpoint parseViewpoint(const std::string& name, const std::string& text);

}  // namespace pcl_symmetry::apps
