#include "core/matching/surface_points.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "core/base/simd.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/surface_normals.h"

namespace pcl_symmetry {

namespace {

// Neighbours that give a normal. chosen: normals are compared in steps of 15 degrees; half follows the noise, twice
// blurs edges.
constexpr int kNeighbours = 16;
// Share of the plane that discs about the points cover, of radius half their least distance, where no further point has
// a place. derived: the jamming limit of random sequential adsorption of discs, 0.547; a little less, so that there are
// enough points.
constexpr double kCovered = 0.5;

// Points that the area is measured at. derived: squared spacings from 16 neighbours are off by a quarter, the mean of
// 1000 by 1 %, which changes the number of points by as much.
constexpr std::size_t kAreaSamples = 1000;
constexpr int kComparedTogether = 64;  // points. chosen: half calls more often, twice compares more than it must

PCL_SYMMETRY_MULTIVERSION int countWithin(const float* __restrict x, const float* __restrict y,
                                          const float* __restrict z, int size, const float* point, float sq_distance) {
  const float px = point[0], py = point[1], pz = point[2];
  int num_within = 0;
  for (int i = 0; i < size; ++i) {
    const float dx = px - x[i], dy = py - y[i], dz = pz - z[i];
    num_within += dx * dx + dy * dy + dz * dz < sq_distance ? 1 : 0;
  }
  return num_within;
}

/// Points that are at least some distance apart.
class SpreadPoints {
public:
  explicit SpreadPoints(double distance) : sq_distance_(static_cast<float>(distance * distance)) {}

  /// Takes a point unless it is near one that was taken.
  bool take(const Eigen::Vector3f& point) {
    const int size = static_cast<int>(x_.size());
    for (int i = 0; i < size; i += kComparedTogether)
      if (countWithin(x_.data() + i, y_.data() + i, z_.data() + i, std::min(kComparedTogether, size - i), point.data(),
                      sq_distance_) > 0)
        return false;
    x_.push_back(point.x());
    y_.push_back(point.y());
    z_.push_back(point.z());
    return true;
  }

private:
  float sq_distance_;
  std::vector<float> x_, y_, z_;
};

/// Points of the surface that are at least \p distance apart.
/// \param order of the points.
std::vector<int> spreadPoints(const Points& points, const std::vector<int>& order, double distance, int most) {
  SpreadPoints spread(distance);
  std::vector<int> chosen;
  for (const int i : order) {
    if (spread.take(points.col(i))) chosen.push_back(i);
    if (static_cast<int>(chosen.size()) == most) break;
  }
  return chosen;
}

/// Directions of the surface at its points, found for each when it is first asked for.
class PointNormals {
public:
  /// \param points,search must outlive this object.
  PointNormals(const Points& points, const ClosestPointSearch& search)
      : points_(points), search_(search), normals_(3, points.cols()), known_(static_cast<std::size_t>(points.cols())) {}

  Points at(const std::vector<int>& some) {
    std::vector<int> missing;
    std::copy_if(some.begin(), some.end(), std::back_inserter(missing),
                 [&](int i) { return !known_[static_cast<std::size_t>(i)]; });
    find(missing);
    return pointsAt(normals_, some);
  }

  /// \param some distinct.
  /// \return spacings there.
  std::vector<float> find(const std::vector<int>& some) {
    GeometryAtPlaces geometry = localGeometryAt(points_, search_, pointsAt(points_, some), kNeighbours);
    for (std::size_t k = 0; k < some.size(); ++k) {
      normals_.col(some[k]) = geometry.normals.col(static_cast<Eigen::Index>(k));
      known_[static_cast<std::size_t>(some[k])] = true;
    }
    return std::move(geometry.spacing);
  }

private:
  const Points& points_;
  const ClosestPointSearch& search_;
  Points normals_;
  std::vector<bool> known_;
};

/// Of the surface, from the spacing of some of its points.
double areaOf(PointNormals& normals, std::vector<int> order, Eigen::Index num_points) {
  order.resize(std::min(order.size(), kAreaSamples));
  double sum = 0.0;
  for (const float spacing : normals.find(order)) sum += static_cast<double>(spacing) * spacing;
  return sum / static_cast<double>(order.size()) * static_cast<double>(num_points);
}

}  // namespace

std::vector<SurfacePoints> evenSurfacePoints(const Points& points, const std::vector<int>& counts, std::uint64_t seed) {
  const ClosestPointSearch::Ptr search = makeFlannSearch(points);
  const std::vector<int> order = drawSamples(points.cols(), static_cast<int>(points.cols()) - 1, seed);
  PointNormals normals(points, *search);
  const double area = areaOf(normals, order, points.cols());
  std::vector<SurfacePoints> found;
  for (const int count : counts) {
    std::vector<int> chosen = allOf(points.cols());
    // Discs of half the distance cover that share of the area.
    if (points.cols() > count)
      chosen = spreadPoints(points, order, std::sqrt(4.0 * kCovered * area / (std::acos(-1.0) * count)), count);
    found.push_back({pointsAt(points, chosen), normals.at(chosen)});
  }
  return found;
}

SurfacePoints evenSurfacePoints(const Points& points, int count, std::uint64_t seed) {
  return std::move(evenSurfacePoints(points, std::vector<int>{count}, seed).front());
}

}  // namespace pcl_symmetry
