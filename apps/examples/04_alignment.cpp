/// The canonical frame of a cloud, whole or seen from one side: center of symmetry and principal symmetry axes.
#include <pcl/common/transforms.h>
#include <pcl/io/pcd_io.h>
#include <pcl_symmetry/symmetry_alignment.h>

#include <algorithm>
#include <iostream>

int main(int argc, char** argv) {
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  if (argc != 2 || pcl::io::loadPCDFile(argv[1], *cloud) < 0) {
    std::cerr << "usage: 04_alignment CLOUD.pcd\n";
    return 2;
  }
  pcl_symmetry::SymmetryAlignment<pcl::PointXYZ> alignment;
  alignment.setInputCloud(cloud);
  const pcl_symmetry::SymmetryFrame frame = alignment.compute();
  if (frame.equivalent.empty()) return 1;  // too few points; PCL_WARN has said why
  std::cout << "center of symmetry " << frame.center.transpose() << "\n";
  for (int k = 0; k < 3; ++k)
    std::cout << "axis " << k + 1 << "  " << frame.axes.col(k).transpose() << "  score " << frame.scores[k] << "\n";
  std::cout << "equally good frames: " << frame.equivalent.size() << "\n";

  pcl::PointCloud<pcl::PointXYZ> canonical;
  pcl::transformPointCloud(*cloud, canonical, frame.T_canonical_input.matrix().cast<float>().eval());
  const auto measured =
      std::find_if(canonical.begin(), canonical.end(), [](const auto& p) { return pcl::isFinite(p); });
  std::cout << "first point in its own frame: " << measured->getVector3fMap().transpose() << "\n";
}
