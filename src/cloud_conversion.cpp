#include <pcl/console/print.h>
#include <pcl/conversions.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/triangles.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/mesh_sampling.h"
#include "plain_exception.h"

namespace pcl_symmetry {

namespace detail {

void throwBadArgument(const std::string& message) {
  throw Plain<pcl::BadArgumentException>(message);
}

void checkAtLeast(const char* field, std::int64_t value, std::int64_t lower_limit) {
  const std::string rule = ">= " + std::to_string(lower_limit);
  withBadArguments([&] { check(value >= lower_limit, field, value, rule.c_str()); });
}

std::string reasonForNoAnswer(const Points& points, const std::string& input, int min_points,
                              const pcl::Indices* indices) {
  std::string reason = whyUnanswerable(points);
  if (indices && points.cols() == 0)
    reason = indices->empty() ? "the indices are empty" : reason + " among the indices";
  if (reason.empty() && points.cols() < min_points)
    reason = std::to_string(points.cols()) + " points, must be at least " + std::to_string(min_points);
  return reason.empty() ? reason : input + ": " + reason;
}

void warnOfNoAnswer(const std::string& source, const std::string& reason) {
  PCL_WARN("[pcl_symmetry::%s] %s.\n", source.c_str(), reason.c_str());
}

std::vector<std::size_t> drawOneOfEachRun(std::size_t num_points, std::size_t max_points, std::uint64_t seed) {
  return oneOfEachRun(num_points, max_points, seed);
}

Eigen::Vector4d unitPlane(const Eigen::Vector4d& coefficients) {
  const double length = coefficients.head<3>().norm();
  if (!(length > 0.0) || !coefficients.allFinite())
    throwBadArgument("ground: must be four finite numbers A,B,C,D, not all of A, B, C zero");
  return coefficients / length;
}

MeshArrays toArrays(const pcl::PolygonMesh& mesh) {
  MeshArrays arrays;
  arrays.vertices.resize(3, 0);
  // PCL's conversions refer to the first point, also where there is none.
  if (mesh.cloud.width > 0 && mesh.cloud.height > 0) {
    pcl::PointCloud<pcl::PointXYZ> cloud;
    pcl::fromPCLPointCloud2(mesh.cloud, cloud);
    arrays.vertices = cloud.getMatrixXfMap(3, 4, 0);
  }
  for (const pcl::Vertices& polygon : mesh.polygons) {
    for (const auto index : polygon.vertices) {
      const auto vertex = static_cast<Eigen::Index>(index);
      check(vertex >= 0 && vertex < arrays.vertices.cols(), "vertex of a polygon", vertex, "one that the mesh has");
    }
    const std::vector<int>& corners = arrays.polygons.emplace_back(polygon.vertices.begin(), polygon.vertices.end());
    for (std::size_t i = 2; i < corners.size(); ++i)
      arrays.triangles.emplace_back(corners[0], corners[i - 1], corners[i]);
  }
  return arrays;
}

bool MeshArrays::hasArea() const {
  return std::any_of(triangles.begin(), triangles.end(), [&](const Eigen::Vector3i& triangle) {
    const Eigen::Vector3d a = vertices.col(triangle[0]).cast<double>();
    const Eigen::Vector3d b = vertices.col(triangle[1]).cast<double>();
    const Eigen::Vector3d c = vertices.col(triangle[2]).cast<double>();
    const double doubled_area = (b - a).cross(c - a).norm();
    return std::isfinite(doubled_area) && doubled_area > 0.0;
  });
}

}  // namespace detail

pcl::PointCloud<pcl::PointXYZ>::Ptr sampleMesh(const pcl::PolygonMesh& mesh, int num_points, std::uint64_t seed) {
  detail::checkAtLeast("num_points", num_points, 1);
  return detail::withBadArguments([&] {
    auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
    cloud->header = mesh.header;
    const detail::MeshArrays arrays = detail::toArrays(mesh);
    if (!arrays.hasArea()) {
      detail::warnOfNoAnswer("sampleMesh", "mesh: no polygon has an area");
      return cloud;
    }
    const Points points = sampleTriangles(arrays.vertices, arrays.triangles, num_points, seed);
    cloud->resize(points.cols());
    cloud->getMatrixXfMap(3, 4, 0) = points;
    return cloud;
  });
}

MeshSurface meshSurface(const pcl::PolygonMesh& mesh) {
  return detail::withBadArguments([&] {
    const detail::MeshArrays arrays = detail::toArrays(mesh);
    return MeshSurface(arrays.vertices, arrays.triangles);
  });
}

}  // namespace pcl_symmetry
