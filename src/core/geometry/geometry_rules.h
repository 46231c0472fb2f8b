#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <utility>

#include "core/base/constants.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry {

/// Parameters of this module that affect results.
struct GeometryRules {
  // Points that can be analyzed
  /// Thickness of a line, as a share of its length: five times the rounding of a line about the origin.
  double line_thickness = 1e-6;

  // Stray points
  double bulk = 0.9;         ///< share of the points whose distance from their middle is half the size of a cloud
  double max_stray = 0.05;   ///< greatest share of stray points; more are a part of the shape
  int max_stray_group = 16;  ///< greatest number of distinct points in a stray group; more are a part of the shape
  /// Least width of the gap around stray points, in spacings of points spread evenly over a ball.
  float stray_spacings = 10.0f;
  float min_stray_gap = 0.1f, max_stray_gap = 1.0f;  ///< limits of that gap, in sizes of the cloud

  // Normals
  int fewest_cell_points = 6;  ///< least points around a cell for a normal: twice the three that span a plane

  // Open borders
  int border_neighbors = 16;  ///< neighbors searched for a gap
  /// Least gap at a border, radians; inside the surface, 0.5 % of the gaps between 16 random directions are greater.
  float border_gap = 150.0f * static_cast<float>(kPi) / 180.0f;
  /// Least share of its distance by which a neighbor is off the tangent plane to count as such: 30 degrees.
  float off_plane = 0.5f;
  int max_off_plane = 2;  ///< greatest number of neighbors off the plane; more indicate a fold

  // Balls
  Eigen::Index ball_points = 2'500;  ///< greatest number of candidates for the outermost points
  int ball_iterations = 60;          ///< number of iterations, which bring the radius within 1 % of the smallest

  // Axes of normals
  /// Angle by which a normal of half weight misses the axis, radians: noise of a third of the spacing.
  double normal_miss = 0.1;
  int reweightings = 8;             ///< number of reweightings; bodies with a base need this many
  double min_lever = 0.05;          ///< least lever by which speeds are divided, radii
  double translation_ridge = 1e-6;  ///< ridge that keeps the translation along a cylinder at 0, share of the trace
  double position_ridge = 1e-9;     ///< ridge for the position along parallel normals, which they leave undetermined

  // Local geometry
  /// Offset of the neighbors' mean from a point at which the point counts as at the border, in distances to the last
  /// neighbor; 0.25 by chance, 0.42 beside half a disc.
  double border_offset = 0.38;
};

inline constexpr GeometryRules kGeometry{};

/// A plane is a symmetry if it maps at least this share of the surface to within the tolerance of the surface
/// (src/pages/algorithms/decision.md).
constexpr double kSymmetricShare = 0.97;

/// Below this share an object is asymmetric, from it to kSymmetricShare nearly symmetric.
constexpr double kNearlySymmetricShare = 0.9;

/// Two planes or two lines within both limits count as the same.
struct MergeTolerance {
  double angle;  ///< greatest angle between the normals or directions, radians
  /// Greatest difference of the offsets of planes, or distance of lines, at the origin of their frame; units of that
  /// frame.
  double offset;

  bool same(const ReflectionPlane& a, const ReflectionPlane& b) const {
    const double sign = a.normal().dot(b.normal()) < 0.0 ? -1.0 : 1.0;
    return a.angleTo(b) <= angle && std::abs(a.offset() - sign * b.offset()) <= offset;
  }

  bool same(const Line3d& a, const Line3d& b) const {
    return std::abs(a.direction().dot(b.direction())) > std::cos(angle) &&
           a.distance(b.projection(Eigen::Vector3d::Zero())) < offset;
  }

  /// Planes and lines themselves, as entries of a list.
  struct Itself {
    template <typename Motion>
    const Motion& operator()(const Motion& motion) const {
      return motion;
    }
  };

  /// \param of member or function that gives the plane or line of an entry.
  /// \return whether the list has an entry that counts as the same.
  template <typename List, typename Motion, typename Of = Itself>
  bool anySame(const List& list, const Motion& motion, const Of& of = {}) const {
    return std::any_of(list.begin(), list.end(),
                       [&](const auto& entry) { return same(std::invoke(of, entry), motion); });
  }

  /// \param of as above.
  /// \return the first \p max_count entries that differ from all earlier ones, in their order.
  template <typename List, typename Of = Itself>
  List distinct(List list, const Of& of = {}, std::size_t max_count = std::numeric_limits<std::size_t>::max()) const {
    List kept;
    for (auto& entry : list) {
      if (kept.size() == max_count) break;
      if (!anySame(kept, std::invoke(of, entry), of)) kept.push_back(std::move(entry));
    }
    return kept;
  }
};

/// Limits within which two planes count as the same, normalized frame.
inline constexpr MergeTolerance kSamePlane{0.035, 0.02};

/// Limits within which two maxima share one basin of refinement, normalized frame: a peak of D is 0.1 radians wide.
inline constexpr MergeTolerance kSameMaximum{0.1, 0.06};

}  // namespace pcl_symmetry
