#include "bop/models_info.h"

#include <boost/algorithm/string.hpp>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "core/base/constants.h"
#include "core/geometry/directions.h"
#include "io/answers.h"
#include "io/file_text.h"

namespace pcl_symmetry::apps {

namespace {

constexpr double kRotationError = 0.02;  // greatest entry of R R^T - I for a rotation in a file

using nlohmann::json;
using nlohmann::ordered_json;

std::vector<double> finiteNumbers(const json& value, std::size_t size, const std::string& where) {
  const std::string rule = where + ", must be " + std::to_string(size) + " finite numbers";
  if (!value.is_array() || value.size() != size) throw InputError(rule);
  std::vector<double> numbers;
  for (const json& number : value) {
    if (!number.is_number() || !std::isfinite(number.get<double>())) throw InputError(rule);
    numbers.push_back(number.get<double>());
  }
  return numbers;
}

/// 16 numbers row by row, or four rows of four.
Eigen::Isometry3d motionFrom(const json& value, const std::string& where) {
  json flat = value;
  if (value.is_array() && value.size() == 4 && value[0].is_array()) {
    flat = json::array();
    for (const json& row : value)
      for (const json& number : row) flat.push_back(number);
  }
  const std::vector<double> numbers = finiteNumbers(flat, 16, where);
  Eigen::Isometry3d motion;
  motion.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
  const Eigen::Matrix3d R = motion.linear();
  const bool is_rotation = (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= kRotationError &&
                           R.determinant() > 0.0;
  const bool is_affine = motion.matrix().row(3) == Eigen::RowVector4d(0, 0, 0, 1);
  if (!is_rotation || !is_affine) throw InputError(where + ", must be a rigid motion: a rotation and a translation");
  motion.linear() = Eigen::Quaterniond(R).normalized().toRotationMatrix();
  return motion;
}

ContinuousSymmetry axisFrom(const json& value, const std::string& where) {
  if (!value.is_object() || !value.contains("axis")) throw InputError(where + ", must have the field axis");
  ContinuousSymmetry symmetry;
  symmetry.axis = Eigen::Vector3d(finiteNumbers(value["axis"], 3, where + ".axis").data());
  symmetry.offset = Eigen::Vector3d::Zero();
  if (value.contains("offset"))
    symmetry.offset = Eigen::Vector3d(finiteNumbers(value["offset"], 3, where + ".offset").data());
  if (!(symmetry.axis.norm() > 0.0)) throw InputError(where + ".axis = 0 0 0, must not be zero");
  symmetry.axis.normalize();
  return symmetry;
}

const json& listOf(const json& entry, const char* field, const std::string& where) {
  static const json none = json::array();
  if (!entry.contains(field)) return none;
  if (!entry[field].is_array()) throw InputError(where + ": " + field + " must be a list");
  return entry[field];
}

constexpr std::size_t kShownOfName = 40;  // bytes of a name that a message shows

/// A name as it is in the file, on one line: line breaks and the like stay escaped, and a long one is cut off.
std::string onOneLine(const std::string& name) {
  const json shown = name.substr(0, kShownOfName) + (name.size() > kShownOfName ? "..." : "");
  const std::string quoted =
      shown.dump(-1, ' ', false, json::error_handler_t::replace);  // for a name cut within a character
  return quoted.substr(1, quoted.size() - 2);
}

bool isOneModel(const json& file) {
  for (const char* field : {"symmetries_discrete", "symmetries_continuous", "align_axes", "diameter"})
    if (file.contains(field)) return true;
  return false;
}

/// Reads what symmetriesJson() writes.
/// \param where names the entry in errors, e.g. "models_info.json: model 3".
/// \throws InputError naming field, value and rule.
ListedSymmetries symmetriesFromJson(const json& entry, const std::string& where) {
  if (!entry.is_object()) throw InputError(where + " must be an object");
  ListedSymmetries listed;
  const json &discrete = listOf(entry, "symmetries_discrete", where),
             &continuous = listOf(entry, "symmetries_continuous", where);
  for (std::size_t i = 0; i < discrete.size(); ++i)
    listed.discrete.push_back(motionFrom(discrete[i], where + ": symmetries_discrete[" + std::to_string(i) + "]"));
  for (std::size_t i = 0; i < continuous.size(); ++i)
    listed.continuous.push_back(axisFrom(continuous[i], where + ": symmetries_continuous[" + std::to_string(i) + "]"));
  return listed;
}

constexpr double kAligned = 5.0 * kDegree;  // angle within which an axis counts as a coordinate axis

const std::string kNames = "xyz";

/// The order of the rotations of a group about a coordinate axis; 0 for any angle.
int orderAbout(const ObjectSymmetries& symmetries, const Eigen::Vector3d& axis) {
  if (symmetries.kind == RotationGroupKind::Spherical) return 0;
  const auto is_along = [&](const Eigen::Vector3d& other) { return axis.cross(other).norm() < std::sin(kAligned); };
  if (!symmetries.continuous.empty() && is_along(symmetries.continuous.front().axis)) return 0;
  if (!symmetries.continuous.empty()) {
    const bool is_across = std::abs(axis.dot(symmetries.continuous.front().axis)) < std::sin(kAligned);
    return symmetries.kind == RotationGroupKind::Cylindrical && is_across ? 2 : 1;
  }
  for (const RotationAxis& found : axesOf(symmetries.discrete))
    if (is_along(found.direction)) return found.order;
  return 1;
}

/// \return the text without blanks and quotes around it; nothing if it holds anything but letters, digits and _ . + -
std::optional<std::string> wordIn(std::string text) {
  boost::algorithm::trim(text);
  boost::algorithm::trim_if(text, boost::algorithm::is_any_of("\"'"));
  const bool is_word =
      !text.empty() && boost::algorithm::all(text, boost::algorithm::is_alnum() || boost::algorithm::is_any_of("_.+-"));
  return is_word ? std::optional<std::string>(text) : std::nullopt;
}

/// A line `name: ["z_90", "z_180"]`, perhaps followed by a comment.
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
    // A text that is no word is no rotation either.
    if (!entry.empty()) result.axes.push_back(wordIn(entry).value_or(entry));
  }
  return result;
}

/// The number of rotations composed of rotations about the axes.
std::size_t numComposed(const ListedSymmetries& listed) {
  try {
    return ObjectSymmetries::from(listed.discrete, {}).discrete.size() + 1;
  } catch (const std::invalid_argument&) {
    return 0;
  }
}

/// \return turns about the origin.
/// \throws InputError naming the string and the rule.
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

}  // namespace

