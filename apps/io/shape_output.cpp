#include "io/shape_output.h"

#include <fcntl.h>
#include <pcl/common/io.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <mutex>

#include "io/file_text.h"
#include "io/input_shape.h"
#include "io/load_module.h"

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

/// A file in memory. PCL's and VTK's writers do not check whether the disk accepts what they write, and one of them
/// ends the program if it does not.
class MemoryFile {
public:
  MemoryFile() : descriptor_(::memfd_create("pcl_symmetry", MFD_CLOEXEC)) {}
  ~MemoryFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string name() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

  /// \param comment line of a header, inserted after the first line of a .pcd file, the second of a .ply file.
  /// \return whether all of it was copied.
  bool copyTo(std::ostream& out, const std::string& comment) const {
    const ::off_t size = ::lseek(descriptor_, 0, SEEK_END);
    // Space for one more byte shows that the file was not cut off by a limit.
    if (size <= 0 || ::pwrite(descriptor_, "", 1, size) != 1) return false;
    std::vector<char> piece(1 << 20);
    for (::off_t at = 0; at < size;) {
      const std::size_t wanted = std::min(piece.size(), static_cast<std::size_t>(size - at));
      const ::ssize_t got = ::pread(descriptor_, piece.data(), wanted, at);
      if (got <= 0) return false;
      const char *begin = piece.data(), *end = begin + got;
      if (at == 0 && !comment.empty()) {
        const char* line_end = std::find(begin, end, '\n');
        if (boost::starts_with(comment, "comment")) line_end = std::find(std::next(line_end), end, '\n');
        out.write(begin, std::next(line_end) - begin) << comment;
        begin = std::next(line_end);
      }
      if (!out.write(begin, end - begin)) return false;
      at += got;
    }
    return true;
  }

private:
  int descriptor_;
};

/// The file that is being written; a signal that ends the program removes it.
std::atomic<const char*> pending_file{nullptr};
std::mutex pending_file_mutex;

extern "C" void removePendingFile(int signal) {
  if (const char* const name = pending_file) ::unlink(name);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

/// A new file, one at a time, which is removed when it goes out of scope, or when SIGINT, SIGTERM or SIGHUP ends the
/// program.
class TemporaryFile {
public:
  /// \param model name with % signs, each of which is replaced by a random digit.
  explicit TemporaryFile(const fs::path& model) : lock_(pending_file_mutex), name_(fs::unique_path(model).string()) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
      struct sigaction action {};
      sigaction(signal, nullptr, &action);
      if (action.sa_handler == SIG_DFL) std::signal(signal, removePendingFile);
    }
    pending_file = name_.c_str();  // before it exists: a signal may come at once
    const int descriptor = ::open(name_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor < 0)
      pending_file = nullptr;
    else
      ::close(descriptor);
  }
  ~TemporaryFile() {
    if (pending_file.exchange(nullptr)) ::unlink(name_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  /// \return whether it could be made; otherwise errno gives the reason.
  bool exists() const { return pending_file != nullptr; }
  const std::string& name() const { return name_; }

private:
  std::lock_guard<std::mutex> lock_;
  std::string name_;
};

/// Extension of the file that a cloud is written to, in lower case; .pcd for standard output.
std::string lowerExtension(const std::string& path) {
  if (isStandardStream(path)) return ".pcd";
  return boost::algorithm::to_lower_copy(fs::path(path).extension().string());
}

}  // namespace

void checkTarget(const std::string& path) {
  if (isStandardStream(path)) return;
  if (path.empty()) throw InputError("output name is empty");
  boost::system::error_code ignored;
  if (fs::is_directory(path, ignored)) failToWrite(path, "it is a folder");
  if (isForeignShape(path)) failToWrite(path, "it is there and was not written by this tool");
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored)) failToWrite(path, "there is no directory " + folder.string());
}

bool isStandardOutputFree(const std::vector<std::optional<std::string>>& outputs) {
  const auto number = std::count(outputs.begin(), outputs.end(), std::optional<std::string>("-"));
  if (number > 1) throw UsageError("only one output can be -, standard output");
  return number == 0;
}

