/// Seeds for fuzz_database: a small database, and the parts of models as they stand in one.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>

#include "core/views/view_code.h"
#include "pcl_symmetry/recognition/symmetry_database.h"
#include "recognition/packing/packed_model.h"
#include "recognition/search/compact_forms.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;

/// \param kind the first byte, by which fuzz_database chooses.
void write(const std::filesystem::path& folder, const std::string& name, char kind, const std::string& bytes) {
  std::ofstream(folder / name, std::ios::binary) << kind << bytes;
}

pcl::PointCloud<pcl::PointXYZ> boxCloud(int seed) {
  RandomStream random(static_cast<std::uint64_t>(seed));
  pcl::PointCloud<pcl::PointXYZ> cloud;
  for (int i = 0; i < 120; ++i) {
    Eigen::Vector3d p(test::symmetric(random), test::symmetric(random), test::symmetric(random));
    p[i % 3] = i % 2 ? 1.0 : -1.0;
    cloud.push_back({float(p.x()), float(p.y() * seed), float(p.z())});
  }
  return cloud;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: " << argv[0] << " FOLDER\nWrites the seeds of fuzz_database into the folder.\n";
    return 2;
  }
  const std::filesystem::path folder(argv[1]);
  std::filesystem::create_directories(folder);
  const std::string file = (folder / "models.db").string();
  std::filesystem::remove(file);
  {
    DatabaseOptions options;
    options.num_views = 4;
    SymmetryDatabase database(file, options);
    for (int i = 1; i <= 3; ++i) database.add("box" + std::to_string(i), boxCloud(i));
    database.save();
  }
  std::ifstream text(file, std::ios::binary);
  write(folder, "file", '\0', {std::istreambuf_iterator<char>(text), {}});
  std::filesystem::remove(file);
  const Eigen::MatrixXf signatures = Eigen::MatrixXf::Random(12, 2);
  View view{};
  view.radius = 1.0f;
  view.values = Eigen::VectorXf::Random(kViewSignatureSize).normalized();
  view.T_view_input.setIdentity();
  write(folder, "cloud", '\1', detail::packedCloud(boxCloud(1)));
  write(folder, "signatures", '\2', detail::packedSignatures(signatures));
  write(folder, "views", '\3', detail::packedViews({view, view}));
  write(folder, "form", '\4', detail::CompactForm{Eigen::MatrixXf::Random(8, detail::kFormsPerModel), 0.5f}.packed());
  write(folder, "view_codes", '\6', packedViewCodes({ViewCode{}, ViewCode{}}));
  return 0;
}
