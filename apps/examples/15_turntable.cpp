/// Scans of an object on a turntable as one cloud, its planes of symmetry, and what they show of the side that no scan
/// saw.
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl_symmetry/completion.h>
#include <pcl_symmetry/register_all.h>
#include <pcl_symmetry/symmetry_detection.h>

#include <iostream>

int main(int argc, char** argv) {
  using Cloud = pcl::PointCloud<pcl::PointXYZ>;
  std::vector<Cloud::ConstPtr> scans;
  for (int i = 1; i + 1 < argc; ++i) {
    const std::string path = argv[i];
    const Cloud::Ptr scan(new Cloud);
    const bool is_ply = path.size() > 4 && path.substr(path.size() - 4) == ".ply";
    if ((is_ply ? pcl::io::loadPLYFile(path, *scan) : pcl::io::loadPCDFile(path, *scan)) < 0) return 1;
    scans.push_back(scan);
  }
  if (scans.empty()) {
    std::cerr << "usage: 15_turntable SCAN.pcd [SCAN.pcd ...] MERGED.pcd\n";
    return 2;
  }
  auto merged = pcl_symmetry::mergeScans<pcl::PointXYZ>(scans);
  for (std::size_t k = 0; k < scans.size(); ++k)
    if (const std::string& reason = merged.registration.scans[k].left_out; !reason.empty())
      std::cout << argv[k + 1] << " is left out: " << reason << "\n";
  const std::vector<pcl_symmetry::SymmetryPlane> planes = pcl_symmetry::detectSymmetryPlanes(merged.cloud);
  std::cout << merged.cloud.size() << " points, " << planes.size() << " planes of symmetry\n";
  if (!planes.empty()) merged.cloud = pcl_symmetry::completeBySymmetry(merged.cloud, planes.front()).cloud;
  return !merged.cloud.empty() && pcl::io::savePCDFileBinary(argv[argc - 1], merged.cloud) < 0 ? 1 : 0;
}
