#include "io/mesh_output.h"

#include <pcl/conversions.h>

#include <boost/algorithm/string.hpp>
#include <cmath>
#include <ostream>

#include "io/cloud_fields.h"
#include "io/exact_coordinates.h"
#include "io/shape_output.h"
#include "pictures/colors.h"

namespace pcl_symmetry::apps {

namespace {

Cloud verticesOf(const pcl::PolygonMesh& mesh) {
  Cloud vertices;
  pcl::fromPCLPointCloud2(mesh.cloud, vertices);
  return vertices;
}

/// Properties of vertices or faces in addition to their coordinates or corners: their lines in the header, and the
/// values of one vertex or face.
struct Properties {
  std::string header;
  std::function<void(std::ostream&, std::size_t)> write = [](std::ostream&, std::size_t) {};
};

/// Writes a mesh as text. PCL's own writer of PLY meshes writes no values of vertices and faces.
/// \param type type of the coordinates.
template <typename Place>
void writePLY(const std::string& path, const pcl::PolygonMesh& mesh, const std::string& type, const Place& place,
              const Properties& of_vertices, const Properties& of_faces) {
  const Cloud vertices = verticesOf(mesh);
  writeStream(path, [&](std::ostream& ply) {
    ply.precision(type == "double" ? 17 : 9);  // as many digits as the type holds
    ply << "ply\nformat ascii 1.0\ncomment " << toolName() << "\nelement vertex " << vertices.size() << "\n";
    for (const char axis : {'x', 'y', 'z'}) ply << "property " << type << ' ' << axis << "\n";
    ply << of_vertices.header << "element face " << mesh.polygons.size() << "\nproperty list uchar int vertex_indices\n"
        << of_faces.header << "end_header\n";
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Eigen::Vector3d x = place(vertices[i].getVector3fMap().cast<double>().eval());
      ply << x.x() << ' ' << x.y() << ' ' << x.z();
      of_vertices.write(ply, i);
      ply << '\n';
    }
    for (std::size_t f = 0; f < mesh.polygons.size(); ++f) {
      ply << mesh.polygons[f].vertices.size();
      for (const pcl::index_t corner : mesh.polygons[f].vertices) ply << ' ' << corner;
      of_faces.write(ply, f);
      ply << '\n';
    }
  });
}

pcl::PCLPointCloud2 facesAsPoints(const Shape& shape) {
  const Cloud vertices = verticesOf(*shape.mesh);
  Cloud middles;
  for (const pcl::Vertices& polygon : shape.mesh->polygons) {
    Eigen::Vector3f middle = Eigen::Vector3f::Zero();
    for (const pcl::index_t corner : polygon.vertices) middle += vertices[corner].getVector3fMap();
    middle /= static_cast<float>(polygon.vertices.size());
    middles.emplace_back(middle.x(), middle.y(), middle.z());
  }
  return toFields(middles, shape.shift);
}

}  // namespace

void saveLabeled(const std::string& path, const Shape& shape, const std::vector<int>& labels) {
  if (boost::algorithm::iends_with(path, ".seg")) {
    std::string text;
    for (const int label : labels) text += std::to_string(label) + "\n";
    writeText(path, text);
  } else if (shape.mesh && boost::algorithm::iends_with(path, ".ply")) {
    writePLY(path, *shape.mesh, shape.shift.isZero(0.0) ? "float" : "double",
             [&](const Eigen::Vector3d& x) { return shiftedBack(x, shape.shift); }, {},
             {"property uchar red\nproperty uchar green\nproperty uchar blue\nproperty int label\n",
              [&](std::ostream& ply, std::size_t f) {
                const Eigen::Vector3d color = 255.0 * segmentColor(labels[f]);
                for (int k = 0; k < 3; ++k) ply << ' ' << std::lround(color[k]);
                ply << ' ' << labels[f];
              }});
  } else {
    saveCloud(path, withLabels(shape.mesh ? facesAsPoints(shape) : shape.cloud, labels), shape.sensor_origin,
              shape.sensor_orientation);
  }
}

void saveMesh(const std::string& path, const pcl::PolygonMesh& mesh, const Eigen::Isometry3d& motion,
              const std::string& property, const std::vector<float>& values) {
  writePLY(path, mesh, "double", [&](const Eigen::Vector3d& x) -> Eigen::Vector3d { return motion * x; },
           {"property float " + property + "\n", [&](std::ostream& ply, std::size_t i) { ply << ' ' << values[i]; }},
           {});
}

}  // namespace pcl_symmetry::apps
