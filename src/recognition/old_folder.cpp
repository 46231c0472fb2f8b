#include "recognition/old_folder.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "recognition/packed_model.h"
#include "recognition/io_error.h"

namespace pcl_symmetry::detail {

namespace {

constexpr const char* kOldHeader = "pcl_symmetry database 2";  // derived: what version 0.1 wrote

/// \param path of a binary PCD file with the fields x, y and z.
PositionCloud readOldCloud(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::size_t size = 0;
  std::string line;
  while (std::getline(file, line) && line != "DATA binary")
    if (line.rfind("POINTS ", 0) == 0) size = std::strtoull(line.c_str() + 7, nullptr, 10);
  std::error_code error;
  if (!file || size == 0 || size > std::filesystem::file_size(path, error)) failIO(path, "cannot be read");
  PositionCloud cloud(static_cast<std::uint32_t>(size), 1);
  for (pcl::PointXYZ& point : cloud) file.read(reinterpret_cast<char*>(point.data), 3 * sizeof(float));
  if (!file) failIO(path, "is incomplete");
  return cloud;
}

}  // namespace

std::vector<ModelInput> modelsOfOldFolder(const std::string& folder) {
  const std::filesystem::path path(folder);
  const std::string manifest = (path / "manifest.txt").string();
  std::ifstream text(manifest);
  std::string header, name, file;
  std::getline(text, header);
  if (header != kOldHeader) failIO(manifest, std::string("must begin with '") + kOldHeader + "'");
  std::size_t next_file = 0, num_references = 0, num_models = 0;
  if (!(text >> next_file >> num_references >> file >> num_models)) failIO(manifest, "its second line is damaged");
  std::vector<ModelInput> models;
  while (models.size() < num_models) {
    if (!(text >> name >> file) || file.find('/') != std::string::npos)
      failIO(manifest, "model " + std::to_string(models.size() + 1) + ": must be a name and a file of the folder");
    const std::string cloud = (path / (file + ".pcd")).string();
    models.push_back({name, [cloud] { return ModelSource{cloud, "", {}}; }, [cloud] { return readOldCloud(cloud); }});
  }
  return models;
}

}  // namespace pcl_symmetry::detail
