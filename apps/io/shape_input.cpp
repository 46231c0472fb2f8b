#include "io/shape_input.h"

#include <pcl/conversions.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem.hpp>
#include <cstring>
#include <new>
#include <utility>
#include <vector>

#include "command_line/flag_values.h"
#include "io/assimp_reader.h"
#include "io/column_reader.h"
#include "io/file_text.h"
#include "io/load_module.h"
#include "io/obj_reader.h"
#include "io/off_reader.h"
#include "io/pcd_reader.h"
#include "io/ply_reader.h"
#include "io/standard_streams.h"
#include "io/volume_input.h"
#include "pictures/drawing.h"

namespace pcl_symmetry::apps {

namespace {

template <typename Value>
Value valueAt(const pcl::PCLPointCloud2& cloud, std::size_t offset) {
  Value value;
  std::memcpy(&value, cloud.data.data() + offset, sizeof(Value));
  return value;
}

/// The fields x, y and z of a cloud, of type float or double.
class CoordinateFields {
public:
  CoordinateFields(const std::string& path, const pcl::PCLPointCloud2& cloud) : cloud_(cloud) {
    for (const pcl::PCLPointField& field : cloud.fields) {
      if (field.name.size() == 1 && field.name[0] >= 'x' && field.name[0] <= 'z') axes_[field.name[0] - 'x'] = &field;
    }
    for (const pcl::PCLPointField* axis : axes_) {
      if (!axis) throw InputError(path + ": has no coordinates, must have fields x, y and z");
      if (axis->datatype != pcl::PCLPointField::FLOAT32 && axis->datatype != pcl::PCLPointField::FLOAT64) {
        throw InputError(path + ": field " + axis->name + " must be float or double");
      }
      is_double_ |= axis->datatype == pcl::PCLPointField::FLOAT64;
    }
  }

  bool isDouble() const { return is_double_; }

