/// The objects of one frame of a depth camera, each with its symmetries, and the scene with their unseen sides added.
#include <pcl/io/pcd_io.h>
#include <pcl_symmetry/symmetry_scene.h>

#include <iostream>

int main(int argc, char** argv) {
  const pcl_symmetry::SymmetryScene::Cloud::Ptr frame(new pcl_symmetry::SymmetryScene::Cloud);
  if (argc != 3 || pcl::io::loadPCDFile(argv[1], *frame) < 0) {
    std::cerr << "usage: 10_scene FRAME.pcd COMPLETED.pcd\n";
    return 2;
  }
  pcl_symmetry::SymmetryScene scene;
  scene.setInputCloud(frame);
  const pcl_symmetry::SceneAnalysis found = scene.compute();
  std::cout << found.supports.size() << " supporting planes\n";

  pcl_symmetry::SymmetryScene::Cloud completed = *frame;
  for (const pcl_symmetry::SceneObject& object : found.objects) {
    std::cout << "object of " << object.indices.size() << " points " << object.reason << "\n";
    for (const pcl_symmetry::SymmetryPlane& plane : object.planes)
      std::cout << "  plane " << plane.coefficients().transpose() << " confidence " << plane.confidence << "\n";
    for (const pcl_symmetry::SymmetryAxis& axis : object.axes)
      std::cout << "  axis along " << axis.direction.transpose() << " confidence " << axis.confidence << "\n";
    completed += object.added;
  }
  return pcl::io::savePCDFileBinary(argv[2], completed) < 0 ? 1 : 0;
}
