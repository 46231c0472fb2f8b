#include "shape_input.h"

#include <pcl/console/print.h>
#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <assimp/config.h>
#include <assimp/scene.h>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem/path.hpp>
#include <cmath>
#include <cstring>
#include <new>
#include <unordered_map>

#include "cloud_file_checks.h"
#include "file_text.h"
#include "off_reader.h"

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

/// \return the coordinates of all points, whether stored as float or as double.
pcl::PointCloud<pcl::PointXYZ>::Ptr coordinates(const std::string& path, const pcl::PCLPointCloud2& cloud) {
  const pcl::PCLPointField* axes[3] = {};
  for (const pcl::PCLPointField& field : cloud.fields) {
    if (field.name.size() == 1 && field.name[0] >= 'x' && field.name[0] <= 'z') axes[field.name[0] - 'x'] = &field;
  }
  const std::uint64_t num_points = std::uint64_t{cloud.width} * cloud.height;
  if (cloud.data.size() < num_points * cloud.point_step) throw InputError(path + ": points are incomplete");
  for (const pcl::PCLPointField* axis : axes) {
    if (!axis) throw InputError(path + ": has no coordinates, must have fields x, y and z");
    if (axis->datatype != pcl::PCLPointField::FLOAT32 && axis->datatype != pcl::PCLPointField::FLOAT64) {
      throw InputError(path + ": field " + axis->name + " must be float or double");
    }
  }
  pcl::PointCloud<pcl::PointXYZ>::Ptr points(new pcl::PointCloud<pcl::PointXYZ>(cloud.width, cloud.height));
  points->header = cloud.header;
  for (std::uint64_t i = 0; i < num_points; ++i) {
    for (int k = 0; k < 3; ++k) {
      const std::size_t offset = i * cloud.point_step + axes[k]->offset;
      (*points)[i].data[k] = axes[k]->datatype == pcl::PCLPointField::FLOAT32
                                 ? valueAt<float>(cloud, offset)
                                 : static_cast<float>(valueAt<double>(cloud, offset));
    }
  }
  points->is_dense = std::all_of(points->begin(), points->end(),
                                 [](const pcl::PointXYZ& point) { return point.getVector3fMap().allFinite(); });
  return points;
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
  checkPCD(path);
  Shape shape;
  int version = 0;
  if (pcl::PCDReader().read(path, shape.cloud, shape.sensor_origin, shape.sensor_orientation, version) < 0) {
    throw InputError(path + ": PCL cannot read it as PCD, its data is damaged");
  }
  return shape;
}

Shape loadPLY(const std::string& path) {
  const PLYSummary summary = checkPLY(path);
  Shape shape;
  int version = 0;
  if (summary.has_faces) {
    shape.mesh.emplace();
    if (pcl::PLYReader().read(path, *shape.mesh, shape.sensor_origin, shape.sensor_orientation, version) < 0) {
      throw InputError(path + ": PCL cannot read it as PLY, its data is damaged");
    }
    shape.cloud = shape.mesh->cloud;
  } else if (pcl::PLYReader().read(path, shape.cloud, shape.sensor_origin, shape.sensor_orientation, version) < 0) {
    throw InputError(path + ": PCL cannot read it as PLY, its data is damaged");
  }
  shape.sensor_origin = summary.sensor_origin;
  shape.sensor_orientation = summary.sensor_orientation;
  return shape;
}

