#include <pcl/io/pcd_io.h>
#include <pcl_symmetry/symmetry_detection.h>
#include <iostream>

int main(int argc, char** argv) {
  pcl::PointCloud<pcl::PointXYZ> cloud;
  if (argc != 2 || pcl::io::loadPCDFile(argv[1], cloud) < 0) return 1;
  for (const pcl_symmetry::SymmetryPlane& plane : pcl_symmetry::detectSymmetryPlanes(cloud))
    std::cout << plane.coefficients().transpose() << "  confidence " << plane.confidence << "\n";
}
