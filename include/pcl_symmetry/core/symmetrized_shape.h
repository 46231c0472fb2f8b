#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// How the halves of a symmetrized shape are made.
enum class SymmetrizedHalf {
  Mean,  ///< both halves are the mean of the two sides
  Left,  ///< both halves are the side that the normal of the plane points away from
  Right  ///< both halves are the side that the normal of the plane points to
};

/// A shape that a plane maps onto itself, and how far the given one was from it.
struct SymmetrizedShape {
  Points points;  ///< 3 x N, the given points moved, input frame
  /// Indices of the points of a cloud that are kept; the symmetrized cloud consists of them and of their reflections.
  /// Empty for a mesh, whose vertices are all kept.
  std::vector<int> kept;
  /// For each given point, how far the shape lies outside the reflection of its other side there: signed distance along
  /// the normal, input units. NaN where the other side has nothing, and at points that are not finite.
  std::vector<float> asymmetry;
  double mean_asymmetry = 0.0;      ///< mean absolute asymmetry, input units; of a mesh, weighted by area
  double greatest_asymmetry = 0.0;  ///< greatest absolute asymmetry, input units
  /// Greatest distance of a reflected vertex of the result from the result, input units. If the triangles of the two
  /// sides do not match, it is the distance of a chord from the curved surface, see mirroredHalf(); 0 for a cloud.
  double deviation = 0.0;
};

/// Symmetrizes a mesh and keeps its triangles: each vertex moves to the mean of its position and the reflection of the
/// other side there, or to one of the two.
/// \param vertices 3 x V, input units; those that are not finite stay, and triangles with them are left out.
/// \param triangles indices of vertices.
/// \param num_threads >= 0; 0 = one per core.
/// \throws std::invalid_argument for an index out of range, and for a mesh without area.
SymmetrizedShape symmetrizedMesh(const PointsRef& vertices, const std::vector<Eigen::Vector3i>& triangles,
                                 const ReflectionPlane& plane, SymmetrizedHalf half, int num_threads = 0);

/// A mesh whose triangles a plane maps onto each other.
struct MirroredMesh {
  Points vertices;                         ///< 3 x M, input frame
  std::vector<Eigen::Vector3i> triangles;  ///< indices of these vertices
  /// For each vertex, the given vertex that it is or is the reflection of; at the cut, one beside it.
  std::vector<int> sources;
};

/// One side of a mesh, cut at the plane, and its reflection. A symmetrized mesh keeps its shape and gets triangles
/// that match: it is its own reflection but for the rounding of float.
/// \param left the side that the normal of the plane points away from.
MirroredMesh mirroredHalf(const PointsRef& vertices, const std::vector<Eigen::Vector3i>& triangles,
                          const ReflectionPlane& plane, bool left = true);

/// Symmetrizes a cloud: each point moves to the mean of the surface there and the reflection of the other side. For the
/// signs of the asymmetry, normals are assumed to point away from the center of mass.
/// \param points 3 x N, finite, N >= 1, input units.
SymmetrizedShape symmetrizedCloud(const PointsRef& points, const ReflectionPlane& plane, SymmetrizedHalf half,
                                  int num_threads = 0);

/// The counterpart of each point: the point closest to its reflection.
struct ReflectedPairs {
  std::vector<int> index;  ///< N indices; -1 if no point is within the distance, as on the unseen side of a scan
  /// N squared distances of the counterparts from the reflections, squared input units.
  std::vector<float> sq_distances;
};

/// Pairs each point with the one closest to its reflection.
/// \param points 3 x N, finite.
/// \param max_distance greatest distance of a counterpart from the reflection, input units, >= 0; 0 = 1 % of the
/// diameter.
ReflectedPairs reflectedPairs(const PointsRef& points, const ReflectionPlane& plane, double max_distance = 0.0);

/// The asymmetry of landmarks, as morphometrics defines it.
struct LandmarkAsymmetry {
  /// For each pair, the vector from the second landmark to the reflection of the first, input frame and units.
  std::vector<Eigen::Vector3d> paired;
  std::vector<double> unpaired;  ///< for each landmark of the midline, its signed distance from the plane, input units
  double paired_rms = 0.0;       ///< root mean square length of the vectors of `paired`, input units
  /// Object asymmetry: root mean square distance of all landmarks, both of each pair, from the mean of the
  /// configuration and its reflection with the landmarks of each pair exchanged; input units.
  double object_rms = 0.0;
};

/// Measures how far pairs of landmarks are from symmetric.
/// \param pairs landmarks and their counterparts, input frame, finite.
/// \param midline landmarks that have no counterpart, input frame, finite.
/// \param plane plane of object symmetry.
LandmarkAsymmetry landmarkAsymmetry(const std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>& pairs,
                                    const std::vector<Eigen::Vector3d>& midline, const ReflectionPlane& plane);

}  // namespace pcl_symmetry
