/// Which models are like a cloud, and which of them a scan shows: descriptors, and a database that finds and
/// recognizes.
#include <pcl/io/pcd_io.h>
#include <pcl_symmetry/prst.h>
#include <pcl_symmetry/symmetry_database.h>

#include <iostream>

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

/// The transform of the cloud in its canonical frame.
pcl_symmetry::PRSTSignature32768 describe(const Cloud::ConstPtr& cloud) {
  pcl_symmetry::PRSTEstimation<pcl::PointXYZ> estimation;
  estimation.setInputCloud(cloud);
  pcl::PointCloud<pcl_symmetry::PRSTSignature32768> descriptor;
  estimation.compute(descriptor);
  return descriptor.front();
}

int main(int argc, char** argv) {
  Cloud::Ptr query(new Cloud);
  if (argc < 4 || pcl::io::loadPCDFile(argv[2], *query) < 0) {
    std::cerr << "usage: 06_matching DATABASE QUERY.pcd MODEL.pcd ...\n";
    return 2;
  }
  const auto query_descriptor = describe(query);
  pcl_symmetry::SymmetryDatabase database(argv[1]);
  for (int i = 3; i < argc; ++i) {
    Cloud::Ptr model(new Cloud);
    if (pcl::io::loadPCDFile(argv[i], *model) < 0) return 1;
    const float distance = pcl_symmetry::descriptorDistance(query_descriptor, describe(model));
    std::cout << argv[i] << ": PRST " << distance << " away\n";
    database.add("model_" + std::to_string(i - 2), *model);
  }
  database.save();

  for (const auto& match : database.match(*query)) std::cout << match.name << " distance " << match.distance << "\n";
  const auto known = database.recognize(*query);
  if (known.empty()) std::cout << "unknown object\n";
  for (const auto& model : known)
    std::cout << model.name << " confidence " << model.confidence << "\n" << model.T_model_scan.matrix() << "\n";
}
