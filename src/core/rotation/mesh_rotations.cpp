/// Rotations that map a mesh onto itself (Section 6).
#include <Eigen/Geometry>
#include <utility>

#include "core/rotation/rotation_fit.h"
#include "pcl_symmetry/core/mesh_surface.h"
#include "pcl_symmetry/core/rotational_symmetry.h"

namespace pcl_symmetry {

namespace {

MotionsAbout motionsOf(const ObjectSymmetries& symmetries) {
  MotionsAbout motions{{}, symmetries.center};
  for (const Eigen::Isometry3d& motion : symmetries.discrete) motions.linear.push_back(motion.linear());
  for (const ContinuousSymmetry& axis : symmetries.continuous) motions.addRotations(axis.axis);
  return motions;
}

/// Moves a group, as a whole, to where it maps the mesh best onto itself.
void moveOntoMesh(const MeshSurface& mesh, ObjectSymmetries& symmetries) {
  const MotionsAbout motions = motionsOf(symmetries);
  if (motions.linear.empty()) return;
  const MeshSurface::Placement placed = mesh.fitted(motions);
  symmetries.center = placed.center;
  for (Eigen::Isometry3d& motion : symmetries.discrete) {
    motion.linear() = placed.rotation * motion.linear() * placed.rotation.transpose();
    motion.translation() = placed.center - motion.linear() * placed.center;
  }
  for (ContinuousSymmetry& axis : symmetries.continuous)
    axis = {symmetries.kind == RotationGroupKind::Spherical ? axis.axis : placed.rotation * axis.axis, placed.center};
}

}  // namespace

ObjectSymmetries objectSymmetries(const PointsRef& points, const MeshSurface& mesh,
                                  const ObjectSymmetryOptions& options) {
  ObjectSymmetries found = objectSymmetries(points, options);
  moveOntoMesh(mesh, found);
  ObjectSymmetryOptions wide = options;
  wide.tolerance = ObjectSymmetryOptions().tolerance;
  wide.absolute_tolerance = 0.0;
  if (found.tolerance >= wide.tolerance * mesh.ball().radius) return found;
  ObjectSymmetries greater = objectSymmetries(points, wide);
  const auto size = [](const ObjectSymmetries& group) {
    return std::make_pair(group.continuous.size(), group.discrete.size());
  };
  if (greater.reason.empty() && size(greater).first + size(greater).second == 0) found = greater;  // nor at less
  if (size(greater) <= size(found)) return found;
  moveOntoMesh(mesh, greater);
  const MotionsAbout motions = motionsOf(greater);
  const RotationLimits limits{found.tolerance, options.max_feature};
  const OffShares off{1.0 - mesh.shares(motions, limits.tolerance, 0.0).share,
                      1.0 - mesh.shares(motions, kRotation.far_tolerances * limits.tolerance, 0.0).share};
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

}  // namespace pcl_symmetry
