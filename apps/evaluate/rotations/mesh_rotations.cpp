#include "evaluate/rotations/mesh_rotations.h"

#include <algorithm>
#include <cmath>

#include "core/base/constants.h"
#include "core/rotation/rotation_fit.h"
#include "evaluate/mesh/mesh_reflection.h"
#include "pcl_symmetry/mesh_sampling.h"
#include "recognition/packing/packed_bytes.h"

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

/// True shares of rotations of the input frame.
class TrueShares {
public:
  TrueShares(const pcl::PolygonMesh& mesh, double tolerance)
      : scene_(mesh), distance_(scene_), samples_(MeshReflection(scene_, kNumMeshSamples, 1).samples()) {
    tolerance_ = tolerance / scene_.diagonal();
  }

  OffShares of(const Eigen::Isometry3d& motion) const {
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

private:
  TriangleScene scene_;
  MeshDistance distance_;
  Points samples_;
  double tolerance_;
};

std::vector<Eigen::Isometry3d> motionsOf(const ObjectSymmetries& group) {
  std::vector<Eigen::Isometry3d> motions = group.discrete;
  for (const ContinuousSymmetry& axis : group.continuous)
    for (int k = 1; k <= kNumTurns; ++k) {
      Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
      turn.linear() = Eigen::AngleAxisd(2.0 * kPi * k / (kNumTurns + 1), axis.axis).toRotationMatrix();
      turn.translation() = axis.offset - turn.linear() * axis.offset;
      motions.push_back(turn);
    }
  return motions;
}

}  // namespace

std::vector<JudgedRotation> judgedRotations(const pcl::PolygonMesh& mesh, const ObjectSymmetryOptions& options,
                                            int num_points) {
  const Points points = sampleMesh(mesh, num_points, options.seed)->getMatrixXfMap(3, 4, 0);
  const ObjectSymmetries found = objectSymmetries(points, options);
  const TrueShares shares(mesh, found.tolerance);
  const RotationLimits limits{found.tolerance, options.max_feature};
  const auto size = std::min<std::size_t>(static_cast<std::size_t>(num_points), options.max_points);
  std::vector<JudgedRotation> judged;
  const std::vector<Eigen::Isometry3d> motions = motionsOf(found);
  if (!motions.empty()) {
    OffShares worst;
    for (const Eigen::Isometry3d& motion : motions) {
      const OffShares one = shares.of(motion);
      worst = {std::max(worst.off, one.off), std::max(worst.far, one.far)};
    }
    judged.push_back({found.name(), found.confidence, limits.excess(worst)});
  }
  for (const RejectedRotation& turn : found.rejected) {
    const OffShares measured{turn.off, turn.far};
    judged.push_back({"rejected", limits.confidence(measured, size), limits.excess(shares.of(turn.turn))});
  }
  return judged;
}

std::string packed(const std::vector<JudgedRotation>& judged) {
  detail::PackedBytes bytes;
  for (const JudgedRotation& rotation : judged) {
    bytes.putText(rotation.group);
    for (const double value : {rotation.confidence, rotation.excess}) bytes.put(value);
  }
  return bytes.bytes();
}

std::vector<JudgedRotation> unpackedRotations(const std::string& packed) {
  detail::UnpackedBytes bytes(packed);
  std::vector<JudgedRotation> judged;
  while (bytes.left() > 0) {
    JudgedRotation rotation;
    const auto size = bytes.get<std::uint32_t>();
    rotation.group.assign(bytes.take(size), size);
    for (double* value : {&rotation.confidence, &rotation.excess}) *value = bytes.get<double>();
    judged.push_back(rotation);
  }
  return judged;
}

}  // namespace pcl_symmetry::apps
