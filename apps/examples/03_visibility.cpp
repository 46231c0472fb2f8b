/// A scan from one side: the position of the scanner separates free space from space that it could not see.
#include <pcl/io/pcd_io.h>
#include <pcl_symmetry/symmetry_maxima_refinement.h>

#include <algorithm>
#include <iostream>

int main(int argc, char** argv) {
  pcl::PointCloud<pcl::PointXYZ>::Ptr scan(new pcl::PointCloud<pcl::PointXYZ>);
  if (argc != 2 || pcl::io::loadPCDFile(argv[1], *scan) < 0) {
    std::cerr << "usage: 03_visibility SCAN.pcd\n";
    return 2;
  }
  pcl_symmetry::SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  refinement.setInputCloud(scan);
  // By default, the data decide: the rays of an organized cloud, otherwise sensor_origin_ if the points can be seen
  // from there, otherwise the density of the points. getViewpointSource() tells which. setViewpoint() overrides that,
  // and Mode::None treats the cloud as a whole object.
  const std::vector<pcl_symmetry::SymmetryPlane> planes = refinement.compute();
  std::cout << (refinement.usedViewpoint() ? "a scan, seen from one side\n" : "a whole object\n");
  if (planes.empty()) {
    std::cout << "no symmetry plane\n";
    return 0;
  }
  std::cout << planes[0].coefficients().transpose() << "  confidence " << planes[0].confidence << ", "
            << 100.0 * planes[0].seen << " % of the reflections could be seen\n";

  // Points whose reflection meets the surface, and points whose counterpart was hidden from the scanner.
  const std::vector<float>& support = planes[0].point_support;
  const auto supporting = std::count_if(support.begin(), support.end(), [](float s) { return s > 0.5f; });
  std::cout << supporting << " of " << support.size() << " points have a counterpart in the scan\n";

  refinement.setViewpointMode(pcl_symmetry::Viewpoint::Mode::None);
  const auto without = refinement.compute();
  std::cout << "taken for a whole object: " << without.size() << (without.size() == 1 ? " plane" : " planes") << "\n";
}
