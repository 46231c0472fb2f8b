#pragma once

#include <functional>
#include <vector>

#include "pcl_symmetry/symmetry_scene.h"
#include "scene/scene_parts.h"

namespace pcl_symmetry::detail {

/// The data of SymmetryScene for joining pieces.
struct JoiningScene {
  SymmetryScene::Cloud::ConstPtr frame;
  const std::vector<SupportingPlane>& supports;
  SceneDistances distances;
  double tolerance;  ///< how far a symmetric surface may be off, as a share of the diagonal
  int num_threads;   ///< 0 = one per core
  /// Gives what the sensor saw, for an object with these points.
  std::function<SeenSpace(const pcl::Indices&)> seen_of;
  /// Finds the planes and axes of an object with these points; it is one of several that are analyzed at once, by
  /// several threads.
  std::function<SceneObject(const pcl::Indices&, std::size_t num_objects)> analyze;
  /// Sets the models that an object shows, and returns whether one is accepted. Empty if there are no models.
  std::function<bool(SceneObject&)> is_named;
};

struct JoinedPieces {
  std::vector<SceneObject> objects;      ///< with planes and axes, most points first
  std::vector<SceneJunction> junctions;  ///< junctions of the pieces that touch
};

/// Keeps the cuts between convex pieces that symmetry confirms.
///
/// Pieces side by side whose normals point to one upright line belong to one body of revolution, like the two halves of
/// the inside of a bowl. A bottle and its neck are one object if both have the same axis. A mug and its handle are one
/// if the handle does not stand on the support of the mug, and the union has a plane through the axis of the mug, or
/// that axis, that explains each piece by itself. Pieces stay separate if their own symmetries explain many of their
/// points and neither is flat, like a face of a box or a part of a wall; all others are united again. If no model
/// explains such a union, the pieces that a model explains stay separate: cameras blur the symmetries of objects that
/// touch.
/// \param pieces of clusters, ascending indices.
/// \param cluster_of number of the cluster of each piece.
JoinedPieces joinBySymmetry(const JoiningScene& scene, const std::vector<pcl::Indices>& pieces,
                            const std::vector<int>& cluster_of);

}  // namespace pcl_symmetry::detail