void writeStream(const std::string& path, const std::function<void(std::ostream&)>& writer) {
  const auto write = [&](std::ostream& stream) {
    errno = 0;
    writer(stream);
    if (!stream.flush()) failToWrite(isStandardStream(path) ? "standard output" : path, std::strerror(errno));
  };
  if (isStandardStream(path)) return write(std::cout);
  checkTarget(path);
  const fs::path target(path);
  boost::system::error_code ignored;
  const bool is_special = fs::exists(target, ignored) && !fs::is_regular_file(target, ignored);  // a pipe or a device
  const fs::path final_name = fs::is_symlink(target, ignored) ? fs::canonical(target, ignored) : target;
  std::optional<TemporaryFile> temporary;
  if (!is_special)
    temporary.emplace(final_name.parent_path() /
                      ("." + target.stem().string() + ".%%%%%%%%" + target.extension().string()));
  if (temporary && !temporary->exists()) failToWrite(path, std::strerror(errno));
  std::ofstream stream(temporary ? temporary->name() : path, std::ios::binary);
  write(stream);
  stream.close();
  if (!stream || (temporary && std::rename(temporary->name().c_str(), final_name.c_str()) != 0))
    failToWrite(path, std::strerror(errno));
}

void writeAtomically(const std::string& path, const std::function<void(const std::string&)>& writer,
                     const std::string& comment) {
  checkTarget(path);  // before the work begins
  const MemoryFile memory;
  writer(memory.name());
  writeStream(path, [&](std::ostream& stream) {
    if (!memory.copyTo(stream, comment) && stream) failToWrite(path, "there is not enough memory");
  });
}

void writeText(const std::string& path, const std::string& text) {
  writeStream(path, [&](std::ostream& stream) { stream << text; });
}

void makeFolder(const std::string& path) {
  boost::system::error_code error, ignored;  // Boost 1.74 reports an error for ".", which exists
  fs::create_directories(path, error);
  if (!fs::is_directory(path, ignored))
    throw InputError(path + ": cannot be made, " +
                     (fs::exists(path, ignored) ? "it is a file, must be a folder" : error.message()));
}

void checkCloudExtension(const std::string& path) {
  const std::string extension = lowerExtension(path);
  if (extension != ".pcd" && extension != ".ply") throw UsageError(path + ": unknown extension, must be .pcd or .ply");
}

std::string& toolName() {
  static std::string name = "pcl_symmetry";
  return name;
}

bool isForeignShape(const std::string& path) {
  boost::system::error_code ignored;
  if (isStandardStream(path) || !fs::is_regular_file(path, ignored)) return false;
  const std::string extension = lowerExtension(path);
  if (extension == ".csv" || extension == ".txt" || extension == ".vti") return false;  // tables and volumes of tools
  if (extension != ".pcd" && extension != ".ply") return hasShapeExtension(path) || isVolumePath(path);
  std::string head(256, '\0');
  std::ifstream(path, std::ios::binary).read(head.data(), static_cast<std::streamsize>(head.size()));
  return head.find(toolName()) == std::string::npos;
}

void saveCloud(const std::string& path, const pcl::PCLPointCloud2& cloud, const Eigen::Vector4f& sensor_origin,
               const Eigen::Quaternionf& sensor_orientation, PCDEncoding encoding) {
  const std::string extension = lowerExtension(path);
  if (extension != ".pcd" && extension != ".ply") throw InputError(path + ": unknown extension, must be .pcd or .ply");
  if (cloud.width == 0 || cloud.height == 0) throw InputError(path + ": not written, the cloud has no points");
  if (cloud.data.size() < std::size_t{cloud.width} * cloud.height * cloud.point_step)
    throw InputError(path + ": not written, the cloud holds fewer points than width * height");
  const pcl::PCLPointCloud2 fields = packed(cloud);
  writeAtomically(
      path,
      [&](const std::string& name) {
        try {
          auto* const write = functionOf<decltype(writeCloudFile)>("pcl_symmetry_cloud_files", "writeCloudFile");
          if (!write(name, extension, fields, sensor_origin, sensor_orientation, encoding))
            failToWrite(path, "there is not enough memory");
        } catch (const pcl::PCLException&) {
          failToWrite(path, "there is not enough memory");
        }
      },
      std::string(extension == ".ply" ? "comment " : "# ") + toolName() + "\n");
}

}  // namespace pcl_symmetry::apps
