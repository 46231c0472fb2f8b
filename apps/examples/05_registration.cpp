/// Registers a scan to a model of its object from any pose, by a class that is used like PCL's registrations.
#include <pcl/io/pcd_io.h>
#include <pcl_symmetry/symmetry_registration.h>

#include <iostream>

int main(int argc, char** argv) {
  using Cloud = pcl::PointCloud<pcl::PointXYZ>;
  Cloud::Ptr scan(new Cloud), model(new Cloud);
  if (argc != 3 || pcl::io::loadPCDFile(argv[1], *scan) < 0 || pcl::io::loadPCDFile(argv[2], *model) < 0) {
    std::cerr << "usage: 05_registration SCAN.pcd MODEL.pcd\n";
    return 2;
  }
  pcl_symmetry::SymmetryRegistration<pcl::PointXYZ, pcl::PointXYZ> registration;
  registration.setInputSource(scan);
  registration.setInputTarget(model);
  Cloud aligned;
  registration.align(aligned);
  if (!registration.hasConverged()) {
    std::cout << "the scan does not fit the model: " << registration.getReason() << "\n";
    return 0;
  }
  std::cout << registration.getFinalTransformation() << "\nconfidence " << registration.getConfidence() << "\n";
}
