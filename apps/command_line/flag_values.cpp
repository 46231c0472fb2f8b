#include "command_line/flag_values.h"

#include <boost/algorithm/string.hpp>
#include <charconv>
#include <cmath>

#include "io/answers.h"
#include "io/file_text.h"

namespace pcl_symmetry::apps {

void rejectValue(const std::string& name, const std::string& value, const std::string& rule) {
  throw UsageError(name + " = " + value + ", " + rule);
}

bool Range::contains(double value) const {
  return (min_open ? value > min : value >= min) && (max_open ? value < max : value <= max);
}

std::string Range::rule() const {
  const bool has_min = std::isfinite(min), has_max = std::isfinite(max);
  std::string text = "must be ";
  if (has_min) text += formatted(min_open ? "> %g" : ">= %g", min);
  if (has_min && has_max) text += " and ";
  if (has_max) text += formatted(max_open ? "< %g" : "<= %g", max);
  return has_min || has_max ? text : "must be a number";
}

double parseNumber(const std::string& name, const std::string& text, const Range& range) {
  double value = 0.0;
  if (!spellsNumber(text, &value)) rejectValue(name, text, "must be a number");
  if (!std::isfinite(value)) rejectValue(name, text, "must be finite");
  if (!range.contains(value)) rejectValue(name, text, range.rule());
  return value;
}

std::int64_t parseInteger(const std::string& name, const std::string& text, const Range& range) {
  std::int64_t value = 0;
  const char* const begin = text.data() + (text.rfind('+', 0) == 0 ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range) rejectValue(name, text, "is too large");
  if (error != std::errc() || end != text.data() + text.size()) rejectValue(name, text, "must be a whole number");
  if (!range.contains(static_cast<double>(value))) rejectValue(name, text, range.rule());
  return value;
}

std::vector<double> parseNumbers(const std::string& name, const std::string& text, const Range& range) {
  std::vector<std::string> parts;
  boost::algorithm::split(parts, text, boost::is_any_of(","));
  std::vector<double> values;
  for (const std::string& part : parts) values.push_back(parseNumber(name, part, range));
  return values;
}

Eigen::Vector3d parseVector(const std::string& name, const std::string& text) {
  std::vector<std::string> parts;
  boost::algorithm::split(parts, text, boost::is_any_of(","));
  Eigen::Vector3d value;
  for (int i = 0; i < 3; ++i)
    if (parts.size() != 3 || !spellsNumber(parts[i], &value[i]) || !std::isfinite(value[i]))
      rejectValue(name, text, "must be three finite numbers X,Y,Z");
  return value;
}

int parseInt(const std::string& name, const std::string& text, const Range& range) {
  const std::int64_t value = parseInteger(name, text, range);
  if (value != static_cast<int>(value)) rejectValue(name, text, "is too large");
  return static_cast<int>(value);
}

Viewpoint parseViewpoint(const std::string& name, const std::string& text) {
  if (text == "auto") return {};
  if (text == "none") return {Viewpoint::Mode::None, Eigen::Vector3d::Zero()};
  try {
    return {Viewpoint::Mode::Given, parseVector(name, text)};
  } catch (const UsageError&) {
    rejectValue(name, text, "must be auto, none or X,Y,Z");
  }
}

}  // namespace pcl_symmetry::apps
