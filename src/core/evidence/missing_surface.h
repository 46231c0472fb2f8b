#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/geometry/surface_normals.h"
#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// Finds the points of a cloud that are farthest along a direction, for many directions.
///
/// The points are kept by cells. Cells whose boxes end before what was found are passed over, so that most questions
/// look at a few cells alone.
class OutermostPoints {
public:
  /// \param points 3 x N, finite, N > 0; copied.
  explicit OutermostPoints(const Points& points);

  Eigen::Index size() const { return static_cast<Eigen::Index>(index_of_.size()); }
  const Eigen::Vector3f& mean() const { return mean_; }

  /// The point that is farthest along a direction; of several the first one.
  Eigen::Vector3f last(const Eigen::Vector3f& direction) const;

  /// Calls visit(index of the point, the point, its distance along the direction) for the points of which this distance
  /// is at least \p from.
  template <typename Visit>
  void visitFrom(const Eigen::Vector3f& direction, float from, const Visit& visit) const {
    for (const Cell& cell : cells_) {
      if (cell.bound(direction) < from) continue;
      for (std::size_t i = cell.begin; i < cell.end; ++i)
        if (const float value = along(direction, i); value >= from) visit(index_of_[i], at(i), value);
    }
  }

  /// Whether a point lies within a distance of x.
  bool reach(const Eigen::Vector3f& x, float distance) const;

private:
  struct Cell {
    Eigen::Vector3f least, most;  ///< corners of the box of its points
    std::size_t begin, end;       ///< positions of its points in the order of cells

    /// No point of the cell is farther along the direction. As along() is computed, so that rounding keeps the order.
    float bound(const Eigen::Vector3f& direction) const {
      const auto corner = [&](int k) { return direction[k] > 0.0f ? most[k] : least[k]; };
      return direction.x() * corner(0) + direction.y() * corner(1) + direction.z() * corner(2);
    }
  };

  Eigen::Vector3f at(std::size_t i) const { return {coordinates_[0][i], coordinates_[1][i], coordinates_[2][i]}; }

  float along(const Eigen::Vector3f& direction, std::size_t i) const {
    return direction.x() * coordinates_[0][i] + direction.y() * coordinates_[1][i] + direction.z() * coordinates_[2][i];
  }

  std::vector<Cell> cells_;
  std::array<std::vector<float>, 3> coordinates_;  ///< of the points, cell after cell
  std::vector<Eigen::Index> index_of_;             ///< of these points, among those that were given
  Eigen::Vector3f mean_;
};

/// How well the end of a cloud explains that a piece of its reflection has no counterpart.
///
/// Not in the paper. Where a piece of an object was cut off, the reflection goes on beyond a plane, and the surface
/// runs into that plane: its normals lie along it. A part that an object has on one side alone has its reflection
/// beyond the surface, too, but there the surface closes: its normals stand on the plane. No open border is needed, so
/// that parts as thin as the spacing, whose borders are not seen, and parts without any edge to what is matched are
/// told as well. What ends far from the piece, as the rim of a mug ends far from its handle, explains nothing.
/// \param cloud the N points of the cloud.
/// \param normals 3 x N, unit, of arbitrary sign.
/// \param piece reflections of neighboring points without counterpart.
/// \param spacing median distance of the points.
/// \return in [0, 1]: 1 where the cloud was cut off before the piece, 0 where a counterpart should be there.
float beyondEnd(const OutermostPoints& cloud, const Points& normals, const OutermostPoints& piece, double spacing);

/// The samples of a cloud, as points() of NormalizedCloud.
struct SampledSurface {
  const OutermostPoints& points;     ///< N
  const LocalGeometry& geometry;     ///< of them
  const std::vector<char>& borders;  ///< what openBorders() returned
  double spacing;                    ///< median distance of the points
};

/// How well the end of a cloud explains that a sample has no counterpart under a plane.
///
/// Neighboring samples without counterpart form regions. A region is explained as far as its edge runs along open
/// borders, at the samples themselves or at their reflections, more than chance would have it: short edges may do so by
/// chance, and so may those of a region all of whose samples lie near borders. Or its reflection lies beyond the end of
/// the cloud, see beyondEnd().
/// \param matched N values, 1 where the reflection of the sample lies on the surface.
/// \param closest N indices of the samples closest to the reflections; -1: none is near.
/// \param reflected 3 x N, the reflections.
/// \return N values in [0, 1]: 0 for samples that have a counterpart or should have one, 1 where it is missing from the
/// cloud.
std::vector<float> missingCounterparts(const SampledSurface& surface, const std::vector<char>& matched,
                                       const std::vector<int>& closest, const Points& reflected);

/// Where a cloud ends although the object may go on: at open borders, and where its surface runs into its end.
///
/// Beyond the paper, which has whole shapes. For a true plane the points without a counterpart begin where the cloud,
/// or its reflection, ends; for a false one they begin in the middle of the surface.
class SurfaceEnds {
public:
  /// \param points,geometry must outlive this object.
  /// \param found the neighbors of the points.
  /// \param spacing median distance of the points.
  /// \param num_threads 0 = one per core.
  SurfaceEnds(const Points& points, const LocalGeometry& geometry, const ClosestPointSearch& search,
              const FoundNeighbors& found, double spacing, int num_threads);

  /// For each sample, how surely its counterpart is missing from the cloud, in [0, 1].
  /// \param matched,closest,reflected as of missingCounterparts(), for all points.
  std::vector<float> missing(const std::vector<char>& matched, const std::vector<int>& closest,
                             const Points& reflected) const {
    return missingCounterparts({outermost_, geometry_, borders_, spacing_}, matched, closest, reflected);
  }

  /// How far open borders may excuse missing counterparts, in [0, 1]: 0 for a wire or an open sheet.
  double trust() const { return trust_; }

private:
  const LocalGeometry& geometry_;
  double spacing_;
  std::vector<char> borders_;
  OutermostPoints outermost_;
  double trust_;
};

}  // namespace pcl_symmetry
