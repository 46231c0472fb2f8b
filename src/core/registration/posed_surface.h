#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <future>
#include <optional>
#include <vector>

#include "core/evidence/surface_samples.h"
#include "core/geometry/closest_points.h"
#include "core/refinement/landing.h"
#include "pcl_symmetry/core/closest_point_search.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

/// One of two clouds to be aligned, with everything needed to judge a pose.
struct PosedSurface {
  Points points;               ///< 3 x N
  Points normals;              ///< 3 x N, unit, toward the viewpoint if is_oriented, otherwise of any sign
  bool is_oriented = false;    ///< whether all points were seen from one viewpoint
  std::vector<float> spacing;  ///< N, distance between neighboring samples at each point
  std::vector<int> order;      ///< N, the points in random order: the first k are an even sample of the surface
  double accuracy = 0.0;  ///< distance within which samples of one surface meet, from their spacing and their noise
  double noise = 0.0;     ///< scatter of the samples about the surface
  std::optional<Visibility> seen;  ///< what the scanner saw; nothing = the cloud shows its object from all sides
  /// Grid of closest points, computed on first use; exact judgments do not need it.
  std::shared_future<ClosestPointGrid> grid;
  std::shared_future<std::vector<char>> borders;  ///< N, 1 at an open border; computed on first use
  ClosestPointSearch::Ptr search;

  /// \param points 3 x N, finite, N >= 1.
  /// \param seen what the scanner saw, in the frame of the points.
  PosedSurface(const PointsRef& points, std::optional<Visibility> seen, std::uint64_t seed, int num_threads);
  /// A surface of a few points in random order with known normals, for coarse judgments: the grid of closest points is
  /// coarser, and search, borders, spacing and accuracy, which exact judgments need, are not set.
  PosedSurface(const PointsRef& points, const PointsRef& normals, std::optional<Visibility> seen);

  /// \return squared distance of an image in \p landing from the disc about its closest point, as wide as the spacing.
  float sqDiscDistance(const Landing& landing, Eigen::Index i) const {
    const int j = landing.closest[i];
    return SurfaceDisc{points.col(j), normals.col(j), spacing[j]}.sqDistance(landing.images.col(i));
  }
};

/// \return the cosine between the normals of an image and of its closest point, with its sign only if both surfaces are
/// oriented, which distinguishes the two sides of a thin part.
float normalCosine(const PosedSurface& from, const PosedSurface& onto, const Landing& landing, Eigen::Index i);

/// Finds where the first points of a surface lie on another one, in its frame.
/// \param exact closest points from the tree; otherwise from the grid, without distances.
Landing land(const PosedSurface& from, const PosedSurface& onto, const Eigen::Isometry3d& T_onto_from, int num_points,
             bool exact = true);

}  // namespace pcl_symmetry
