#pragma once

#include <pcl/PolygonMesh.h>

#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// A polygon mesh of PCL as plain arrays.
struct MeshArrays {
  Points vertices;                         ///< 3 x V, input units; may be not finite
  std::vector<std::vector<int>> polygons;  ///< indices of vertices, each valid
  std::vector<Eigen::Vector3i> triangles;  ///< those of a polygon have its first corner in common

  /// \return whether any polygon with finite corners has an area.
  bool hasArea() const;
};

/// \throws std::invalid_argument where a polygon refers to a vertex that the mesh does not have.
MeshArrays toArrays(const pcl::PolygonMesh& mesh);

}  // namespace pcl_symmetry
