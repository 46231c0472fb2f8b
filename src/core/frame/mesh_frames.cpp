#include <Eigen/Geometry>
#include <utility>

#include "core/geometry/geometry_rules.h"
#include "core/rotation/rotation_fit.h"
#include "pcl_symmetry/core/mesh_surface.h"
#include "pcl_symmetry/core/rotational_symmetry.h"
#include "pcl_symmetry/core/symmetry_frame.h"

namespace pcl_symmetry {

namespace {

MotionsAbout motionsOf(const ObjectSymmetries& symmetries) {
  MotionsAbout motions{{}, symmetries.center};
  for (const Eigen::Isometry3d& motion : symmetries.discrete) motions.linear.push_back(motion.linear());
  for (const ContinuousSymmetry& axis : symmetries.continuous) motions.addRotations(axis.axis);
  return motions;
}

/// Moves a group, as a whole, to where it maps the mesh onto itself.
/// \return its motions there.
MotionsAbout place(const MeshSurface& mesh, ObjectSymmetries& symmetries) {
  const MotionsAbout motions = motionsOf(symmetries);
  if (motions.linear.empty()) return motions;
  const MeshSurface::Placement placed = mesh.fitted(motions);
  symmetries.center = placed.center;
  for (Eigen::Isometry3d& motion : symmetries.discrete) {
    motion.linear() = placed.rotation * motion.linear() * placed.rotation.transpose();
    motion.translation() = placed.center - motion.linear() * placed.center;
  }
  for (ContinuousSymmetry& axis : symmetries.continuous)
    axis = {symmetries.kind == RotationGroupKind::Spherical ? axis.axis : placed.rotation * axis.axis, placed.center};
  return motionsOf(symmetries);
}

}  // namespace

ObjectSymmetries objectSymmetries(const PointsRef& points, const MeshSurface& mesh,
                                  const ObjectSymmetryOptions& options) {
  ObjectSymmetries found = objectSymmetries(points, options);
  place(mesh, found);
  ObjectSymmetryOptions wide = options;
  wide.tolerance = ObjectSymmetryOptions().tolerance;
  wide.absolute_tolerance = 0.0;
  if (found.tolerance >= wide.tolerance * mesh.ball().radius) return found;
  ObjectSymmetries greater = objectSymmetries(points, wide);
  const auto size = [](const ObjectSymmetries& group) {
    return std::make_pair(group.continuous.size(), group.discrete.size());
  };
  if (size(greater) <= size(found)) return found;
  const MotionsAbout motions = place(mesh, greater);
  const RotationLimits limits{found.tolerance, options.max_feature};
  const OffShares off{1.0 - mesh.shares(motions, limits.tolerance).share,
                      1.0 - mesh.shares(motions, kRotation.far_tolerances * limits.tolerance).share};
  const double confidence = limits.confidence(off, mesh.numSamples());
  if (confidence < options.min_confidence) return found;
  greater.support = 1.0 - off.off;
  greater.confidence = confidence;
  greater.tolerance = found.tolerance;
  greater.rejected = std::move(found.rejected);
  greater.at_half_tolerance = found.at_half_tolerance;
  greater.at_twice_tolerance = found.at_twice_tolerance;
  return greater;
}

void refineOnMesh(const MeshSurface& mesh, SymmetryFrame& frame) {
  Eigen::Matrix3d axes = frame.axes;
  Eigen::Vector3d center = frame.center;
  const double tolerance = 2.0 * DetectionOptions().tolerance * mesh.ball().radius;
  const double nearly = 0.8;  // share of planes that are fitted: of 94 that became exact none had less than 0.96
  int exact[3], num_exact = 0;
  for (int k = 0; k < 3; ++k) {
    const ReflectionPlane start(frame.axes.col(k), frame.axes.col(k).dot(frame.center));
    if (mesh.shares(start, 2.0 * tolerance).share < nearly) continue;
    const ReflectionPlane plane = mesh.fitted(start);
    if (mesh.shares(plane, tolerance).share < kSymmetricShare) continue;
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

}  // namespace pcl_symmetry
