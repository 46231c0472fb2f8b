/// What rotations really map off a mesh, by exact distances: how far the confidence of groups and the shares of
/// rejected turns can be trusted.
#pragma once

#include <pcl/PolygonMesh.h>

#include <string>
#include <vector>

#include "pcl_symmetry/core/rotation/rotational_symmetry.h"

namespace pcl_symmetry::apps {

/// A group or a turn that was judged on a cloud, and what is true on its mesh.
struct JudgedRotation {
  std::string group;        ///< name of the group that was found, or "rejected"
  double confidence = 0.0;  ///< that it is a symmetry; of a rejected turn from its shares, as the library does
  double excess = 0.0;      ///< on the mesh: the greater of the true shares over what is allowed of each

  bool isRight() const { return excess <= 1.0; }
};

/// Judges the group and the rejected turns that are found in a cloud of a mesh.
/// \param options with the limits; its min_confidence says how unsure groups may be.
/// \param num_points of the cloud.
/// \throws std::invalid_argument where the mesh has no area.
std::vector<JudgedRotation> judgedRotations(const pcl::PolygonMesh& mesh, const ObjectSymmetryOptions& options,
                                            int num_points);

/// Name of the group that is found in a cloud of a mesh.
std::string groupOf(const pcl::PolygonMesh& mesh, const ObjectSymmetryOptions& options, int num_points);

/// What is found of one mesh.
struct JudgedGroups {
  std::vector<JudgedRotation> rotations;
  std::vector<std::string> names;  ///< of the groups, one for each number of points
};

std::string packed(const JudgedGroups& groups);
/// \throws std::invalid_argument for bytes that packed() did not make.
JudgedGroups unpackedGroups(const std::string& bytes);

}  // namespace pcl_symmetry::apps
