#include "evaluate/rotations/meshes/mesh_rotations.h"

#include <algorithm>

#include "core/rotation/rotation_fit.h"
#include "evaluate/rotations/meshes/true_shares.h"
#include "pcl_symmetry/mesh_sampling.h"
#include "recognition/packing/packed_bytes.h"

namespace pcl_symmetry::apps {

namespace {

std::vector<Eigen::Isometry3d> motionsOf(const ObjectSymmetries& group) {
  std::vector<Eigen::Isometry3d> motions = group.discrete;
  for (const ContinuousSymmetry& axis : group.continuous) {
    const std::vector<Eigen::Isometry3d> turns = turnsByAnyAngle(axis.offset, axis.axis);
    motions.insert(motions.end(), turns.begin(), turns.end());
  }
  return motions;
}

Points cloudOf(const pcl::PolygonMesh& mesh, const ObjectSymmetryOptions& options, int num_points) {
  return sampleMesh(mesh, num_points, options.seed)->getMatrixXfMap(3, 4, 0);
}

}  // namespace

std::string groupOf(const pcl::PolygonMesh& mesh, const ObjectSymmetryOptions& options, int num_points) {
  return objectSymmetries(cloudOf(mesh, options, num_points), options).name();
}

std::vector<JudgedRotation> judgedRotations(const pcl::PolygonMesh& mesh, const ObjectSymmetryOptions& options,
                                            int num_points) {
  const ObjectSymmetries found = objectSymmetries(cloudOf(mesh, options, num_points), options);
  const TrueShares shares(mesh, found.tolerance);
  const RotationLimits limits{found.tolerance, options.max_feature};
  const auto size = std::min<std::size_t>(static_cast<std::size_t>(num_points), options.max_points);
  std::vector<JudgedRotation> judged;
  const std::vector<Eigen::Isometry3d> motions = motionsOf(found);
  if (!motions.empty()) judged.push_back({found.name(), found.confidence, limits.excess(shares.worstOf(motions))});
  for (const RejectedRotation& turn : found.rejected) {
    const OffShares measured{turn.off, turn.far};
    judged.push_back({"rejected", limits.confidence(measured, size), limits.excess(shares.of(turn.turn))});
  }
  return judged;
}

std::string packed(const JudgedGroups& groups) {
  detail::PackedBytes bytes;
  bytes.put(static_cast<std::uint32_t>(groups.names.size()));
  for (const std::string& name : groups.names) bytes.putText(name);
  for (const JudgedRotation& rotation : groups.rotations) {
    bytes.putText(rotation.group);
    for (const double value : {rotation.confidence, rotation.excess}) bytes.put(value);
  }
  return bytes.bytes();
}

JudgedGroups unpackedGroups(const std::string& packed) {
  JudgedGroups groups;
  if (packed.empty()) return groups;
  detail::UnpackedBytes bytes(packed);
  const auto text = [&] {
    const auto size = bytes.get<std::uint32_t>();
    return std::string(bytes.take(size), size);
  };
  for (auto left = bytes.get<std::uint32_t>(); left > 0; --left) groups.names.push_back(text());
  while (bytes.left() > 0) {
    JudgedRotation rotation;
    rotation.group = text();
    for (double* value : {&rotation.confidence, &rotation.excess}) *value = bytes.get<double>();
    groups.rotations.push_back(rotation);
  }
  return groups;
}

}  // namespace pcl_symmetry::apps
