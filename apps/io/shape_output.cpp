#include "io/shape_output.h"

#include <pcl/common/io.h>
#include <sys/stat.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "common/files/ply_check.h"
#include "io/standard_streams.h"
#include "io/temporary_file.h"

namespace pcl_symmetry::apps {

namespace fs = boost::filesystem;

namespace {

[[noreturn]] void failToWrite(const std::string& path, const std::string& why) {
  throw InputError(path + ": cannot be written, " + why);
}

/// \return the cloud without padding, its fields one after the other: PCL's PCD writer derives padding from the order
/// of the fields, and writes negative counts for types such as PointXYZRGBNormal whose order is not that in memory.
pcl::PCLPointCloud2 packed(const pcl::PCLPointCloud2& cloud) {
  pcl::PCLPointCloud2 result;
  result.header = cloud.header;
  result.width = cloud.width;
  result.height = cloud.height;
  result.is_dense = cloud.is_dense;
  result.is_bigendian = cloud.is_bigendian;
  std::vector<std::size_t> sources;
  for (pcl::PCLPointField field : cloud.fields) {
    if (field.name == "_") continue;
    sources.push_back(field.offset);
    field.count = std::max<pcl::uindex_t>(field.count, 1);
    field.offset = result.point_step;
    result.point_step += field.count * static_cast<pcl::uindex_t>(pcl::getFieldSize(field.datatype));
    result.fields.push_back(field);
  }
  result.row_step = result.point_step * result.width;
  const std::size_t num_points = std::size_t{cloud.width} * cloud.height;
  result.data.resize(num_points * result.point_step);
  for (std::size_t i = 0; i < num_points; ++i) {
    for (std::size_t k = 0; k < sources.size(); ++k) {
      const pcl::PCLPointField& field = result.fields[k];
      std::memcpy(&result.data[i * result.point_step + field.offset], &cloud.data[i * cloud.point_step + sources[k]],
                  field.count * static_cast<std::size_t>(pcl::getFieldSize(field.datatype)));
    }
  }
  return result;
}

/// Calls the writer with a temporary name and copies what it wrote to standard output.
void writeThrough(const std::function<void(const std::string&)>& writer) {
  const std::string temporary = makeUniqueFile(temporaryModel(""));
  if (temporary.empty()) failToWrite("standard output", std::strerror(errno));
  const TemporaryFile guard(temporary);
  writer(temporary);
  copyToStandardOutput(temporary);
}

/// Lines of points in a PCD file of text.
std::size_t numLinesOfPoints(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  for (std::string line; std::getline(file, line) && line.rfind("DATA", 0) != 0;) {
  }
  std::size_t lines = 0;
  std::vector<char> block(1 << 16);
  while (file.read(block.data(), static_cast<std::streamsize>(block.size())) || file.gcount() > 0)
    lines += static_cast<std::size_t>(std::count(block.begin(), block.begin() + file.gcount(), '\n'));
  return lines;
}

/// PCL's writers of text and of PLY do not look whether the disk took what they wrote.
bool isWhole(const std::string& path, const std::string& extension, PCDEncoding encoding, std::size_t num_points) {
  if (extension == ".ply") return isWholePLY(path);
  return encoding != PCDEncoding::Ascii || numLinesOfPoints(path) == num_points;
}

/// Of a cloud to be written; standard output takes PCD.
std::string lowerExtension(const std::string& path) {
  if (isStandardStream(path)) return ".pcd";
  return boost::algorithm::to_lower_copy(fs::path(path).extension().string());
}

}  // namespace

void writeAtomically(const std::string& path, const std::function<void(const std::string&)>& writer) {
  if (isStandardStream(path)) return writeThrough(writer);
  const fs::path target(path);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  boost::system::error_code ignored;
  if (path.empty()) throw InputError("output name is empty");
  if (fs::is_directory(target, ignored)) failToWrite(path, "it is a directory");
  if (!fs::is_directory(folder, ignored)) failToWrite(path, "there is no directory " + folder.string());

  const bool special = fs::exists(target, ignored) && !fs::is_regular_file(target, ignored);
  if (special) failToWrite(path, "it is not a regular file");
  const fs::path final_name = fs::is_symlink(target, ignored) ? fs::canonical(target, ignored) : target;

  const std::string temporary = makeUniqueFile(
      (final_name.parent_path() / ("." + target.stem().string() + ".%%%%%%%%" + target.extension().string())).string());
  if (temporary.empty()) failToWrite(path, std::strerror(errno));
  const TemporaryFile guard(temporary);

  writer(temporary);
  struct stat status {};
  if (stat(temporary.c_str(), &status) != 0 || status.st_size == 0) failToWrite(path, "nothing was written");
  if (std::rename(temporary.c_str(), final_name.c_str()) != 0) failToWrite(path, std::strerror(errno));
}

void makeFolder(const std::string& path) {
  boost::system::error_code error;  // Boost 1.74 has one for ".", which is there
  fs::create_directories(path, error);
  if (!fs::is_directory(path)) throw InputError(path + ": cannot be made, must be a folder");
}

void writeText(const std::string& path, const std::string& text) {
  if (isStandardStream(path)) return writeStandardOutput(text);
  writeAtomically(path, [&](const std::string& temporary) {
    std::ofstream file(temporary, std::ios::binary);
    file << text;
    file.close();
    if (!file) failToWrite(path, std::strerror(errno));
  });
}

void checkCloudExtension(const std::string& path) {
  const std::string extension = lowerExtension(path);
  if (extension != ".pcd" && extension != ".ply") throw UsageError(path + ": unknown extension, must be .pcd or .ply");
}

void saveCloud(const std::string& path, const pcl::PCLPointCloud2& cloud, const Eigen::Vector4f& sensor_origin,
               const Eigen::Quaternionf& sensor_orientation, PCDEncoding encoding) {
  const std::string extension = lowerExtension(path);
  if (extension != ".pcd" && extension != ".ply") throw InputError(path + ": unknown extension, must be .pcd or .ply");
  if (cloud.width == 0 || cloud.height == 0) throw InputError(path + ": not written, the cloud has no points");
  if (cloud.data.size() < std::size_t{cloud.width} * cloud.height * cloud.point_step) {
    throw InputError(path + ": not written, the cloud holds fewer points than width * height");
  }
  const pcl::PCLPointCloud2 fields = packed(cloud);
  writeAtomically(path, [&](const std::string& temporary) {
    bool written = false;
    try {
      written = extension == ".ply"
                    ? cloudFiles().writePLY(temporary, fields, sensor_origin, sensor_orientation)
                    : cloudFiles().writePCD(temporary, fields, sensor_origin, sensor_orientation, encoding);
    } catch (const InputError&) {
      throw;
    } catch (const std::exception& error) {
      failToWrite(path, error.what());
    }
    const std::size_t num_points = std::size_t{fields.width} * fields.height;
    if (!written || !isWhole(temporary, extension, encoding, num_points)) failToWrite(path, "the disk may be full");
  });
}

}  // namespace pcl_symmetry::apps
