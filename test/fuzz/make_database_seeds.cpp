/// The seed of fuzz_database: a small database.
#include <filesystem>
#include <iostream>

#include "pcl/clouds.h"
#include "pcl_symmetry/symmetry_database.h"

namespace {

using namespace pcl_symmetry;

pcl::PointCloud<pcl::PointXYZ> boxCloud(int seed) {
  test::Shape shape = test::box(120, test::Sampling::Random, static_cast<std::uint64_t>(seed));
  shape.points.row(1) *= seed;
  return *test::toCloud(shape);
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
