/// A user's program with one of PCL's point types: the templates come from the library.
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl_symmetry/model_coefficients.h>
#include <pcl_symmetry/planar_symmetry_transform.h>
#include <pcl_symmetry/symmetry_detection.h>

#include <cmath>
#include <cstdio>

int main() {
  // An elliptic cylinder, cut slantwise: the plane y = 0.5 alone is a symmetry.
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (int i = 0; i < 100; ++i) {
    for (int j = 0; j < 40; ++j) {
      const double angle = 2 * M_PI * (i + 0.5) / 100, x = 2 * std::cos(angle), y = std::sin(angle), height = 3 + x;
      cloud->emplace_back(float(x), float(y + 0.5), float(height * (j + 0.5) / 40));
    }
  }
  pcl_symmetry::PlanarSymmetryTransform<pcl::PointXYZ> transform;
  transform.setInputCloud(cloud);
  const pcl_symmetry::SymmetryMap map = transform.compute();

  const std::vector<pcl_symmetry::SymmetryPlane> planes = pcl_symmetry::detectSymmetryPlanes(*cloud);
  for (const pcl_symmetry::SymmetryPlane& plane : planes) {
    const Eigen::Vector3d n = plane.normal();
    std::printf("[%.4f %.4f %.4f] offset %.4f support %.3f\n", n.x(), n.y(), n.z(), plane.offset(), plane.support);
  }
  const bool found = planes.size() == 1 && std::abs(planes[0].normal().y()) > 0.9999 &&
                     std::abs(std::abs(planes[0].offset()) - 0.5) < 0.001;
  return found && !map.empty() && pcl_symmetry::toModelCoefficients(planes[0]).values.size() == 4 ? 0 : 1;
}
