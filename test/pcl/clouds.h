/// The synthetic shapes and scans as PCL clouds, and what PCL's classes say of wrong parameters.
#pragma once

#include <pcl/exceptions.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "shapes/complaint.h"
#include "shapes/scans.h"

namespace pcl_symmetry::test {

template <typename PointT = pcl::PointXYZ>
typename pcl::PointCloud<PointT>::Ptr toCloud(const Points& points) {
  auto cloud = pcl::make_shared<pcl::PointCloud<PointT>>();
  cloud->resize(points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) (*cloud)[i].getVector3fMap() = points.col(i);
  return cloud;
}

template <typename PointT = pcl::PointXYZ>
typename pcl::PointCloud<PointT>::Ptr toCloud(const Shape& shape) {
  return toCloud<PointT>(shape.cloud());
}

/// \return the organized cloud of a scan.
template <typename PointT = pcl::PointXYZ>
typename pcl::PointCloud<PointT>::Ptr pictureOf(const Scan& scan,
                                                const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity()) {
  const auto cloud = toCloud<PointT>(moved(scan.pixels, pose));
  cloud->width = scan.width;
  cloud->height = scan.height;
  cloud->is_dense = false;
  return cloud;
}

/// Puts a point that is not finite before every \p stride-th point.
template <typename PointT>
typename pcl::PointCloud<PointT>::Ptr withHoles(const pcl::PointCloud<PointT>& cloud, std::size_t stride) {
  auto result = pcl::make_shared<pcl::PointCloud<PointT>>();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (i % stride == 0) {
      PointT hole = cloud[i];
      hole.y = i % (2 * stride) ? std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
      result->push_back(hole);
    }
    result->push_back(cloud[i]);
  }
  result->is_dense = false;
  return result;
}

/// Clouds that hold no answer, with what they are.
inline std::vector<std::pair<std::string, pcl::PointCloud<pcl::PointXYZ>::Ptr>> cloudsWithoutAnswer() {
  using Cloud = pcl::PointCloud<pcl::PointXYZ>;
  const float none = std::numeric_limits<float>::quiet_NaN();
  std::vector<std::pair<std::string, Cloud::Ptr>> clouds{
      {"no cloud", nullptr},
      {"no point", pcl::make_shared<Cloud>()},
      {"no finite point", pcl::make_shared<Cloud>(50, 1, pcl::PointXYZ(none, 0.0f, 0.0f))},
      {"one point", pcl::make_shared<Cloud>(1, 1, pcl::PointXYZ(1.0f, 2.0f, 3.0f))},
      {"one place", pcl::make_shared<Cloud>(50, 1, pcl::PointXYZ(1.0f, 2.0f, 3.0f))}};
  const auto few = pcl::make_shared<Cloud>(), line = pcl::make_shared<Cloud>();
  for (int i = 0; i < 19; ++i)
    for (int copy = 0; copy < 3; ++copy) few->emplace_back(0.1f * i, 0.01f * (i * i % 7), 0.02f * (i * i % 5));
  for (int i = 0; i < 200; ++i) line->emplace_back(1.0f + 0.3f * i, 0.2f * i, -0.1f * i);
  clouds.emplace_back("19 distinct points", few);
  clouds.emplace_back("a line", line);
  return clouds;
}

/// Counts its queries, to prove that it is used: without a lock, as a search that is derived from one of PCL's is
/// called from one thread at a time.
class CountingKdTree : public pcl::search::KdTree<pcl::PointXYZ> {
public:
  using Ptr = pcl::shared_ptr<CountingKdTree>;
  using pcl::search::KdTree<pcl::PointXYZ>::nearestKSearch;

  int nearestKSearch(const pcl::PointXYZ& point, int k, pcl::Indices& indices,
                     std::vector<float>& sq_distances) const override {
    ++num_queries;
    return pcl::search::KdTree<pcl::PointXYZ>::nearestKSearch(point, k, indices, sq_distances);
  }

  mutable int num_queries = 0;
};

/// \return what a class of PCL says of wrong parameters.
template <typename Body>
std::string messageOf(const Body& body) {
  return complaintOf<pcl::BadArgumentException>(body);
}

}  // namespace pcl_symmetry::test
