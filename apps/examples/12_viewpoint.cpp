/// The direction from which an object shows little twice, and a camera there.
#include <pcl/io/pcd_io.h>
#include <pcl_symmetry/symmetry_maxima_refinement.h>
#include <pcl_symmetry/viewpoint_selection.h>

#include <iostream>

int main(int argc, char** argv) {
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  if (argc != 2 || pcl::io::loadPCDFile(argv[1], *cloud) < 0) {
    std::cerr << "usage: 12_viewpoint CLOUD.pcd\n";
    return 2;
  }
  pcl_symmetry::SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  refinement.setInputCloud(cloud);
  refinement.setApproximate(true);  // planes of parts count, too
  const std::vector<pcl_symmetry::SymmetryPlane> planes = refinement.compute();
  pcl_symmetry::ViewpointSelection selection;
  selection.setPlanes(planes, refinement.getAxes(), findLocalMaxima(refinement.getSymmetryMap()));
  selection.setInputCloud(cloud);
  const pcl_symmetry::SelectedView best = selection.getBestView();
  std::cout << "seen from " << best.direction.transpose() << ", score " << best.score << "\n"
            << "camera\n"
            << best.pose.matrix() << "\n"
            << "worst " << selection.getWorstView().direction.transpose() << "\n";
}
