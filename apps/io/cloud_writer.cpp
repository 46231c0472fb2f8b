#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include "io/shape_output.h"

namespace pcl_symmetry::apps {

bool writeCloudFile(const std::string& path, const std::string& extension, const pcl::PCLPointCloud2& cloud,
                    const Eigen::Vector4f& origin, const Eigen::Quaternionf& orientation, PCDEncoding encoding) {
  if (extension == ".ply") return pcl::PLYWriter().writeBinary(path, cloud, origin, orientation) == 0;
  constexpr int kDigits = 9;  // tell all floats apart
  pcl::PCDWriter writer;
  if (encoding == PCDEncoding::Ascii) return writer.writeASCII(path, cloud, origin, orientation, kDigits) == 0;
  if (encoding == PCDEncoding::Binary) return writer.writeBinary(path, cloud, origin, orientation) == 0;
  return writer.writeBinaryCompressed(path, cloud, origin, orientation) == 0;
}

}  // namespace pcl_symmetry::apps
