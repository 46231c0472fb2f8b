#include "evaluate/rotations/meshes/true_shares.h"

#include <algorithm>

#include "core/base/constants.h"
#include "core/neighbours/diameter.h"
#include "evaluate/mesh/mesh_reflection.h"

namespace pcl_symmetry::apps {

namespace {

// Points of the mesh that shares are measured with. chosen: a share of 0.1 is known to 0.004; half to 0.006, twice
// takes twice the time.
constexpr int kNumMeshSamples = 5000;
// Turns of an axis of revolution that are judged, of 1/17 of a turn. chosen: no fold divides it; half misses handles,
// twice takes twice the time.
constexpr int kNumTurns = 16;
// Tolerances beyond which the surface is far off. derived: ObjectSymmetryOptions::max_feature says so.
constexpr double kFarTolerances = 10.0;

}  // namespace

TrueShares::TrueShares(const pcl::PolygonMesh& mesh, double tolerance)
    : scene_(mesh),
      distance_(scene_),
      samples_(MeshReflection(scene_, kNumMeshSamples, 1).samples()),
      tolerance_(tolerance / scene_.diagonal()) {}

OffShares TrueShares::of(const Eigen::Isometry3d& motion) const {
  Eigen::Index num_off = 0, num_far = 0;
  const Eigen::Vector3d shift =
      (motion.linear() * scene_.center() + motion.translation() - scene_.center()) / scene_.diagonal();
  for (Eigen::Index i = 0; i < samples_.cols(); ++i) {
    const Eigen::Vector3d x = motion.linear() * samples_.col(i).cast<double>() + shift;
    if (distance_.within(x, tolerance_)) continue;
    ++num_off;
    num_far += distance_.within(x, kFarTolerances * tolerance_) ? 0 : 1;
  }
  const auto size = static_cast<double>(samples_.cols());
  return {static_cast<double>(num_off) / size, static_cast<double>(num_far) / size};
}

OffShares TrueShares::worstOf(const std::vector<Eigen::Isometry3d>& motions) const {
  OffShares worst;
  for (const Eigen::Isometry3d& motion : motions) {
    const OffShares one = of(motion);
    worst = {std::max(worst.off, one.off), std::max(worst.far, one.far)};
  }
  return worst;
}

double diameterOf(const pcl::PolygonMesh& mesh) {
  const TriangleScene scene(mesh);
  Points corners(3, static_cast<Eigen::Index>(3 * scene.triangles().size()));
  Eigen::Index size = 0;
  for (const Triangle& triangle : scene.triangles())
    for (const Eigen::Vector3d& corner : {triangle.a, triangle.b, triangle.c})
      corners.col(size++) = corner.cast<float>();
  return diameter(corners) * scene.diagonal();
}

Eigen::Isometry3d turnAbout(const Eigen::Vector3d& point, const Eigen::Vector3d& direction, double angle) {
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
  turn.linear() = Eigen::AngleAxisd(angle, direction).toRotationMatrix();
  turn.translation() = point - turn.linear() * point;
  return turn;
}

std::vector<Eigen::Isometry3d> turnsByAnyAngle(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) {
  std::vector<Eigen::Isometry3d> turns;
  for (int k = 1; k <= kNumTurns; ++k) turns.push_back(turnAbout(point, direction, 2.0 * kPi * k / (kNumTurns + 1)));
  return turns;
}

}  // namespace pcl_symmetry::apps
