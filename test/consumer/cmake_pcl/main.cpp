/// A user's program with a point type of its own.
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl_symmetry/planar_symmetry_transform.h>
#include <pcl_symmetry/symmetry_detection.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>

struct LidarPoint {
  PCL_ADD_POINT4D;
  float range;
  std::uint16_t ring;
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};
POINT_CLOUD_REGISTER_POINT_STRUCT(LidarPoint, (float, x, x)(float, y, y)(float, z, z)(float, range,
                                                                                      range)(std::uint16_t, ring, ring))

/// A box of 4 x 3 x 2 around (10, 0, 0), whose samples have its three planes of symmetry.
pcl::PointCloud<LidarPoint>::Ptr makeBox() {
  auto cloud = pcl::make_shared<pcl::PointCloud<LidarPoint>>();
  const int n[3] = {40, 30, 20};
  for (int i = 0; i <= n[0]; ++i) {
    for (int j = 0; j <= n[1]; ++j) {
      for (int k = 0; k <= n[2]; ++k) {
        if (i % n[0] != 0 && j % n[1] != 0 && k % n[2] != 0) continue;
        LidarPoint point{};
        point.getVector3fMap() = Eigen::Vector3f(10 + 0.1f * (i - 20), 0.1f * (j - 15), 0.1f * (k - 10));
        point.range = point.getVector3fMap().norm();
        cloud->push_back(point);
      }
    }
  }
  return cloud;
}

int main() {
  const pcl::PointCloud<LidarPoint>::Ptr cloud = makeBox();

  pcl_symmetry::PlanarSymmetryTransform<LidarPoint> transform;
  transform.setInputCloud(cloud);
  const pcl_symmetry::SymmetryMap map = transform.compute();

  const std::vector<pcl_symmetry::SymmetryPlane> planes = pcl_symmetry::detectSymmetryPlanes(*cloud);
  const Eigen::Vector3d center(10, 0, 0);
  for (const pcl_symmetry::SymmetryPlane& plane : planes) {
    const Eigen::Vector3d n = plane.normal();
    std::printf("[%.4f %.4f %.4f] offset %.4f support %.3f\n", n.x(), n.y(), n.z(), plane.offset(), plane.support);
    if (n.cwiseAbs().maxCoeff() < 0.9999 || std::abs(n.dot(center) - plane.offset()) > 0.001) return 1;
  }
  if (planes.size() != 3 || map.empty()) return 1;

  // A cloud without an answer gives an empty result, a wrong parameter an exception that names it.
  if (!pcl_symmetry::detectSymmetryPlanes(pcl::PointCloud<LidarPoint>()).empty()) return 1;
  try {
    transform.setSigma(-1.0);
  } catch (const pcl::BadArgumentException& error) {
    return std::string(error.what()).rfind("sigma = -1, must be", 0) == 0 ? 0 : 1;
  }
  return 1;
}
