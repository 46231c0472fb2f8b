#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <optional>

#include "core/base/lists.h"
#include "core/base/options.h"
#include "core/base/small_motion.h"
#include "core/detection/plane_search.h"
#include "core/frame/canonical_frame.h"
#include "core/frame/frame_evidence.h"
#include "core/geometry/geometry_rules.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/mesh_surface.h"
#include "pcl_symmetry/core/symmetry_frame.h"

namespace pcl_symmetry {

namespace {

/// Moves the center and axes of a frame, and everything else with them.
/// \param axes right-handed.
void moveTo(const Eigen::Vector3d& center, const Eigen::Matrix3d& axes, SymmetryFrame& frame) {
  const Eigen::Matrix3d rotation = axes * frame.axes.transpose();
  const Eigen::Isometry3d motion = isometry(rotation, center - rotation * frame.center);  // motion of the frame
  frame.axes = axes;
  frame.center = center;
  frame.T_canonical_input = frame.T_canonical_input * motion.inverse();
  for (Eigen::Isometry3d& other : frame.equivalent) other = other * motion.inverse();
  if (frame.probable.empty()) return;
  frame.probable.front().center = center;
  frame.probable.front().axes = axes;
}

/// Puts axis \p first to the front; the others follow it in their cyclic order.
void rotateOrder(int first, SymmetryFrame& frame) {
  if (first == 0) return;
  Eigen::Isometry3d permutation = Eigen::Isometry3d::Identity();
  for (int k = 0; k < 3; ++k) permutation.linear().row(k) = Eigen::RowVector3d::Unit((k + first) % 3);
  const auto position = [&](int axis) { return axis < 0 || axis > 2 ? axis : (axis - first + 3) % 3; };
  frame.axes = frame.axes * permutation.linear().transpose();
  frame.scores = permutation.linear() * frame.scores;
  frame.revolution_axis = position(frame.revolution_axis);
  frame.T_canonical_input = permutation * frame.T_canonical_input;
  for (Eigen::Isometry3d& other : frame.equivalent) other = permutation * other;
  if (frame.probable.empty()) return;
  frame.probable.front().axes = frame.axes;
  frame.probable.front().revolution_axis = frame.revolution_axis;
}

/// A plane is fitted if it maps this share to within twice the tolerance; none of 94 planes that became exact on meshes
/// had less than 0.96.
constexpr double kNearly = 0.8;

/// Moves the center and axes of a frame to planes of symmetry; axes whose perpendicular plane is no symmetry follow the
/// others.
/// \param exactly gives the plane of symmetry near a plane, if there is one.
void bringToPlanes(const std::function<std::optional<ReflectionPlane>(const ReflectionPlane&)>& exactly,
                   SymmetryFrame& frame) {
  Eigen::Matrix3d axes = frame.axes;
  Eigen::Vector3d center = frame.center;
  int exact[3], num_exact = 0;
  for (int k = 0; k < 3; ++k) {
    const std::optional<ReflectionPlane> plane =
        exactly(ReflectionPlane(frame.axes.col(k), frame.axes.col(k).dot(frame.center)));
    if (!plane) continue;
    const bool is_opposite = plane->normal().dot(frame.axes.col(k)) < 0.0;
    axes.col(k) = is_opposite ? Eigen::Vector3d(-plane->normal()) : plane->normal();
    for (int i = 0; i < num_exact; ++i) axes.col(k) -= axes.col(exact[i]).dot(axes.col(k)) * axes.col(exact[i]);
    axes.col(k).normalize();
    center -= (axes.col(k).dot(center) - axes.col(k).dot(plane->normal() * plane->offset())) * axes.col(k);
    exact[num_exact++] = k;
  }
  if (num_exact == 0) return;
  if (num_exact == 1) {
    const int k = exact[0], next = (k + 1) % 3;
    axes.col(next) = (axes.col(next) - axes.col(k).dot(axes.col(next)) * axes.col(k)).normalized();
  }
  if (num_exact < 3) {
    const int last = num_exact == 2 ? 3 - exact[0] - exact[1] : (exact[0] + 2) % 3;
    axes.col(last) = axes.col((last + 1) % 3).cross(axes.col((last + 2) % 3));
  }
  if (!(axes.determinant() > 0.5)) return;  // two of the axes coincide
  moveTo(center, axes, frame);
}

/// Rotates an axis of a frame onto a line, and moves the center there.
void bringToLine(const Line3d& line, int k, SymmetryFrame& frame) {
  const Eigen::Vector3d axis = frame.axes.col(k);
  const double sign = axis.dot(line.direction()) < 0.0 ? -1.0 : 1.0;
  moveTo(line.projection(frame.center),
         Eigen::Quaterniond::FromTwoVectors(axis, sign * line.direction()).toRotationMatrix() * frame.axes, frame);
}

}  // namespace

void bringToPlane(const ReflectionPlane& plane, SymmetryFrame& frame) {
  int across = 0;
  (frame.axes.transpose() * plane.normal()).cwiseAbs().maxCoeff(&across);
  rotateOrder(across, frame);
  const Eigen::Vector3d first = frame.axes.col(0);
  const Eigen::Vector3d normal = first.dot(plane.normal()) < 0.0 ? Eigen::Vector3d(-plane.normal()) : plane.normal();
  const Eigen::Matrix3d axes = Eigen::Quaterniond::FromTwoVectors(first, normal).toRotationMatrix() * frame.axes;
  moveTo(frame.center - plane.signedDistance(frame.center) * plane.normal(), axes, frame);
}

void bringToSymmetry(const Detection& found, SymmetryFrame& frame) {
  if (!found.centers.empty()) {
    moveTo(found.centers.front().point, frame.axes, frame);
    frame.revolution_axis = 3;
  } else if (!found.axes.empty()) {
    const SymmetryAxis& axis = found.axes.front();
    int nearest = 0;
    (frame.axes.transpose() * axis.direction).cwiseAbs().maxCoeff(&nearest);
    bringToLine({axis.point, axis.direction}, nearest, frame);
    frame.revolution_axis = nearest;
  }
}

int axisAlong(const SymmetryRotation& rotation, const SymmetryFrame& frame) {
  int along = 0;
  const double cosine = (frame.axes.transpose() * rotation.direction).cwiseAbs().maxCoeff(&along);
  return rotation.confidence >= DetectionOptions().min_confidence && cosine > std::cos(kFrame.same_frame) ? along : -1;
}

void refineOnMesh(const MeshSurface& mesh, SymmetryFrame& frame) {
  const double tolerance = 2.0 * DetectionOptions().tolerance * mesh.ball().radius;
  bringToPlanes(
      [&](const ReflectionPlane& start) -> std::optional<ReflectionPlane> {
        if (mesh.shares(start, 2.0 * tolerance, kNearly).share < kNearly) return std::nullopt;
        const ReflectionPlane plane = mesh.fitted(start);
        if (mesh.shares(plane, tolerance, kSymmetricShare).share < kSymmetricShare) return std::nullopt;
        return plane;
      },
      frame);
}

void refineOnPoints(const PointsRef& points, const Visibility* visibility, const FrameOptions& options,
                    SymmetryFrame& frame) {
  // Half turns follow from planes.
  for (const SymmetryRotation& rotation : frame.rotations)
    if (const int k = axisAlong(rotation, frame); rotation.fold != 2 && k >= 0)
      bringToLine({rotation.point, rotation.direction}, k, frame);
  std::vector<ReflectionPlane> starts;
  for (int k = 0; k < 3; ++k) starts.emplace_back(frame.axes.col(k), frame.axes.col(k).dot(frame.center));
  const auto detection = optionsWith<DetectionOptions>(options.seed, options.num_threads);
  std::vector<SymmetryPlane> found = decidePlanesNear(starts, PlaneInput(points, visibility), detection);
  eraseIf(found, [](const SymmetryPlane& plane) { return plane.kind != PlaneKind::Symmetry; });
  sortDescending(found, &SymmetryPlane::confidence);
  bringToPlanes(
      [&](const ReflectionPlane& start) -> std::optional<ReflectionPlane> {
        for (const SymmetryPlane& plane : found)
          if (std::abs(plane.normal().dot(start.normal())) > std::cos(kFrame.same_frame)) return plane;
        return std::nullopt;
      },
      frame);
}

}  // namespace pcl_symmetry
