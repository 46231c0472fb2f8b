/// Parts of a cloud, and which of them are each other's image; written as a field that viewers colour by.
#include <pcl/common/io.h>
#include <pcl/io/pcd_io.h>
#include <pcl_symmetry/symmetry_segmentation.h>

#include <iostream>

int main(int argc, char** argv) {
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  if (argc != 3 || pcl::io::loadPCDFile(argv[1], *cloud) < 0) {
    std::cerr << "usage: 07_segmentation CLOUD.pcd LABELLED.pcd\n";
    return 2;
  }
  pcl_symmetry::SymmetrySegmentation<pcl::PointXYZ> segmentation;
  segmentation.setInputCloud(cloud);  // or setInputMesh(): then indices and labels count its polygons
  std::vector<pcl::PointIndices> segments;
  segmentation.segment(segments);
  for (std::size_t i = 0; i < segments.size(); ++i)
    std::cout << "part " << i << ": " << segments[i].indices.size() << " points\n";

  // One list for each plane that maps most of the surface onto itself.
  for (const std::vector<int>& image : segmentation.getImages())
    for (std::size_t i = 0; i < image.size(); ++i)
      if (image[i] > static_cast<int>(i)) std::cout << "parts " << i << " and " << image[i] << " are images\n";

  pcl::PointCloud<pcl::PointXYZL> labelled;
  pcl::copyPointCloud(*cloud, labelled);
  for (std::size_t i = 0; i < labelled.size(); ++i)
    // -1, of points in no part, wraps to the largest label.
    labelled[i].label = static_cast<std::uint32_t>(segmentation.getLabels()[i]);
  return pcl::io::savePCDFileBinary(argv[2], labelled) < 0 ? 1 : 0;
}
