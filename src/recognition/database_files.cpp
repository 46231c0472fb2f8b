#include "recognition/database_files.h"

#include <pcl/exceptions.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace pcl_symmetry::detail {

namespace fs = std::filesystem;

namespace {

// Values per view. derived: a pose is the upper 3 x 4 block of a transform; signature, radius and pose follow each
// other.
constexpr Eigen::Index kPoseSize = 12;
constexpr Eigen::Index kViewSize = kViewSignatureSize + 1 + kPoseSize;  // derived: see above

/// pcl::IOException puts " : " before its text.
class PlainIOException : public pcl::IOException {
public:
  explicit PlainIOException(const std::string& message) : pcl::IOException(message), message_(message) {}
  const char* what() const noexcept override { return message_.c_str(); }

private:
  std::string message_;
};

}  // namespace

void failIO(const std::string& file, const std::string& reason) {
  throw PlainIOException(file + ": " + reason);
}

void writeFloats(const std::string& path, const std::vector<float>& values) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(float)));
  file.close();
  if (!file) failIO(path, "cannot be written");
}

std::vector<float> readFloats(const std::string& path) {
  std::error_code error;
  const auto size = fs::file_size(path, error);
  if (error) failIO(path, error.message());
  std::vector<float> values(static_cast<std::size_t>(size / sizeof(float)));
  std::ifstream file(path, std::ios::binary);
  if (!file.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(float))))
    failIO(path, "cannot be read");
  return values;
}

// pcl::PCDWriter is not used: the library pcl_io depends on VTK and on camera drivers.
void writeCloud(const std::string& path, const PositionCloud& cloud) {
  std::ofstream file(path, std::ios::binary);
  file << "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " << cloud.size()
       << "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " << cloud.size() << "\nDATA binary\n";
  for (const pcl::PointXYZ& point : cloud) file.write(reinterpret_cast<const char*>(point.data), 3 * sizeof(float));
  file.close();
  if (!file) failIO(path, "cannot be written");
}

PositionCloud readCloud(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::size_t size = 0;
  std::string line;
  while (std::getline(file, line) && line != "DATA binary")
    if (line.rfind("POINTS ", 0) == 0) size = std::strtoull(line.c_str() + 7, nullptr, 10);
  if (!file || size == 0) failIO(path, "cannot be read, must be a PCD file that this database wrote");
  PositionCloud cloud(static_cast<std::uint32_t>(size), 1);
  for (pcl::PointXYZ& point : cloud) file.read(reinterpret_cast<char*>(point.data), 3 * sizeof(float));
  if (!file) failIO(path, "is incomplete");
  return cloud;
}

void writeViews(const std::string& path, const std::vector<View>& views) {
  std::vector<float> values;
  for (const View& view : views) {
    const Eigen::Matrix<float, 3, 4> pose = view.T_view_input.matrix().topRows<3>().cast<float>();
    values.insert(values.end(), view.values.data(), view.values.data() + view.values.size());
    values.push_back(static_cast<float>(view.radius));
    values.insert(values.end(), pose.data(), pose.data() + pose.size());
  }
  writeFloats(path, values);
}

std::vector<View> readViews(const std::string& path) {
  const std::vector<float> values = readFloats(path);
  if (values.empty() || values.size() % kViewSize != 0) failIO(path, "is incomplete");
  std::vector<View> views(values.size() / kViewSize);
  const float* next = values.data();
  for (View& view : views) {
    view.values = Eigen::Map<const Eigen::VectorXf>(next, kViewSignatureSize);
    view.radius = next[kViewSignatureSize];
    const Eigen::Map<const Eigen::Matrix<float, 3, 4>> pose(next + kViewSignatureSize + 1);
    view.T_view_input.matrix().topRows<3>() = pose.cast<double>();
    next += kViewSize;
  }
  return views;
}

}  // namespace pcl_symmetry::detail
