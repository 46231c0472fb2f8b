/// The first plane of symmetry of a cloud, with nothing to tune.
#include <pcl/io/pcd_io.h>
#include <pcl_symmetry/symmetry_detection.h>

#include <algorithm>
#include <iostream>

int main(int argc, char** argv) {
  pcl::PointCloud<pcl::PointXYZ> cloud;
  if (argc != 2 || pcl::io::loadPCDFile(argv[1], cloud) < 0) {
    std::cerr << "usage: 01_first_plane CLOUD.pcd\n";
    return 2;
  }
  const std::vector<pcl_symmetry::SymmetryPlane> planes = pcl_symmetry::detectSymmetryPlanes(cloud);
  if (planes.empty()) {
    std::cout << "no symmetry plane\n";
    return 0;
  }
  std::cout << "a b c d = " << planes[0].coefficients().transpose() << ", confidence " << planes[0].confidence << "\n";

  const auto measured = std::find_if(cloud.begin(), cloud.end(), [](const auto& p) { return pcl::isFinite(p); });
  const Eigen::Vector3d point = measured->getVector3fMap().cast<double>();
  std::cout << point.transpose() << " reflects to " << planes[0].reflect(point).transpose() << "\n";
}
