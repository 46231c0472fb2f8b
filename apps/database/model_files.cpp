#include "database/model_files.h"

#include <glob.h>

#include <algorithm>
#include <array>
#include <boost/algorithm/string.hpp>
#include <boost/crc.hpp>
#include <boost/filesystem.hpp>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "common/command_line/file_errors.h"
#include "common/files/file_text.h"
#include "common/shape_input/input_shape.h"

namespace pcl_symmetry::apps {

namespace fs = boost::filesystem;

namespace {

// derived: CRC-64/XZ of ECMA-182.
using CRC64 = boost::crc_optimal<64, 0x42F0E1EBA9EA3693, 0xFFFFFFFFFFFFFFFF, 0xFFFFFFFFFFFFFFFF, true, true>;
constexpr std::size_t kPiece = 1 << 16;  // bytes read at once. chosen: half and twice take the same time

bool isShapeFile(const fs::path& path) {
  const std::string ending = boost::algorithm::to_lower_copy(path.extension().string());
  return !ending.empty() && std::string(kShapeFiles).find(ending) != std::string::npos;
}

std::string nameOf(const fs::path& path, const fs::path& folder, bool by_path) {
  if (!by_path || folder.empty()) return path.stem().string();
  std::string name = fs::relative(path, folder).replace_extension().string();
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

void addFolder(const fs::path& folder, bool by_path, std::vector<ModelFile>& files) {
  std::vector<fs::path> found;
  try {
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (fs::is_regular_file(entry.path()) && isShapeFile(entry.path())) found.push_back(entry.path());
  } catch (const fs::filesystem_error& error) {
    throw InputError(folder.string() + ": " + error.code().message());
  }
  if (found.empty()) throw InputError(folder.string() + ": holds no file of type " + kShapeFiles);
  std::sort(found.begin(), found.end());
  for (const fs::path& path : found) files.push_back({path.string(), nameOf(path, folder, by_path)});
}

std::vector<std::string> filesOfPattern(const std::string& pattern) {
  glob_t found{};
  const int code = ::glob(pattern.c_str(), 0, nullptr, &found);
  std::vector<std::string> paths;
  if (code == 0) paths.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  ::globfree(&found);
  if (code != 0) throw InputError(pattern + ": no file has such a name");
  return paths;
}

std::vector<std::string> linesOf(const std::string& path) {
  std::istringstream text(readWholeFile(path));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) {
    boost::algorithm::trim(line);
    if (!line.empty() && line.front() != '#') lines.push_back(line);
  }
  return lines;
}

}  // namespace

std::vector<ModelFile> modelFiles(const std::vector<std::string>& arguments, bool by_path) {
  std::vector<ModelFile> files;
  const auto add = [&](const std::vector<std::string>& more) {
    for (ModelFile& file : modelFiles(more, by_path)) files.push_back(std::move(file));
  };
  for (const std::string& argument : arguments) {
    boost::system::error_code error;
    if (argument.size() > 1 && argument.front() == '@') {
      add(linesOf(argument.substr(1)));
    } else if (fs::is_directory(argument, error)) {
      addFolder(argument, by_path, files);
    } else if (!fs::exists(argument, error) && argument.find_first_of("*?[") != std::string::npos) {
      add(filesOfPattern(argument));
    } else {
      files.push_back({argument, nameOf(argument, {}, by_path)});
    }
  }
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
