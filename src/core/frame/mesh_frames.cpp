#include <Eigen/Geometry>

#include "core/geometry/geometry_rules.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/mesh_surface.h"
#include "pcl_symmetry/core/symmetry_frame.h"

namespace pcl_symmetry {

namespace {

/// Moves all of a frame as its center and axes move.
/// \param axes right-handed.
void moveTo(const Eigen::Vector3d& center, const Eigen::Matrix3d& axes, SymmetryFrame& frame) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();  // of the frame
  motion.linear() = axes * frame.axes.transpose();
  motion.translation() = center - motion.linear() * frame.center;
  frame.axes = axes;
  frame.center = center;
  frame.T_canonical_input = frame.T_canonical_input * motion.inverse();
  for (Eigen::Isometry3d& other : frame.equivalent) other = other * motion.inverse();
  if (frame.probable.empty()) return;
  frame.probable.front().center = center;
  frame.probable.front().axes = axes;
}

/// Puts axis \p first to the front; the others follow it in their cyclic order.
void turnOrder(int first, SymmetryFrame& frame) {
  if (first == 0) return;
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
  for (int k = 0; k < 3; ++k) turn.linear().row(k) = Eigen::RowVector3d::Unit((k + first) % 3);
  const auto turned = [&](int axis) { return axis < 0 || axis > 2 ? axis : (axis - first + 3) % 3; };
  frame.axes = frame.axes * turn.linear().transpose();
  frame.scores = turn.linear() * frame.scores;
  frame.revolution_axis = turned(frame.revolution_axis);
  frame.T_canonical_input = turn * frame.T_canonical_input;
  for (Eigen::Isometry3d& other : frame.equivalent) other = turn * other;
  if (frame.probable.empty()) return;
  frame.probable.front().axes = frame.axes;
  frame.probable.front().revolution_axis = frame.revolution_axis;
}

}  // namespace

void bringToPlane(const ReflectionPlane& plane, SymmetryFrame& frame) {
  int across = 0;
  (frame.axes.transpose() * plane.normal()).cwiseAbs().maxCoeff(&across);
  turnOrder(across, frame);
  const Eigen::Vector3d first = frame.axes.col(0);
  const Eigen::Vector3d normal = first.dot(plane.normal()) < 0.0 ? Eigen::Vector3d(-plane.normal()) : plane.normal();
  const Eigen::Matrix3d axes = Eigen::Quaterniond::FromTwoVectors(first, normal).toRotationMatrix() * frame.axes;
  moveTo(frame.center - plane.signedDistance(frame.center) * plane.normal(), axes, frame);
}

void refineOnMesh(const MeshSurface& mesh, SymmetryFrame& frame) {
  Eigen::Matrix3d axes = frame.axes;
  Eigen::Vector3d center = frame.center;
  const double tolerance = 2.0 * DetectionOptions().tolerance * mesh.ball().radius;
  const double nearly = 0.8;  // share of planes that are fitted: of 94 that became exact none had less than 0.96
  int exact[3], num_exact = 0;
  for (int k = 0; k < 3; ++k) {
    const ReflectionPlane start(frame.axes.col(k), frame.axes.col(k).dot(frame.center));
    if (mesh.shares(start, 2.0 * tolerance, nearly).share < nearly) continue;
    const ReflectionPlane plane = mesh.fitted(start);
    if (mesh.shares(plane, tolerance, kSymmetricShare).share < kSymmetricShare) continue;
    axes.col(k) = plane.normal();
    for (int i = 0; i < num_exact; ++i) axes.col(k) -= axes.col(exact[i]).dot(axes.col(k)) * axes.col(exact[i]);
    axes.col(k).normalize();
    center -= (axes.col(k).dot(center) - axes.col(k).dot(plane.normal() * plane.offset())) * axes.col(k);
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
  if (axes.determinant() < 0.0) return;
  moveTo(center, axes, frame);
}

}  // namespace pcl_symmetry
