#include "pcl_symmetry/symmetrization.h"

#include <pcl/common/io.h>

#include <cstring>

#include "pcl_symmetry/impl/cloud_conversion.hpp"

namespace pcl_symmetry {

namespace {

/// Writes positions into the fields x, y and z, which are float.
void setPositions(pcl::PCLPointCloud2& cloud, const Points& points) {
  for (const pcl::PCLPointField& field : cloud.fields)
    for (int axis = 0; axis < 3; ++axis)
      if (field.name == std::string(1, "xyz"[axis]))
        for (Eigen::Index i = 0; i < points.cols(); ++i)
          std::memcpy(&cloud.data[static_cast<std::size_t>(i) * cloud.point_step + field.offset], &points(axis, i),
                      sizeof(float));
}

}  // namespace

SymmetrizedMesh symmetrize(const pcl::PolygonMesh& mesh, const ReflectionPlane& plane, SymmetrizedHalf half,
                           int num_threads) {
  return detail::withBadArguments([&] {
    const detail::MeshArrays arrays = detail::toArrays(mesh);
    SymmetrizedShape shape = symmetrizedMesh(arrays.vertices, arrays.triangles, plane, half, num_threads);
    SymmetrizedMesh result{mesh, std::move(shape.asymmetry), shape.mean_asymmetry, shape.greatest_asymmetry,
                           shape.deviation};
    setPositions(result.mesh.cloud, shape.points);
    return result;
  });
}

pcl::PolygonMesh mirroredHalf(const pcl::PolygonMesh& mesh, const ReflectionPlane& plane, bool left,
                              std::vector<float>* values) {
  return detail::withBadArguments([&] {
    const detail::MeshArrays arrays = detail::toArrays(mesh);
    const MirroredMesh half = mirroredHalf(arrays.vertices, arrays.triangles, plane, left);
    pcl::PolygonMesh result;
    pcl::copyPointCloud(mesh.cloud, pcl::Indices(half.sources.begin(), half.sources.end()), result.cloud);
    setPositions(result.cloud, half.vertices);
    for (const Eigen::Vector3i& t : half.triangles) {
      result.polygons.emplace_back();
      for (const int i : t) result.polygons.back().vertices.push_back(i);
    }
    if (values) {
      std::vector<float> taken;
      for (const int i : half.sources) taken.push_back((*values)[i]);
      *values = std::move(taken);
    }
    return result;
  });
}

}  // namespace pcl_symmetry