  Eigen::Vector3d operator[](std::size_t i) const {
    Eigen::Vector3d point;
    for (int k = 0; k < 3; ++k) {
      const std::size_t offset = i * cloud_.point_step + axes_[k]->offset;
      point[k] = axes_[k]->datatype == pcl::PCLPointField::FLOAT32 ? valueAt<float>(cloud_, offset)
                                                                   : valueAt<double>(cloud_, offset);
    }
    return point;
  }

private:
  const pcl::PCLPointCloud2& cloud_;
  const pcl::PCLPointField* axes_[3] = {};
  bool is_double_ = false;
};

/// Sets points, and shift where the fields are double and float would lose digits.
void setPoints(const std::string& path, Shape& shape) {
  const pcl::PCLPointCloud2& cloud = shape.cloud;
  const std::uint64_t num_points = std::uint64_t{cloud.width} * cloud.height;
  if (cloud.data.size() < num_points * cloud.point_step) throw InputError(path + ": points are incomplete");
  const CoordinateFields fields(path, cloud);
  if (fields.isDouble()) {
    std::vector<Eigen::Vector3d> exact(num_points);
    for (std::uint64_t i = 0; i < num_points; ++i) exact[i] = fields[i];
    shape.shift = shiftFor(exact);
  }
  shape.points.reset(new pcl::PointCloud<pcl::PointXYZ>(cloud.width, cloud.height));
  shape.points->header = cloud.header;
  for (std::uint64_t i = 0; i < num_points; ++i)
    (*shape.points)[i].getVector3fMap() = (fields[i] - shape.shift).cast<float>();
  // Meshes are read as PointXYZ everywhere.
  if (shape.mesh && fields.isDouble()) pcl::toPCLPointCloud2(*shape.points, shape.mesh->cloud);
}

void checkPolygons(const std::string& path, pcl::PolygonMesh& mesh) {
  const std::uint64_t num_vertices = std::uint64_t{mesh.cloud.width} * mesh.cloud.height;
  for (std::size_t i = 0; i < mesh.polygons.size(); ++i) {
    for (const pcl::index_t corner : mesh.polygons[i].vertices) {
      if (corner < 0 || static_cast<std::uint64_t>(corner) >= num_vertices) {
        throw InputError(path + ": a corner of face " + std::to_string(i) + " = " + std::to_string(corner) +
                         ", must be >= 0 and < " + std::to_string(num_vertices) + ", the number of vertices");
      }
    }
  }
  mesh.polygons.erase(std::remove_if(mesh.polygons.begin(), mesh.polygons.end(),
                                     [](const pcl::Vertices& polygon) { return polygon.vertices.size() < 3; }),
                      mesh.polygons.end());
}

Shape fromCloudFile(CloudFile file) {
  Shape shape;
  shape.cloud = std::move(file.cloud);
  if (!file.polygons.empty()) {
    shape.mesh.emplace();
    shape.mesh->cloud = std::move(shape.cloud);
    shape.mesh->polygons = std::move(file.polygons);
  }
  shape.sensor_origin = file.sensor_origin;
  shape.sensor_orientation = file.sensor_orientation;
  shape.left_out = std::move(file.left_out);
  return shape;
}

void finish(const std::string& path, Shape& shape) {
  if (shape.points->empty()) throw InputError(path + ": has no points");
  shape.points->is_dense = std::all_of(shape.points->begin(), shape.points->end(),
                                       [](const pcl::PointXYZ& point) { return point.getVector3fMap().allFinite(); });
  shape.points->sensor_origin_ = shape.sensor_origin;
  // An origin of zero is a default at coordinates so large, and has to stay one.
  if (!shape.sensor_origin.head<3>().isZero(0.0f))
    shape.points->sensor_origin_.head<3>() = (shape.sensor_origin.head<3>().cast<double>() - shape.shift).cast<float>();
  shape.points->sensor_orientation_ = shape.sensor_orientation;
}

Shape completed(const std::string& path, Shape shape) {
  if (shape.mesh) {
    checkPolygons(path, *shape.mesh);
    shape.cloud = shape.mesh->cloud;
    if (shape.mesh->polygons.empty()) shape.mesh.reset();
  }
  setPoints(path, shape);
  finish(path, shape);
  return shape;
}

Shape fromMesh(const std::string& path, pcl::PolygonMesh mesh) {
  Shape shape;
  shape.mesh = std::move(mesh);
  return completed(path, std::move(shape));
}

Shape fromExact(const std::string& path, ExactShape exact) {
  pcl::PolygonMesh mesh;
  const Eigen::Vector3d shift = shiftFor(exact.vertices);
  mesh.polygons = std::move(exact.polygons);
  pcl::toPCLPointCloud2(shifted(exact.vertices, shift), mesh.cloud);
  Shape shape = fromMesh(path, std::move(mesh));
  shape.shift = shift;
  if (!shift.isZero(0.0)) shape.cloud = toFields(*shape.points, shift);
  shape.left_out = std::move(exact.left_out);
  return shape;
}

/// \param name of the file in errors.
Shape shapeOf(const std::string& name, std::string text, const std::string& extension) {
  try {
    if (extension == ".pcd") return completed(name, fromCloudFile(readPCD(name, text)));
    if (extension == ".ply") return completed(name, fromCloudFile(readPLY(name, text)));
    if (extension == ".off") return fromExact(name, readOFF(name, text));
    if (extension == ".obj") return fromExact(name, readOBJ(name, text));
    if (isColumnFile(extension)) return fromExact(name, readColumns(name, text));
    if (extension == ".stl" || extension == ".glb") {
      ExactShape shape;
      functionOf<decltype(readMesh)>("pcl_symmetry_mesh_files", "readMesh")(name, text, extension.substr(1), shape);
      return fromExact(name, std::move(shape));
    }
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw InputError(name + ": is too large for the memory of this machine");
  } catch (const std::exception& error) {
    throw InputError(name + ": cannot be read, " + error.what());
  }
  throw InputError(name + ": unknown extension '" + extension + "', must be " + kShapeFiles);
}

}  // namespace

Shape loadShape(const std::string& path) {
  const bool is_stdin = isStandardStream(path);
  const std::string name = is_stdin ? "standard input" : path;
  std::string text = is_stdin ? readStandardInput() : readWholeFile(path);
  std::string extension = boost::algorithm::to_lower_copy(boost::filesystem::path(path).extension().string());
  if (is_stdin || (extension.empty() && !boost::filesystem::is_regular_file(path))) {  // such as <(...) of a shell
    extension = extensionOfContent(text);
    if (extension.empty()) throw InputError(name + ": is of no known kind, must be " + kShapeFiles);
  }
  return shapeOf(name, std::move(text), extension);
}

Shape surfaceOf(const std::string& path, const ScalarGrid& volume, double value) {
  ExactShape surface;
  functionOf<decltype(contourVolume)>(kDrawingModule, "contourVolume")(volume, value, surface);
  if (surface.polygons.empty()) throw InputError(path + ": no surface of value " + shortest(value));
  return fromExact(path, std::move(surface));
}

Points finitePoints(const pcl::PointCloud<pcl::PointXYZ>& cloud) {
  Points points(3, static_cast<Eigen::Index>(cloud.size()));
  Eigen::Index size = 0;
  for (const pcl::PointXYZ& point : cloud)
    if (point.getVector3fMap().allFinite()) points.col(size++) = point.getVector3fMap();
  points.conservativeResize(3, size);
  return points;
}

}  // namespace pcl_symmetry::apps
