#include "tools/model_files.h"

#include <algorithm>
#include <array>
#include <boost/crc.hpp>
#include <boost/filesystem.hpp>
#include <cstdio>
#include <fstream>

#include "command_line/input_files.h"
#include "command_line/file_errors.h"
#include "io/input_shape.h"

namespace pcl_symmetry::apps {

namespace fs = boost::filesystem;

namespace {

// derived: CRC-64/XZ of ECMA-182.
using CRC64 = boost::crc_optimal<64, 0x42F0E1EBA9EA3693, 0xFFFFFFFFFFFFFFFF, 0xFFFFFFFFFFFFFFFF, true, true>;
constexpr std::size_t kPiece = 1 << 16;  // bytes read at once. chosen: half and twice take the same time

std::string nameOf(const fs::path& path, const fs::path& folder, bool by_path) {
  if (!by_path || folder.empty()) return path.stem().string();
  std::string name = fs::relative(path, folder).replace_extension().string();
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

}  // namespace

std::vector<ModelFile> modelFiles(const std::vector<std::string>& arguments, bool by_path) {
  std::vector<ModelFile> files;
  const InputFiles inputs = inputFiles(arguments);
  for (std::size_t i = 0; i < inputs.size(); ++i)
    files.push_back({inputs.path(i), nameOf(inputs[i].path, inputs[i].folder, by_path)});
  return files;
}

std::string fileChecksum(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, kPiece> piece;
  CRC64 checksum;
  while (file.read(piece.data(), piece.size()) || file.gcount() > 0)
    checksum.process_bytes(piece.data(), static_cast<std::size_t>(file.gcount()));
  if (!file.eof()) throw InputError(path + ": cannot be read");
  char digits[17];
  std::snprintf(digits, sizeof(digits), "%016llx", static_cast<unsigned long long>(checksum.checksum()));
  return digits;
}

std::vector<ModelInput> modelInputs(const std::vector<ModelFile>& files, int mesh_points, std::uint64_t seed,
                                    const std::vector<std::string>& tags) {
  std::vector<ModelInput> inputs;
  for (const auto& [path, name] : files) {
    const auto source = [path = path, mesh_points, tags] {
      return ModelSource{fs::absolute(path).lexically_normal().string(),
                         fileChecksum(path) + "-" + std::to_string(mesh_points), tags};
    };
    const auto load = [path = path, mesh_points, seed] {
      const InputShape input = loadInput(path, mesh_points, seed);
      // Poses of recognition are those of the model's file; a shift would be lost.
      if (!input.shift().isZero(0.0))
        throw InputError(path + ": its coordinates are too large for its extent, must be moved near the origin");
      return *input.points;
    };
    inputs.push_back({name, source, load});
  }
  return inputs;
}

}  // namespace pcl_symmetry::apps
