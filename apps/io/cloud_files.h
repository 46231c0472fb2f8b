/// PLY files read, PLY and PCD files written by PCL, in a module that is loaded when the first one is.
///
/// libpcl_io takes longer to load than a tool takes to find planes: it brings 60 libraries for cameras and VTK's
/// formats. PCD files are therefore read by files/pcd_reader.h.
#pragma once

#include <pcl/PCLPointCloud2.h>
#include <pcl/PolygonMesh.h>

#include <Eigen/Geometry>
#include <string>

namespace pcl_symmetry::apps {

enum class PCDEncoding { Ascii, Binary, BinaryCompressed };

/// Implemented by the module pcl_symmetry_cloud_files.so. Methods return false where PCL reports failure, and may throw
/// what PCL throws.
class CloudFiles {
public:
  virtual ~CloudFiles() = default;
  virtual bool readPLY(const std::string& path, pcl::PCLPointCloud2& cloud) const = 0;
  virtual bool readPLY(const std::string& path, pcl::PolygonMesh& mesh) const = 0;
  virtual bool writePLY(const std::string& path, const pcl::PCLPointCloud2& cloud, const Eigen::Vector4f& origin,
                        const Eigen::Quaternionf& orientation) const = 0;
  virtual bool writePCD(const std::string& path, const pcl::PCLPointCloud2& cloud, const Eigen::Vector4f& origin,
                        const Eigen::Quaternionf& orientation, PCDEncoding encoding) const = 0;
};

/// Loads the module at the first call.
/// \throws InputError where it is missing or that of another version.
const CloudFiles& cloudFiles();

}  // namespace pcl_symmetry::apps
