#include "io/mesh_output.h"

#include <pcl/conversions.h>
#include <pcl/point_types.h>

#include <boost/algorithm/string.hpp>
#include <ostream>

#include "command_line/tool_errors.h"
#include "io/shape_output.h"

namespace pcl_symmetry::apps {

void saveMesh(const std::string& path, const pcl::PolygonMesh& mesh, const Eigen::Isometry3d& motion,
              const std::string& property, const std::vector<float>& values) {
  pcl::PointCloud<pcl::PointXYZ> vertices;
  pcl::fromPCLPointCloud2(mesh.cloud, vertices);
  writeStream(path, [&](std::ostream& ply) {
    ply.precision(17);  // derived: as many digits as double holds
    ply << "ply\nformat ascii 1.0\nelement vertex " << vertices.size()
        << "\nproperty double x\nproperty double y\nproperty double z\nproperty float " << property << "\nelement face "
        << mesh.polygons.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Eigen::Vector3d x = motion * vertices[i].getVector3fMap().cast<double>();
      ply << x.x() << ' ' << x.y() << ' ' << x.z() << ' ' << values[i] << '\n';
    }
    for (const pcl::Vertices& polygon : mesh.polygons) {
      ply << polygon.vertices.size();
      for (const pcl::index_t corner : polygon.vertices) ply << ' ' << corner;
      ply << '\n';
    }
  });
}

void checkMeshExtension(const std::string& path) {
  if (!boost::iends_with(path, ".ply")) throw UsageError(path + ": a symmetrised mesh is written as .ply");
}

}  // namespace pcl_symmetry::apps
