#include "io/shape_input.h"

#include <pcl/console/print.h>
#include <pcl/conversions.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem/path.hpp>
#include <cstring>
#include <new>
#include <utility>
#include <vector>

#include "io/file_text.h"
#include "io/glb_reader.h"
#include "io/pcd_reader.h"
#include "io/ply_check.h"
#include "io/cloud_files.h"
#include "io/mesh_files.h"
#include "io/off_reader.h"
#include "io/xyz_reader.h"
#include "io/standard_streams.h"

namespace pcl_symmetry::apps {

namespace {

/// PCL's readers print what their return value says already.
class SilentPCL {
public:
  SilentPCL() { pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS); }
  ~SilentPCL() { pcl::console::setVerbosityLevel(level_); }
  SilentPCL(const SilentPCL&) = delete;
  SilentPCL& operator=(const SilentPCL&) = delete;

private:
  pcl::console::VERBOSITY_LEVEL level_ = pcl::console::getVerbosityLevel();
};

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

Shape loadPCD(const std::string& path) {
  PCDCloud file = readPCD(path);
  Shape shape;
  shape.cloud = std::move(file.cloud);
  shape.sensor_origin = file.sensor_origin;
  shape.sensor_orientation = file.sensor_orientation;
  return shape;
}

Shape loadPLY(const std::string& path) {
  const PLYSummary summary = checkPLY(path);
  Shape shape;
  if (summary.has_faces) shape.mesh.emplace();
  if (!(shape.mesh ? cloudFiles().readPLY(path, *shape.mesh) : cloudFiles().readPLY(path, shape.cloud)))
    throw InputError(path + ": PCL cannot read it as PLY, its data is damaged");
  if (shape.mesh) shape.cloud = shape.mesh->cloud;
  shape.sensor_origin = summary.sensor_origin;
  shape.sensor_orientation = summary.sensor_orientation;
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

Shape fromMesh(const std::string& path, ShiftedMesh mesh) {
  Shape shape = fromMesh(path, std::move(mesh.mesh));
  shape.shift = mesh.shift;
  if (!shape.shift.isZero(0.0)) shape.cloud = toFields(*shape.points, shape.shift);
  return shape;
}

Shape fromExact(const std::string& path, ExactShape exact) {
  ShiftedMesh mesh;
  mesh.shift = shiftFor(exact.vertices);
  mesh.mesh.polygons = std::move(exact.polygons);
  pcl::toPCLPointCloud2(shifted(exact.vertices, mesh.shift), mesh.mesh.cloud);
  return fromMesh(path, std::move(mesh));
}

ExactShape exactOf(GLBShape glb) {
  ExactShape exact;
  exact.vertices = std::move(glb.vertices);
  for (const auto& triangle : glb.triangles) {
    exact.polygons.emplace_back();
    for (const std::uint32_t corner : triangle)
      exact.polygons.back().vertices.push_back(static_cast<pcl::index_t>(corner));
  }
  return exact;
}

Shape loadFile(const std::string& path) {
  checkReadableFile(path);
  const std::string extension = boost::algorithm::to_lower_copy(boost::filesystem::path(path).extension().string());
  const SilentPCL silence;
  try {
    if (extension == ".pcd") return completed(path, loadPCD(path));
    if (extension == ".ply") return completed(path, loadPLY(path));
    if (extension == ".off") return fromExact(path, readOFF(path));
    if (extension == ".xyz") return fromExact(path, readXYZ(path));
    if (extension == ".obj") return fromMesh(path, meshFiles().readOBJ(path));
    if (extension == ".stl") return fromMesh(path, meshFiles().readSTL(path));
    if (extension == ".glb") return fromExact(path, exactOf(readGLB(path)));
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw InputError(path + ": is too large for the memory of this machine");
  } catch (const std::exception& error) {
    throw InputError(path + ": cannot be read, " + error.what());
  }
  throw InputError(path + ": unknown extension '" + extension + "', must be " + kShapeFiles);
}

}  // namespace

Shape shapeFromMesh(const pcl::PolygonMesh& mesh) {
  return fromMesh("mesh", pcl::PolygonMesh(mesh));
}

Shape loadShape(const std::string& path) {
  if (!isStandardStream(path)) return loadFile(path);
  const StandardInput input;
  try {
    return loadFile(input.path());
  } catch (const InputError& error) {
    throw InputError(input.named(error.what()));
  }
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
