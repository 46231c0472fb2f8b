#include "bop/isaac_axes.h"

#include <boost/algorithm/string.hpp>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <sstream>

#include "command_line/flag_values.h"
#include "io/file_text.h"
#include "core/base/constants.h"

namespace pcl_symmetry::apps {

namespace {

// Angle between an axis and a coordinate axis that counts as none. chosen: half refuses hand-aligned models, twice
// moves the surface by a tenth of its size.
constexpr double kAligned = 5.0 * kDegree;

const std::string kNames = "xyz";

/// The order of the turns of a group about a coordinate axis; 0 for any angle.
int orderAbout(const ObjectSymmetries& symmetries, const Eigen::Vector3d& axis) {
  if (symmetries.kind == RotationGroupKind::Spherical) return 0;
  const auto is_along = [&](const Eigen::Vector3d& other) { return axis.cross(other).norm() < std::sin(kAligned); };
  if (!symmetries.continuous.empty() && is_along(symmetries.continuous.front().axis)) return 0;
  if (!symmetries.continuous.empty()) {
    const bool is_across = std::abs(axis.dot(symmetries.continuous.front().axis)) < std::sin(kAligned);
    return symmetries.kind == RotationGroupKind::Cylindrical && is_across ? 2 : 1;
  }
  std::vector<Eigen::Matrix3d> rotations;
  for (const Eigen::Isometry3d& motion : symmetries.discrete) rotations.push_back(motion.linear());
  for (const RotationAxis& found : axesOf(rotations))
    if (is_along(found.direction)) return found.order;
  return 1;
}

/// \return the text without blanks and quotes around it; nothing where other than letters, digits and _ . + - stand in it.
std::optional<std::string> wordIn(std::string text) {
  boost::algorithm::trim(text);
  boost::algorithm::trim_if(text, boost::algorithm::is_any_of("\"'"));
  const bool is_word =
      !text.empty() && boost::algorithm::all(text, boost::algorithm::is_alnum() || boost::algorithm::is_any_of("_.+-"));
  return is_word ? std::optional<std::string>(text) : std::nullopt;
}

/// A line `name: ["z_90", "z_180"]`, perhaps with a comment behind it.
struct AxesLine {
  std::string name;
  std::vector<std::string> axes;
};

/// \return nothing for any other line.
std::optional<AxesLine> axesLineOf(const std::string& line) {
  const std::size_t colon = line.find(':'), end = line.find(']');
  if (colon == std::string::npos || end == std::string::npos || end < colon) return std::nullopt;
  const std::size_t begin = line.find_first_not_of(" \t", colon + 1), behind = line.find_first_not_of(" \t\r", end + 1);
  if (line[begin] != '[' || (behind != std::string::npos && line[behind] != '#')) return std::nullopt;
  const std::optional<std::string> name = wordIn(line.substr(0, colon));
  if (!name) return std::nullopt;
  AxesLine result{*name, {}};
  std::vector<std::string> entries;
  const std::string list = line.substr(begin + 1, end - begin - 1);
  boost::algorithm::split(entries, list, boost::algorithm::is_any_of(","));
  for (std::string& entry : entries) {
    boost::algorithm::trim(entry);
    if (!entry.empty()) result.axes.push_back(wordIn(entry).value_or(entry));  // what is no word is no turn either
  }
  return result;
}

/// The number of rotations that the turns compose.
std::size_t numComposed(const ListedSymmetries& listed) {
  try {
    return ObjectSymmetries::from(listed.discrete, {}).discrete.size() + 1;
  } catch (const std::invalid_argument&) {
    return 0;
  }
}

}  // namespace

IsaacAxes isaacAxes(const ObjectSymmetries& symmetries) {
  IsaacAxes result;
  for (int k = 0; k < 3; ++k) {
    const int order = orderAbout(symmetries, Eigen::Vector3d::Unit(k));
    if (order == 0) result.axes.push_back(kNames.substr(k, 1) + "_full");
    for (int i = 1; i < order; ++i) result.axes.push_back(kNames.substr(k, 1) + "_" + shortest(360.0 * i / order));
  }
  const ListedSymmetries listed = symmetriesFromIsaac(result.axes, "axes");
  if (symmetries.continuous.empty()) {
    result.is_complete = numComposed(listed) == symmetries.discrete.size() + 1;
  } else {
    const ObjectSymmetries composed = ObjectSymmetries::from(listed.discrete, listed.continuous);
    result.is_complete = composed.kind == symmetries.kind;
  }
  return result;
}

ListedSymmetries symmetriesFromIsaac(const std::vector<std::string>& axes, const std::string& where) {
  ListedSymmetries listed;
  listed.is_composed = true;
  for (const std::string& text : axes) {
    const std::size_t axis = text.size() > 2 && text[1] == '_' ? kNames.find(text[0]) : std::string::npos;
    const std::string angle = axis == std::string::npos ? "" : text.substr(2);
    char* end = nullptr;
    const double degrees = std::strtod(angle.c_str(), &end);
    const bool is_number = !angle.empty() && *end == '\0' && std::isfinite(degrees);
    if (angle != "full" && !is_number)
      throw InputError(where + ": " + text + ", must be x, y or z with an angle in degrees or full, such as z_180");
    const Eigen::Vector3d direction = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(axis));
    if (angle == "full")
      listed.continuous.push_back({direction, Eigen::Vector3d::Zero()});
    else
      listed.discrete.emplace_back(Eigen::AngleAxisd(degrees * kDegree, direction));
  }
  return listed;
}

std::string isaacLine(const std::string& name, const std::vector<std::string>& axes) {
  std::string line = name + ": [";
  for (std::size_t i = 0; i < axes.size(); ++i) line += (i > 0 ? ", \"" : "\"") + axes[i] + "\"";
  return line + "]";
}

std::map<std::string, ListedSymmetries> readIsaacAxes(const std::string& path) {
  std::map<std::string, ListedSymmetries> models;
  std::istringstream lines(readWholeFile(path));
  for (std::string line; std::getline(lines, line);) {
    const std::optional<AxesLine> entry = axesLineOf(line);
    if (!entry) continue;
    models[entry->name == "symmetry_axes" ? "" : entry->name] =
        symmetriesFromIsaac(entry->axes, path + ": " + entry->name);
  }
  if (models.empty()) throw InputError(path + ": must be JSON, or have lines such as symmetry_axes: [\"z_180\"]");
  return models;
}

}  // namespace pcl_symmetry::apps
