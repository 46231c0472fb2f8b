#include "io/labelled_shape.h"

#include <pcl/common/io.h>
#include <pcl/conversions.h>

#include <boost/algorithm/string.hpp>
#include <cmath>
#include <cstring>
#include <sstream>

#include "pictures/colors.h"
#include "io/exact_coordinates.h"
#include "io/face_labels.h"
#include "io/shape_output.h"

namespace pcl_symmetry::apps {

namespace {

pcl::PCLPointCloud2 withLabels(const pcl::PCLPointCloud2& cloud, const std::vector<int>& labels) {
  pcl::PCLPointCloud2 extra;
  extra.width = cloud.width;
  extra.height = cloud.height;
  extra.is_dense = cloud.is_dense;
  extra.is_bigendian = cloud.is_bigendian;
  pcl::PCLPointField field;
  field.name = "label";
  field.offset = 0;
  field.datatype = pcl::PCLPointField::UINT32;
  field.count = 1;
  extra.fields = {field};
  extra.point_step = sizeof(std::uint32_t);
  extra.row_step = extra.point_step * extra.width;
  extra.data.resize(labels.size() * sizeof(std::uint32_t));
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const auto label = static_cast<std::uint32_t>(labels[i]);
    std::memcpy(&extra.data[i * sizeof(label)], &label, sizeof(label));
  }
  pcl::PCLPointCloud2 output;
  if (!pcl::concatenateFields(cloud, extra, output)) throw InputError("label: fields could not be joined");
  return output;
}

pcl::PCLPointCloud2 facesAsPoints(const Shape& shape) {
  const pcl::PolygonMesh& mesh = *shape.mesh;
  pcl::PointCloud<pcl::PointXYZ> vertices, middles;
  pcl::fromPCLPointCloud2(mesh.cloud, vertices);
  for (const pcl::Vertices& polygon : mesh.polygons) {
    Eigen::Vector3f middle = Eigen::Vector3f::Zero();
    for (const pcl::index_t corner : polygon.vertices) middle += vertices[corner].getVector3fMap();
    middle /= static_cast<float>(polygon.vertices.size());
    middles.emplace_back(middle.x(), middle.y(), middle.z());
  }
  return toFields(middles, shape.shift);
}

/// PCL's own writer of PLY meshes has no values of faces.
std::string labelledPLY(const Shape& shape, const std::vector<int>& labels) {
  const pcl::PolygonMesh& mesh = *shape.mesh;
  const bool is_shifted = !shape.shift.isZero(0.0);
  const std::string type = is_shifted ? "double" : "float";
  pcl::PointCloud<pcl::PointXYZ> vertices;
  pcl::fromPCLPointCloud2(mesh.cloud, vertices);
  std::ostringstream ply;
  ply.precision(is_shifted ? 17 : 9);  // derived: as many digits as the type holds
  ply << "ply\nformat ascii 1.0\nelement vertex " << vertices.size() << "\nproperty " << type << " x\nproperty " << type
      << " y\nproperty " << type << " z\nelement face " << mesh.polygons.size()
      << "\nproperty list uchar int vertex_indices\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
         "property int label\nend_header\n";
  for (const pcl::PointXYZ& vertex : vertices) {
    const Eigen::Vector3d x = shiftedBack(vertex.getVector3fMap().cast<double>().eval(), shape.shift);
    ply << x.x() << ' ' << x.y() << ' ' << x.z() << '\n';
  }
  for (std::size_t f = 0; f < mesh.polygons.size(); ++f) {
    ply << mesh.polygons[f].vertices.size();
    for (const pcl::index_t corner : mesh.polygons[f].vertices) ply << ' ' << corner;
    const Eigen::Vector3d color = 255.0 * segmentColor(labels[f]);
    for (int k = 0; k < 3; ++k) ply << ' ' << std::lround(color[k]);
    ply << ' ' << labels[f] << '\n';
  }
  return ply.str();
}

}  // namespace

void saveLabelled(const std::string& path, const Shape& shape, const std::vector<int>& labels) {
  if (boost::algorithm::iends_with(path, ".seg")) {
    writeFaceLabels(path, labels);
  } else if (shape.mesh && boost::algorithm::iends_with(path, ".ply")) {
    writeText(path, labelledPLY(shape, labels));
  } else {
    saveCloud(path, withLabels(shape.mesh ? facesAsPoints(shape) : shape.cloud, labels), shape.sensor_origin,
              shape.sensor_orientation);
  }
}

}  // namespace pcl_symmetry::apps