/// Joins vertices of exactly equal coordinates: STL repeats them for each face, OBJ for each group.
class VertexWelder {
public:
  pcl::index_t add(const aiVector3D& position) {
    const Key key{{position.x + 0.0f, position.y + 0.0f, position.z + 0.0f}};
    const auto [entry, is_new] = index_of_.emplace(key, static_cast<pcl::index_t>(vertices_.size()));
    if (is_new) vertices_.emplace_back(position.x, position.y, position.z);
    return entry->second;
  }
  const pcl::PointCloud<pcl::PointXYZ>& vertices() const { return vertices_; }

private:
  struct Key {
    float xyz[3];
    bool operator==(const Key& other) const { return std::memcmp(xyz, other.xyz, sizeof(xyz)) == 0; }
  };
  struct Hash {
    std::size_t operator()(const Key& key) const {
      return std::hash<std::string_view>()({reinterpret_cast<const char*>(key.xyz), sizeof(key.xyz)});
    }
  };
  std::unordered_map<Key, pcl::index_t, Hash> index_of_;
  pcl::PointCloud<pcl::PointXYZ> vertices_;
};

void collectMeshes(const aiScene& scene, const aiNode& node, const aiMatrix4x4& T_scene_parent, VertexWelder& welder,
                   pcl::PolygonMesh& mesh) {
  const aiMatrix4x4 T_scene_node = T_scene_parent * node.mTransformation;
  for (unsigned m = 0; m < node.mNumMeshes; ++m) {
    const aiMesh& part = *scene.mMeshes[node.mMeshes[m]];
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices < 3) continue;
      pcl::Vertices polygon;
      for (unsigned k = 0; k < face.mNumIndices; ++k) {
        polygon.vertices.push_back(welder.add(T_scene_node * part.mVertices[face.mIndices[k]]));
      }
      mesh.polygons.push_back(std::move(polygon));
    }
  }
  for (unsigned c = 0; c < node.mNumChildren; ++c) {
    collectMeshes(scene, *node.mChildren[c], T_scene_node, welder, mesh);
  }
}

pcl::PolygonMesh readWithAssimp(const std::string& path) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, 0);
  if (!scene || !scene->mRootNode) {
    std::string reason = importer.GetErrorString();
    boost::algorithm::trim(reason);
    throw InputError(path + ": cannot be read as a mesh" + (reason.empty() ? "" : ", " + reason));
  }
  pcl::PolygonMesh mesh;
  VertexWelder welder;
  collectMeshes(*scene, *scene->mRootNode, aiMatrix4x4(), welder, mesh);
  pcl::toPCLPointCloud2(welder.vertices(), mesh.cloud);
  if (mesh.polygons.empty()) throw InputError(path + ": has no faces of three or more corners");
  return mesh;
}

Shape completed(const std::string& path, Shape shape) {
  if (shape.mesh) {
    checkPolygons(path, *shape.mesh);
    shape.cloud = shape.mesh->cloud;
    if (shape.mesh->polygons.empty()) shape.mesh.reset();
  }
  shape.points = coordinates(path, shape.cloud);
  if (shape.points->empty()) throw InputError(path + ": has no points");
  shape.points->sensor_origin_ = shape.sensor_origin;
  shape.points->sensor_orientation_ = shape.sensor_orientation;
  return shape;
}

Shape fromMesh(const std::string& path, pcl::PolygonMesh mesh) {
  Shape shape;
  shape.mesh = std::move(mesh);
  return completed(path, std::move(shape));
}

}  // namespace

Shape shapeFromMesh(const pcl::PolygonMesh& mesh) {
  return fromMesh("mesh", mesh);
}

Shape loadShape(const std::string& path) {
  checkReadableFile(path);
  const std::string extension = boost::algorithm::to_lower_copy(boost::filesystem::path(path).extension().string());
  const SilentPCL silence;
  try {
    if (extension == ".pcd") return completed(path, loadPCD(path));
    if (extension == ".ply") return completed(path, loadPLY(path));
    if (extension == ".off") return fromMesh(path, readOFF(path));
    if (extension == ".obj" || extension == ".stl") return fromMesh(path, readWithAssimp(path));
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw InputError(path + ": is too large for the memory of this machine");
  } catch (const std::exception& error) {
    throw InputError(path + ": cannot be read, " + error.what());
  }
  throw InputError(path + ": unknown extension '" + extension + "', must be .pcd, .ply, .obj, .stl or .off");
}

}  // namespace pcl_symmetry::apps
