#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "pcl_symmetry/core/closest_point_search.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry {

/// Sums over points that give their mean and covariance.
/// Floats are precise enough for points near the origin of their frame.
struct Moments {
  float count = 0.0f;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();

  void add(const Eigen::Vector3f& p) {
    count += 1.0f;
    sum += p;
    squares += p * p.transpose();
  }
  void operator+=(const Moments& other) {
    count += other.count;
    sum += other.sum;
    squares += other.squares;
  }

  /// Sum of the outer products of the deviations from the mean: the covariance times count.
  Eigen::Matrix3f scatter() const { return squares - sum * sum.transpose() / count; }
};

/// Neighbors of the closest sample that also decide whether a point lies on the surface. A sample is within reach at
/// 1.25 spacings, and a circle of that radius holds pi 1.25^2 = 5 samples on average.
constexpr int kNumDiscNeighbors = 4;

/// The surface at each sample, estimated from its neighbors.
struct LocalGeometry {
  Points normals;                ///< 3 x N, unit, of arbitrary sign
  std::vector<float> roughness;  ///< N, root mean square distance of the neighbors from the tangent plane
  /// 1 if the neighbors lie to one side of a sample: the rim of a scan, or a sharp edge; N values.
  std::vector<char> at_border;
  /// N, the closest other samples, nearest first; the sample itself if there are no more
  std::vector<std::array<int, kNumDiscNeighbors>> nearest;
  /// N, distance between neighboring samples: 1 / sqrt(density), input units
  std::vector<float> spacing;
};

/// Neighbors that determine normals and spacing. The error of the spacing from k neighbors is 1 / (2 sqrt(k)), 18 % for
/// 8; fewer exceed 20 %.
constexpr int kNumSupportNeighbors = 8;

/// The closest points of each sample.
struct FoundNeighbors {
  std::vector<int> indices;
  std::vector<float> sq_reach;
};

/// Normals by PCA of the nearest neighbors, and the local spacing of the samples.
///
/// The spacing comes from the distance r_k to the k-th neighbor: a surface of density rho has k = pi rho r_k^2
/// neighbors within r_k.
/// \param points 3 x N, finite.
/// \param search search over the same points.
/// \param[out] neighbors found neighbors, including the point itself: for each point num_neighbors + 1 indices, nearest
/// first, or as many as there are points, and the squared distance of the last one; may be null.
/// \param num_neighbors >= 3; clouds with fewer points use all of them.
LocalGeometry localGeometry(const Points& points, const ClosestPointSearch& search, int num_threads,
                            FoundNeighbors* neighbors = nullptr, int num_neighbors = kNumSupportNeighbors);

/// \return the normals of points, with the signs by which they face a viewer.
Points normalsToward(Points normals, const PointsRef& points, const Eigen::Vector3f& viewpoint);

/// A part of LocalGeometry at a few of the points.
struct GeometryAtPositions {
  Points normals;                         ///< 3 x M
  std::vector<float> roughness, spacing;  ///< M values, input units
};

/// \param points 3 x N, finite.
/// \param search search over the same points.
/// \param positions 3 x M, some of the points.
GeometryAtPositions localGeometryAt(const Points& points, const ClosestPointSearch& search, const Points& positions,
                                    int num_neighbors = kNumSupportNeighbors);

/// Finds the points at the open borders of a sampled surface: the neighbors in the tangent plane leave a gap, and the
/// surface does not fold there.
/// \param samples 3 x N, finite.
/// \param search search over the same samples.
/// \param normals 3 x N, unit.
/// \param known the closest points of each sample, as from localGeometry(): if they leave no gap, no others are
/// searched; the result is the same. Null = not known.
/// \return N values, 1 at a border.
std::vector<char> openBorders(const Points& samples, const ClosestPointSearch& search, const Points& normals,
                              int num_threads, const FoundNeighbors* known = nullptr);

/// The points within two steps of a border along neighbors: about three spacings.
/// \param borders what openBorders() returned.
/// \param geometry local geometry of the samples.
/// \return N values, 1 near a border.
std::vector<char> nearBorders(const std::vector<char>& borders, const LocalGeometry& geometry);

/// Probability that a position between two neighboring samples lies within about three spacings of an open border by
/// chance.
/// \param borders what openBorders() returned.
/// \param geometry local geometry of the samples.
/// \return in [0, 1]; 0 for a closed surface, 1 for a wire.
double shareNearBorders(const std::vector<char>& borders, const LocalGeometry& geometry);

/// Axis and center that the normals of a surface point to (Pottmann and Wallner, Computational Line Geometry, 2001).
/// Not in the paper.
///
/// The normals of a body of revolution all meet its axis, and those of a sphere its center. Few normals suffice, so
/// that the axis of a body seen from one side is found even where hardly two of its planes are maxima of the transform.

/// The line that most of the normals meet or are parallel to. Points are weighted by how well they fit, so that a
/// handle or a base does not move it.
/// \param points 3 x N, finite, about the unit ball.
/// \param normals 3 x N, unit, of any sign.
/// \param samples indices of points, at least one.
/// \return the best line, whether the points lie on a body of revolution or not.
Line3d axisOfNormals(const Points& points, const Points& normals, const std::vector<int>& samples);

/// The point that most of the normals meet.
/// \param points,normals,samples as in axisOfNormals().
Eigen::Vector3d centerOfNormals(const Points& points, const Points& normals, const std::vector<int>& samples);

/// One normal for each occupied cell of a coarse grid. It depends neither on the density of the points nor on noise
/// below the size of a cell.
struct CellNormals {
  Eigen::Matrix3Xf normals;         ///< 3 x C, unit, of arbitrary sign
  Eigen::VectorXf flatness;         ///< C, in [0, 1]: 1 for a plane, 0 where the points show no surface
  std::vector<int> cell_of_points;  ///< N, column of `normals` for each point
};

/// Fits a plane to the points of each occupied cell and its 26 neighbors.
/// \param points 3 x N, finite.
/// \param origin corner of the cube of cells. The few points outside it are assigned to the cells at its sides.
/// \param cell_size input units, > 0.
/// \param num_cells cells along each side of the cube.
CellNormals cellNormals(const PointsRef& points, const Eigen::Vector3d& origin, double cell_size, int num_cells);

}  // namespace pcl_symmetry
