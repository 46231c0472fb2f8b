#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/geometry/surface_normals.h"
#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// The piece of surface that a sample represents: a disc in its tangent plane.
struct SurfaceDisc {
  Eigen::Vector3f center, normal;  ///< unit normal
  float radius;

  /// \return squared distance of a point; distances across the disc count the root of \p sq_across_factor times.
  float sqDistance(const Eigen::Vector3f& x, float sq_across_factor = 1.0f) const {
    const Eigen::Vector3f difference = x - center;
    const float across = normal.dot(difference), sq_across = across * across;
    const float sq_along = std::max(0.0f, difference.squaredNorm() - sq_across);
    if (sq_along <= radius * radius) return sq_across_factor * sq_across;
    const float beside = std::sqrt(sq_along) - radius;
    return sq_across_factor * sq_across + beside * beside;
  }
};

/// The surface that samples describe, as a disc in the tangent plane of each sample. Cells of a grid list the discs
/// near them, so that a point is compared with a few discs and needs no tree.
class SurfaceDiscs {
public:
  struct Nearest {
    int disc = -1;  ///< index of the sample; -1 where no disc is within reach
    float distance = std::numeric_limits<float>::infinity();
  };

  /// \param samples 3 x N, finite, N >= 1.
  /// \param geometry of the samples; must outlive this object, as must the samples.
  /// \param disc_radius spacings, > 0.
  /// \param reach greatest distance of a query, units of the samples, > 0.
  SurfaceDiscs(const Points& samples, const LocalGeometry& geometry, float disc_radius, float reach);

  /// The disc that is nearest to a point, of those within reach.
  Nearest nearest(const Eigen::Vector3f& x) const;

  /// Whether a disc is within \p distance <= reach of a point.
  bool isWithin(const Eigen::Vector3f& x, float distance) const;

  /// Distance of sample \p i from the discs of the others, as if it were a new sample. Distances across a disc count
  /// \p across_factor times.
  /// \return infinity where no other disc is within reach.
  float ownDistance(int i, float across_factor) const;

private:
  struct Range {
    const int *begin, *end;
  };

  Range discsNear(const Eigen::Vector3f& x) const;
  template <typename Visit>
  void visitCells(const SurfaceDisc& disc, const Visit& visit) const;

  std::vector<SurfaceDisc> discs_;
  float reach_;
  float cell_size_;
  Eigen::Vector3f origin_;  ///< corner of the grid
  Eigen::Array3i size_;     ///< cells along each axis
  std::vector<int> first_;  ///< of each cell, in entries_; one more at the end
  std::vector<int> entries_;
};

}  // namespace pcl_symmetry
