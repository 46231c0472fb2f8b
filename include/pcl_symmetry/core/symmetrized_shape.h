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
  Mean,  ///< both the mean of the two sides
  Left,  ///< both the side that the normal of the plane points away from
  Right  ///< both the side that the normal of the plane points to
};

/// A shape that a plane maps onto itself, and how far the given one was from it.
struct SymmetrizedShape {
  Points points;  ///< 3 x N, the given points moved, input frame
  /// Indices of the points of a cloud that stay; the symmetrized cloud consists of them and of their reflections. Empty
  /// for a mesh, whose vertices all stay.
  std::vector<int> kept;
  /// N, by how much the shape at a given point lies outside of the reflection of its other side: signed distance along
  /// its normal, input units. NaN where the other side has nothing, and at points that are not finite.
  std::vector<float> asymmetry;
  double mean_asymmetry = 0.0;      ///< mean of the absolute values, of a mesh by area
  double greatest_asymmetry = 0.0;  ///< greatest absolute value
  /// Greatest distance of a vertex of the result, reflected, from the result, input units. Where triangles of the two
  /// sides do not match, it is the distance of a chord from the curved surface, see mirroredHalf(); 0 for a cloud.
  double deviation = 0.0;
};

/// Symmetrizes a mesh whose triangles stay: each vertex moves to the mean of itself and of the reflection of the other
/// side there, or to one of the two.
/// \param vertices 3 x V, input units; those that are not finite stay, and triangles with them are left out.
/// \param triangles indices of vertices.
/// \param num_threads >= 0; 0 = one per core.
/// \throws std::invalid_argument for an index that is no vertex, and a mesh without area.
SymmetrizedShape symmetrizedMesh(const PointsRef& vertices, const std::vector<Eigen::Vector3i>& triangles,
                                 const ReflectionPlane& plane, SymmetrizedHalf half, int num_threads = 0);

/// A mesh whose triangles a plane maps onto each other.
struct MirroredMesh {
  Points vertices;                         ///< 3 x M, input frame
  std::vector<Eigen::Vector3i> triangles;  ///< indices of these vertices
  std::vector<int> sources;  ///< M; the given vertex that each is, or is the reflection of; at the cut one beside it
};

/// One side of a mesh, cut at the plane, and its reflection. A symmetrized mesh keeps its shape and gets triangles
/// that match: it is its own reflection but for the rounding of float.
/// \param left the side that the normal of the plane points away from.
MirroredMesh mirroredHalf(const PointsRef& vertices, const std::vector<Eigen::Vector3i>& triangles,
                          const ReflectionPlane& plane, bool left = true);

/// Symmetrizes a cloud: points move to the mean of the surface at them and of the reflection of the other side there.
/// The signs of its asymmetry take normals to point away from the center of mass.
/// \param points 3 x N, finite, N >= 1, input units.
SymmetrizedShape symmetrizedCloud(const PointsRef& points, const ReflectionPlane& plane, SymmetrizedHalf half,
                                  int num_threads = 0);

/// The counterpart of each point: the point closest to its reflection.
struct ReflectedPairs {
  std::vector<int> index;           ///< N; -1 where no point is within the distance, as on the unseen side of a scan
  std::vector<float> sq_distances;  ///< N, of the counterpart from the reflection, squared input units
};

/// Pairs each point with the one closest to its reflection.
/// \param points 3 x N, finite.
/// \param max_distance of a counterpart from the reflection, input units, >= 0; 0 = 1 % of the diameter.
ReflectedPairs reflectedPairs(const PointsRef& points, const ReflectionPlane& plane, double max_distance = 0.0);

/// The asymmetry of landmarks, as morphometrics defines it.
struct LandmarkAsymmetry {
  /// For each pair, the vector from the second landmark to the reflection of the first, input frame and units.
  std::vector<Eigen::Vector3d> paired;
  std::vector<double> unpaired;  ///< of each landmark of the midline: signed distance from the plane
  double paired_rms = 0.0;       ///< root mean square length of the vectors of the pairs
  /// Root mean square distance of all landmarks, both of each pair, from those of the mean of the configuration and its
  /// reflection with the landmarks of each pair exchanged: object asymmetry.
  double object_rms = 0.0;
};

/// Measures how far pairs of landmarks are from symmetric.
/// \param pairs landmarks and their counterparts. \param midline landmarks that have none. Input frame, finite.
/// \param plane of object symmetry.
LandmarkAsymmetry landmarkAsymmetry(const std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>& pairs,
                                    const std::vector<Eigen::Vector3d>& midline, const ReflectionPlane& plane);

}  // namespace pcl_symmetry
