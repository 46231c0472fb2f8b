/// The entry of the module pcl_symmetry_cloud_files.so.
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <string>

#include "io/cloud_files.h"

namespace {

using namespace pcl_symmetry::apps;

class PCLCloudFiles : public CloudFiles {
public:
  bool readPLY(const std::string& path, pcl::PCLPointCloud2& cloud) const override { return read(path, cloud); }
  bool readPLY(const std::string& path, pcl::PolygonMesh& mesh) const override { return read(path, mesh); }

  bool writePLY(const std::string& path, const pcl::PCLPointCloud2& cloud, const Eigen::Vector4f& origin,
                const Eigen::Quaternionf& orientation) const override {
    return pcl::PLYWriter().writeBinary(path, cloud, origin, orientation) == 0;
  }

  bool writePCD(const std::string& path, const pcl::PCLPointCloud2& cloud, const Eigen::Vector4f& origin,
                const Eigen::Quaternionf& orientation, PCDEncoding encoding) const override {
    // derived: nine digits tell all floats apart.
    constexpr int kDigits = 9;
    pcl::PCDWriter writer;
    if (encoding == PCDEncoding::Ascii) return writer.writeASCII(path, cloud, origin, orientation, kDigits) == 0;
    if (encoding == PCDEncoding::Binary) return writer.writeBinary(path, cloud, origin, orientation) == 0;
    return writer.writeBinaryCompressed(path, cloud, origin, orientation) == 0;
  }

private:
  template <typename Content>
  static bool read(const std::string& path, Content& content) {
    Eigen::Vector4f origin;
    Eigen::Quaternionf orientation;
    int version = 0;
    return pcl::PLYReader().read(path, content, origin, orientation, version) >= 0;
  }
};

}  // namespace

extern "C" const void* pclSymmetryModule(const char* version) {
  static const PCLCloudFiles files;
  return std::string(version) == PCL_SYMMETRY_VERSION ? static_cast<const CloudFiles*>(&files) : nullptr;
}
