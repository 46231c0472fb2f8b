/// The side of an object that a scanner did not see: what its plane of symmetry adds.
#include <pcl/io/pcd_io.h>
#include <pcl_symmetry/completion.h>
#include <pcl_symmetry/symmetry_maxima_refinement.h>

#include <iostream>

int main(int argc, char** argv) {
  const pcl::PointCloud<pcl::PointXYZ>::Ptr scan(new pcl::PointCloud<pcl::PointXYZ>);
  if (argc != 3 || pcl::io::loadPCDFile(argv[1], *scan) < 0) {
    std::cerr << "usage: 11_completion SCAN.pcd COMPLETED.pcd\n";
    return 2;
  }
  pcl_symmetry::SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  refinement.setInputCloud(scan);
  const std::vector<pcl_symmetry::SymmetryPlane> planes = refinement.compute();  // possible ones, too
  if (planes.empty()) {
    std::cout << "no plane of symmetry\n";
    return 0;
  }
  const auto completed = pcl_symmetry::completeBySymmetry(*scan, planes.front());
  std::cout << completed.added.size() << " points added to " << scan->size() << "\n";
  return pcl::io::savePCDFileBinary(argv[2], completed.cloud) < 0 ? 1 : 0;
}
