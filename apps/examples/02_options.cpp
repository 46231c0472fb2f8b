/// The options of the search: weaker planes, axes, more cells, fewer threads; and the map that the planes come from.
#include <pcl/io/pcd_io.h>
#include <pcl_symmetry/planar_symmetry_transform.h>
#include <pcl_symmetry/symmetry_maxima_refinement.h>

#include <iostream>
#include <string>

int main(int argc, char** argv) {
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  if (argc != 2 || pcl::io::loadPCDFile(argv[1], *cloud) < 0) {
    std::cerr << "usage: 02_options CLOUD.pcd\n";
    return 2;
  }

  pcl_symmetry::PlanarSymmetryTransform<pcl::PointXYZ> transform;
  transform.setInputCloud(cloud);
  transform.setMapSize(32, 128, 64);  // theta, phi, r
  const pcl_symmetry::SymmetryMap map = transform.compute();
  if (map.empty()) return 1;  // too few points; PCL_WARN has said why
  std::cout << map.values.size() << " planes, the best has D = " << map[map.strongest()] << "\n";

  pcl_symmetry::SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  refinement.setInputCloud(cloud);
  refinement.setSymmetryMap(map, transform.getDistanceTransform());  // otherwise it computes its own map
  refinement.setMinConfidence(0.8);  // planes of at least this confidence are symmetries
  refinement.setApproximate(true);   // reports other planes too, marked by their kind
  refinement.setMaxPlanes(5);
  refinement.setNumberOfThreads(2);  // the result does not depend on it
  for (const pcl_symmetry::SymmetryPlane& plane : refinement.compute()) {
    const bool whole = plane.kind == pcl_symmetry::PlaneKind::Symmetry;
    std::cout << (whole ? "symmetry " : "weaker   ") << plane.coefficients().transpose() << "  confidence "
              << plane.confidence << ", support " << plane.support << ", score " << plane.score << "\n";
    for (const pcl_symmetry::Reason& reason : plane.reasons)
      std::cout << "  " << reason.rule << (reason.odds ? ": odds x " + std::to_string(*reason.odds) : "") << "\n";
  }
  for (const pcl_symmetry::SymmetryAxis& axis : refinement.getAxes())
    std::cout << "axis of revolution through " << axis.point.transpose() << " along " << axis.direction.transpose()
              << "\n";
  for (const auto& [stage, ms] : refinement.getDetection().timing_ms) std::cout << stage << " " << ms << " ms\n";
}
