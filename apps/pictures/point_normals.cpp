#include "pictures/point_normals.h"

#include <limits>
#include <vector>

#include "core/geometry/surface_normals.h"
#include "pcl_symmetry/core/closest_point_search.h"

namespace pcl_symmetry::apps {

namespace {

/// Neighbours that give the normal of a point. chosen: half shows noise as specks, twice rounds edges.
constexpr int kShadingNeighbours = 12;
/// chosen: with fewer points neighbours lie all around the shape.
constexpr std::size_t kMinShadedPoints = 16;

}  // namespace

Points pointNormals(const pcl::PointCloud<pcl::PointXYZ>& points, const Normalization& normalize) {
  Points result =
      Points::Constant(3, static_cast<Eigen::Index>(points.size()), std::numeric_limits<float>::quiet_NaN());
  Points finite(3, static_cast<Eigen::Index>(points.size()));
  std::vector<Eigen::Index> index;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d position = points[i].getVector3fMap().cast<double>();
    if (!position.allFinite()) continue;
    finite.col(static_cast<Eigen::Index>(index.size())) = normalize(position).cast<float>();
    index.push_back(static_cast<Eigen::Index>(i));
  }
  if (index.size() < kMinShadedPoints || index.size() > kMaxShadedPoints) return result;
  finite.conservativeResize(3, static_cast<Eigen::Index>(index.size()));
  const Points normals = localGeometry(finite, *makeFlannSearch(finite), kShadingNeighbours, 0).normals;
  for (std::size_t i = 0; i < index.size(); ++i) result.col(index[i]) = normals.col(static_cast<Eigen::Index>(i));
  return result;
}

}  // namespace pcl_symmetry::apps
