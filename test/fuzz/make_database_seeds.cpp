/// The seed of fuzz_database: a small database.
#include <filesystem>
#include <iostream>

#include "pcl_symmetry/symmetry_database.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;

pcl::PointCloud<pcl::PointXYZ> boxCloud(int seed) {
  RandomStream random(static_cast<std::uint64_t>(seed));
  pcl::PointCloud<pcl::PointXYZ> cloud;
  for (int i = 0; i < 120; ++i) {
    Eigen::Vector3d p(test::symmetric(random), test::symmetric(random), test::symmetric(random));
    p[i % 3] = i % 2 ? 1.0 : -1.0;
    p.y() *= seed;
    cloud.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
  return cloud;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: " << argv[0] << " FOLDER\nWrites the seed of fuzz_database into the folder.\n";
    return 2;
  }
  const std::filesystem::path folder(argv[1]);
  std::filesystem::create_directories(folder);
  const std::string file = (folder / "seed0").string();
  std::filesystem::remove(file);
  DatabaseOptions options;
  options.num_views = 4;
  SymmetryDatabase database(file, options);
  for (int i = 1; i <= 3; ++i) database.add("box" + std::to_string(i), boxCloud(i));
  database.save();
  return 0;
}