std::vector<RotationAxis> axesOf(const std::vector<Eigen::Isometry3d>& motions) {
  std::vector<Eigen::Matrix3d> rotations;
  for (const Eigen::Isometry3d& motion : motions) rotations.push_back(motion.linear());
  return pcl_symmetry::axesOf(rotations);
}

ListedSymmetries bopSymmetries(const ObjectSymmetries& symmetries, double sphere_angle) {
  if (symmetries.kind != RotationGroupKind::Spherical) return {symmetries.discrete, symmetries.continuous, false};
  ListedSymmetries listed;
  listed.continuous.push_back({Eigen::Vector3d::UnitZ(), symmetries.center});
  for (const Eigen::Matrix3d& tilt : tiltsCovering(Eigen::Vector3d::UnitZ(), sphere_angle)) {
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    motion.linear() = tilt;
    motion.translation() = symmetries.center - tilt * symmetries.center;
    if (!tilt.isIdentity(1e-12)) listed.discrete.push_back(motion);
  }
  return listed;
}

ordered_json symmetriesJson(const ListedSymmetries& listed) {
  ordered_json entry = ordered_json::object();
  for (const Eigen::Isometry3d& motion : listed.discrete) entry["symmetries_discrete"].push_back(rowMajor(motion));
  for (const ContinuousSymmetry& symmetry : listed.continuous)
    entry["symmetries_continuous"].push_back(
        {{"axis", numbersOf(symmetry.axis)}, {"offset", numbersOf(symmetry.offset)}});
  return entry;
}

ordered_json dopeJson(const ObjectSymmetries& symmetries, double sphere_angle) {
  const ListedSymmetries listed = bopSymmetries(symmetries, sphere_angle);
  ordered_json entry = symmetriesJson(listed);
  Eigen::Vector3d main = Eigen::Vector3d::UnitZ();
  int greatest_order = 1;
  for (const RotationAxis& axis : axesOf(listed.discrete)) {
    if (axis.order <= greatest_order) continue;
    greatest_order = axis.order;
    main = axis.direction;
  }
  if (!listed.continuous.empty()) main = listed.continuous.front().axis;
  if (greatest_order == 1 && listed.continuous.empty()) return entry;
  const Eigen::Vector3d across = signedDirection(main.unitOrthogonal());
  const std::vector<double> up{0.0, 1.0, 0.0}, forward{0.0, 0.0, 1.0};
  entry["align_axes"] = {{{"object", numbersOf(across)}, {"camera", forward}},
                         {{"object", numbersOf(main)}, {"camera", up}}};
  return entry;
}

std::map<std::string, ListedSymmetries> readModelsInfo(const std::string& path) {
  const json file = json::parse(readTextFile(path), nullptr, false);
  if (!file.is_object()) throw InputError(path + ": must be a JSON object of models");
  if (isOneModel(file)) return {{"", symmetriesFromJson(file, path)}};
  std::map<std::string, ListedSymmetries> models;
  for (const auto& [key, entry] : file.items())
    models[key] = symmetriesFromJson(entry, path + ": model " + onOneLine(key));
  return models;
}

IsaacAxes isaacAxes(const ObjectSymmetries& symmetries) {
  IsaacAxes result;
  for (int k = 0; k < 3; ++k) {
    const int order = orderAbout(symmetries, Eigen::Vector3d::Unit(k));
    if (order == 0) result.axes.push_back(kNames.substr(k, 1) + "_full");
    for (int i = 1; i < order; ++i) result.axes.push_back(kNames.substr(k, 1) + formatted("_%g", 360.0 * i / order));
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

std::string isaacLine(const std::string& name, const std::vector<std::string>& axes) {
  std::string line = name + ": [";
  for (std::size_t i = 0; i < axes.size(); ++i) line += (i > 0 ? ", \"" : "\"") + axes[i] + "\"";
  return line + "]";
}

std::map<std::string, ListedSymmetries> readIsaacAxes(const std::string& path) {
  std::map<std::string, ListedSymmetries> models;
  std::istringstream lines(readTextFile(path));
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
