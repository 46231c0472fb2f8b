/// Cuts a cloud into parts, says which parts are images of each other, and writes the parts as labels of the points.
#include <pcl/common/io.h>
#include <pcl/io/pcd_io.h>
#include <pcl_symmetry/symmetry_segmentation.h>

#include <iostream>

int main(int argc, char** argv) {
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  if (argc != 3 || pcl::io::loadPCDFile(argv[1], *cloud) < 0) {
    std::cerr << "usage: 07_segmentation CLOUD.pcd LABELED.pcd\n";
    return 2;
  }
  pcl_symmetry::SymmetrySegmentation<pcl::PointXYZ> segmentation;
  segmentation.setInputCloud(cloud);  // or setInputMesh(): then indices and labels count its polygons
  std::vector<pcl::PointIndices> segments;
  segmentation.extract(segments);
  for (std::size_t i = 0; i < segments.size(); ++i)
    std::cout << "part " << i << ": " << segments[i].indices.size() << " points\n";

  // One list for each plane that maps most of the surface onto itself.
  for (const std::vector<int>& image : segmentation.getImages())
    for (std::size_t i = 0; i < image.size(); ++i)
      if (image[i] > static_cast<int>(i)) std::cout << "parts " << i << " and " << image[i] << " are images\n";

  pcl::PointCloud<pcl::PointXYZL> labeled;
  pcl::copyPointCloud(*cloud, labeled);
  for (std::size_t i = 0; i < labeled.size(); ++i)
    // Points in no part have -1, which becomes the largest label.
    labeled[i].label = static_cast<std::uint32_t>(segmentation.getLabels()[i]);
  return pcl::io::savePCDFileBinary(argv[2], labeled) < 0 ? 1 : 0;
}
