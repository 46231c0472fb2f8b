#pragma once

#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/geometry/point_set.h"

namespace pcl_symmetry {

/// The closest neighbours of each point, with which most queries that come with a guess need no tree.
///
/// A point at a distance d from a query has all points that are closer to the query within 2 d of itself. If its
/// neighbours reach as far as that, one of them is the closest point of all, or it is that point itself.
class NeighbourLists {
public:
  static constexpr int kNeighbours = 8;  ///< of each point. derived: floats in a register of AVX2
  /// chosen: 128 bytes a point; beyond, filling the lists takes longer than they save
  static constexpr Eigen::Index kMostPoints = 50'000;

  /// Whether there are lists for \p num_points points: enough, not too many, and the instructions for them.
  static bool isUseful(Eigen::Index num_points);

  /// \pre isUseful(points.cols())
  /// \param points 3 x N.
  /// \param nearest kNeighbours + 1 indices for each point, nearest first, as a search for that point finds them.
  /// \param sq_reach squared distance of the last one of each point.
  NeighbourLists(const Points& points, const std::vector<int>& nearest, const std::vector<float>& sq_reach);

  struct Answer {
    int index;          ///< the closest point that was seen
    float sq_distance;  ///< of it
    bool is_closest;    ///< no other point is as close
  };
  /// \param query three coordinates.
  /// \param guess index of a point.
  Answer closest(const float* query, int guess) const;

  /// Has the list of a point brought from memory, for a query that follows.
  void prefetch(int guess) const {
    const auto i = static_cast<std::size_t>(guess);
    __builtin_prefetch(&places_[i]);
    __builtin_prefetch(lists_[i].x);
    __builtin_prefetch(lists_[i].z);
  }

private:
  struct List {
    float x[kNeighbours], y[kNeighbours], z[kNeighbours];
    std::int32_t index[kNeighbours];
  };
  /// A point, and how far it may be from a query so that its list decides.
  struct Place {
    float x, y, z, most_sq_distance;
  };

  std::vector<List> lists_;
  std::vector<Place> places_;
};

}  // namespace pcl_symmetry
