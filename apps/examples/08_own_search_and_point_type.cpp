/// A point type of the user's own, and a search of PCL in place of the library's. PCL_NO_PRECOMPILE includes the bodies
/// of PCL's octree.
#define PCL_NO_PRECOMPILE
#include <pcl/io/pcd_io.h>
#include <pcl/search/octree.h>
#include <pcl_symmetry/symmetry_maxima_refinement.h>

#include <iostream>

struct WeldPoint {
  PCL_ADD_POINT4D;
  float heat = 0.0f;
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};
POINT_CLOUD_REGISTER_POINT_STRUCT(WeldPoint, (float, x, x)(float, y, y)(float, z, z)(float, heat, heat))

int main(int argc, char** argv) {
  pcl::PointCloud<pcl::PointXYZ> file;
  if (argc != 2 || pcl::io::loadPCDFile(argv[1], file) < 0) {
    std::cerr << "usage: 08_own_search_and_point_type CLOUD.pcd\n";
    return 2;
  }
  pcl::PointCloud<WeldPoint>::Ptr cloud(new pcl::PointCloud<WeldPoint>);
  for (const pcl::PointXYZ& point : file) {
    WeldPoint weld;
    weld.getVector3fMap() = point.getVector3fMap();
    cloud->push_back(weld);
  }

  pcl_symmetry::SymmetryMaximaRefinement<WeldPoint> refinement;
  refinement.setInputCloud(cloud);
  refinement.setSearchMethod(pcl::make_shared<pcl::search::Octree<WeldPoint>>(0.05));
  for (const pcl_symmetry::SymmetryPlane& plane : refinement.compute())
    std::cout << plane.coefficients().transpose() << "  confidence " << plane.confidence << "\n";
}
