#include "io/answers.h"

#include <cmath>

#include "io/shape_output.h"

namespace pcl_symmetry::apps {

namespace {

/// Why a plane has its confidence and kind: the measurement, its confidence, then factors on the odds.
std::string explained(const std::string& name, const SymmetryPlane& plane, const Detection& found) {
  std::string lines = formatted("%s: %s, confidence %.3f\n", name.c_str(), toString(plane.kind), plane.confidence);
  if (!std::isnan(plane.share)) {
    // If points resolve no surface, symmetries are judged by the density.
    const bool is_below = plane.kind == PlaneKind::Symmetry && plane.share < 0.97;
    // It is the diameter if the worst points are farther away than was searched.
    const std::string most =
        plane.deviation < 0.99 * found.diameter ? formatted(", 97 %% within %.3g", plane.deviation) : "";
    lines += formatted(
        "  %.1f %% of the surface within %.3g of its reflection%s%s\n"
        "  %.0f %% of the reflections fall where the surface would have been seen\n",
        100.0 * plane.share, found.tolerance, most.c_str(), is_below ? "" : "; a symmetry has 97 %",
        100.0 * plane.seen);
  }
  bool is_first = true;
  for (const Reason& reason : plane.reasons)
    if (!reason.odds)
      lines += std::string("  possible at most: ") + reason.rule + "\n";
    else if (std::exchange(is_first, false))
      lines += formatted("  %.3f: %s\n", *reason.odds / (1.0 + *reason.odds), reason.rule);
    else
      lines += formatted("  odds x %.3g: %s\n", *reason.odds, reason.rule);
  return lines;
}

/// Axes and centers are decided by many planes together.
template <typename Found>
std::string explained(const char* name, const Found& found, const char* planes) {
  return formatted("%s: confidence %.3f\n  planes %s together: support %.3f, score %.3f\n", name, found.confidence,
                   planes, found.support, found.score);
}

std::string explained(const SymmetryRotation& rotation) {
  const std::string name = rotation.fold == 0 ? "axis of revolution" : formatted("axis of order %d", rotation.fold);
  return name + formatted(": confidence %.3f\n", rotation.confidence) +
         formatted("  points on the surface %.3f, in space seen to be empty %.3f, by rotations halfway between %.3f\n",
                   rotation.support, rotation.off, rotation.halfway);
}

}  // namespace

void writeJson(const CommonOptions& common, const nlohmann::json& json) {
  if (common.json_path) writeText(*common.json_path, jsonText(json) + "\n");
}

nlohmann::json planeJson(const SymmetryPlane& plane, const Eigen::Vector3d& shift) {
  const auto reasonJson = [](const Reason& reason) -> nlohmann::json {
    return {{"rule", reason.rule}, {"odds", reason.odds ? nlohmann::json(*reason.odds) : nullptr}};
  };
  return {{"coefficients", numbersOf(plane, shift)},
          {"kind", toString(plane.kind)},
          {"confidence", plane.confidence},
          {"reasons", listOf(plane.reasons, reasonJson)},
          {"share", plane.share},
          {"share_interval", nlohmann::json::array({plane.share_low, plane.share_high})},
          {"deviation", plane.deviation},
          {"score", plane.score},
          {"support", plane.support},
          {"seen", plane.seen},
          {"residual", plane.residual},
          {"iterations", plane.iterations},
          {"converged", plane.converged}};
}

nlohmann::json planesJson(const std::vector<SymmetryPlane>& planes, const Eigen::Vector3d& shift) {
  return listOf(planes, [&](const SymmetryPlane& plane) { return planeJson(plane, shift); });
}

nlohmann::json rotationsJson(const std::vector<SymmetryRotation>& rotations, const Eigen::Vector3d& shift) {
  return listOf(rotations, [&](const SymmetryRotation& rotation) {
    nlohmann::json json = axisJson(rotation, shift);
    json.update({{"fold", rotation.fold},
                 {"support", rotation.support},
                 {"off", rotation.off},
                 {"far", rotation.far},
                 {"halfway", rotation.halfway}});
    return json;
  });
}

nlohmann::json axesJson(const Eigen::Matrix3d& axes) {
  return listOf(axes.colwise(), [](const Eigen::Vector3d& axis) { return numbersOf(axis); });
}

nlohmann::json frameJson(const SymmetryFrame& frame, const Eigen::Vector3d& shift) {
  return {{"center", numbersOf(shiftedBack(frame.center, shift))},
          {"axes", axesJson(frame.axes)},
          {"scores", numbersOf(frame.scores)},
          {"revolution_axis", frame.revolution_axis},
          {"transform", rowMajor(shiftedBack(frame.T_canonical_input, shift, Eigen::Vector3d::Zero()))}};
}

std::string matrixLines(const Eigen::Isometry3d& motion, int digits) {
  std::string lines;
  for (int row = 0; row < 4; ++row)
    lines += formatted("%12.6f %12.6f %12.6f %12.*g\n", motion(row, 0), motion(row, 1), motion(row, 2), digits,
                       motion(row, 3));
  return lines;
}

std::string explained(const Detection& found) {
  std::string lines;
  for (const SymmetryCenter& center : found.centers)
    lines += explained("center of all planes", center, "in many directions through it");
  for (const SymmetryAxis& axis : found.axes)
    lines += explained("axis of revolution", axis, "at eight angles through it");
  for (const SymmetryRotation& rotation : found.rotations) lines += explained(rotation);
  for (std::size_t i = 0; i < found.planes.size(); ++i)
    lines += explained("plane " + std::to_string(i + 1), found.planes[i], found);
  if (found.best) lines += explained("best plane", *found.best, found);
  return lines;
}

}  // namespace pcl_symmetry::apps
