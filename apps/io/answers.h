/// Results as tools write them: text as printf() writes it, words, lines of tables, and JSON.
#pragma once

#include <Eigen/Geometry>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "command_line/command_line.h"
#include "io/exact_coordinates.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/symmetry_frame.h"
#include "pcl_symmetry/viewpoint.h"

namespace pcl_symmetry::apps {

/// "1 plane", "2 planes".
/// \param many plural, if it is not the singular with an s.
inline std::string counted(std::size_t number, const std::string& one, const std::string& many = "") {
  return std::to_string(number) + " " + (number == 1 ? one : many.empty() ? one + "s" : many);
}

/// JSON as text; an object holds its provenance, see madeBy(). Names of files are bytes: invalid UTF-8 is replaced,
/// where nlohmann's default would throw.
/// \param indent blanks per level; -1 = one line
template <typename Json>
std::string jsonText(Json json, int indent = 2) {
  if (json.is_object()) json["made_by"] = Json::parse(madeBy().dump(-1, ' ', false, Json::error_handler_t::replace));
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// Writes JSON to the file of the flag -json, if it was given.
void writeJson(const CommonOptions& common, const nlohmann::json& json);

/// \return an array of what \p toJson gives for each item.
template <typename Items, typename ToJson>
nlohmann::json listOf(const Items& items, const ToJson& toJson) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& item : items) list.push_back(toJson(item));
  return list;
}

inline std::vector<double> numbersOf(const Eigen::VectorXd& v) {
  return {v.data(), v.data() + v.size()};
}

/// \return 16 numbers, row by row
inline std::vector<double> rowMajor(const Eigen::Isometry3d& transform) {
  const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> matrix = transform.matrix();
  return {matrix.data(), matrix.data() + matrix.size()};
}

/// \param shift vector that was subtracted from the input.
/// \return a, b, c and d, input frame.
inline std::vector<double> numbersOf(const ReflectionPlane& plane, const Eigen::Vector3d& shift) {
  return numbersOf(shiftedBack(plane, shift).coefficients());
}

/// Planes and all their measurements, input frame.
nlohmann::json planeJson(const SymmetryPlane& plane, const Eigen::Vector3d& shift);
nlohmann::json planesJson(const std::vector<SymmetryPlane>& planes, const Eigen::Vector3d& shift);

/// The position of an axis, input frame, and its confidence.
/// \param axis SymmetryAxis or SymmetryRotation.
template <typename Axis>
nlohmann::json axisJson(const Axis& axis, const Eigen::Vector3d& shift) {
  return {{"point", numbersOf(shiftedBack(axis.point, shift))},
          {"direction", numbersOf(axis.direction)},
          {"confidence", axis.confidence}};
}

/// The same for axes of rotations of scans, with their evidence.
nlohmann::json rotationsJson(const std::vector<SymmetryRotation>& rotations, const Eigen::Vector3d& shift);

/// The columns of a matrix of axes.
nlohmann::json axesJson(const Eigen::Matrix3d& axes);

/// Center and axes, the transform to them, input frame.
nlohmann::json frameJson(const SymmetryFrame& frame, const Eigen::Vector3d& shift);

inline nlohmann::json timingJson(const std::vector<std::pair<std::string, double>>& timing_ms) {
  nlohmann::json json = nlohmann::json::object();
  for (const auto& [stage, ms] : timing_ms) json[stage] = ms;
  return json;
}

/// \return what printf() prints.
template <typename... Values>
std::string formatted(const char* format, Values... values) {
  std::string text(static_cast<std::size_t>(std::snprintf(nullptr, 0, format, values...)), '\0');
  std::snprintf(text.data(), text.size() + 1, format, values...);
  return text;
}

/// A line such as "axis of order 6: through 0 0 0 along 0.000000 0.000000 1.000000, confidence 0.973".
/// \param axis SymmetryAxis or SymmetryRotation.
/// \param fold order of the rotations; 0 = any angle.
template <typename Axis>
std::string lineOf(const Axis& axis, int fold, const Eigen::Vector3d& shift) {
  const std::string order = fold > 0 ? "axis of order " + std::to_string(fold) : "axis of revolution";
  const Eigen::Vector3d& d = axis.direction;
  return order + ": through " + spelled(shiftedBack(axis.point, shift), lengthDigits(shift)) +
         formatted(" along %.6f %.6f %.6f, confidence %.3f\n", d.x(), d.y(), d.z(), axis.confidence);
}

/// Why each plane, axis and center has its confidence, and each plane its kind, in words.
std::string explained(const Detection& found);

/// A motion, row by row.
/// \param digits significant digits of lengths.
std::string matrixLines(const Eigen::Isometry3d& motion, int digits);

}  // namespace pcl_symmetry::apps
