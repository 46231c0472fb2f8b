/// A user's program without PCL: points in an Eigen matrix.
#include <pcl_symmetry/core/detect_planes.h>

#include <cmath>
#include <cstdio>

int main() {
  // An ellipsoid with the half axes 3, 2 and 1; the samples come in mirrored octuples.
  pcl_symmetry::Points points(3, 8 * 15 * 15);
  int column = 0;
  for (int i = 0; i < 15; ++i) {
    for (int j = 0; j < 15; ++j) {
      const double z = (i + 0.5) / 15, angle = M_PI / 2 * (j + 0.5) / 15, r = std::sqrt(1 - z * z);
      for (int octant = 0; octant < 8; ++octant) {
        points.col(column++) << float(octant & 1 ? 3 : -3) * float(r * std::cos(angle)),
            float(octant & 2 ? 2 : -2) * float(r * std::sin(angle)), float(octant & 4 ? z : -z);
      }
    }
  }
  const pcl_symmetry::Detection detection = pcl_symmetry::detectPlanes(points);
  for (const pcl_symmetry::SymmetryPlane& plane : detection.planes) {
    const Eigen::Vector3d n = plane.normal();
    std::printf("[%.4f %.4f %.4f] offset %.4f support %.3f\n", n.x(), n.y(), n.z(), plane.offset(), plane.support);
    if (n.cwiseAbs().maxCoeff() < 0.9999 || std::abs(plane.offset()) > 0.001) return 1;
  }
  return detection.planes.size() == 3 ? 0 : 1;
}
