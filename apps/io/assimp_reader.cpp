#include "io/assimp_reader.h"

#include <assimp/config.h>
#include <assimp/scene.h>
#include <pcl/conversions.h>

#include <assimp/Importer.hpp>
#include <boost/algorithm/string.hpp>
#include <cstring>
#include <string_view>
#include <unordered_map>

#include "command_line/tool_errors.h"
#include "io/file_text.h"
#include "io/exact_coordinates.h"

namespace pcl_symmetry::apps {

namespace {

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

pcl::PolygonMesh meshOf(Assimp::Importer& importer, const aiScene* scene, const std::string& path) {
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

/// The lines of a .obj file, each with its first word.
template <typename Function>
void forEachLine(std::string_view text, const Function& function) {
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    const std::size_t word = std::min(line.find_first_not_of(" \t"), line.size());
    function(line, line.substr(word, line.find_first_of(" \t\r", word) - word));
    begin = end + 1;
  }
}

/// \throws InputError where a vertex does not begin with three numbers
std::vector<Eigen::Vector3d> verticesOf(std::string_view text, const std::string& path) {
  std::vector<Eigen::Vector3d> vertices;
  forEachLine(text, [&](std::string_view line, std::string_view word) {
    if (word != "v") return;
    TokenReader reader(line.substr(static_cast<std::size_t>(word.data() - line.data()) + 1), path);
    const auto i = static_cast<std::uint64_t>(vertices.size());
    const double x = reader.number("x of vertex", i), y = reader.number("y of vertex", i),
                 z = reader.number("z of vertex", i);
    vertices.emplace_back(x, y, z);
  });
  return vertices;
}

/// The text with other vertices, which Assimp reads as float.
std::string withVertices(std::string_view text, const pcl::PointCloud<pcl::PointXYZ>& vertices) {
  std::string result;
  std::size_t i = 0;
  forEachLine(text, [&](std::string_view line, std::string_view word) {
    if (word == "v") {
      char vertex[96];
      const pcl::PointXYZ& p = vertices[i++];
      std::snprintf(vertex, sizeof(vertex), "v %.9g %.9g %.9g", p.x, p.y, p.z);
      result += vertex;
    } else {
      result += line;
    }
    result += '\n';
  });
  return result;
}

}  // namespace

pcl::PolygonMesh AssimpMeshFiles::readSTL(const std::string& path) const {
  Assimp::Importer importer;
  return meshOf(importer, importer.ReadFile(path, 0), path);
}

ShiftedMesh AssimpMeshFiles::readOBJ(const std::string& path) const {
  const std::string text = readWholeFile(path);
  bool has_vertices = false, has_faces = false;
  forEachLine(text, [&](std::string_view, std::string_view word) {
    has_vertices |= word == "v";
    has_faces |= word == "f";
  });
  Assimp::Importer importer;
  ShiftedMesh result;
  if (!has_vertices) {
    result.mesh = meshOf(importer, importer.ReadFile(path, 0), path);
    return result;
  }
  const std::vector<Eigen::Vector3d> vertices = verticesOf(text, path);
  result.shift = shiftFor(vertices);
  if (!has_faces) {
    pcl::toPCLPointCloud2(shifted(vertices, result.shift), result.mesh.cloud);
  } else if (result.shift.isZero(0.0)) {
    result.mesh = meshOf(importer, importer.ReadFile(path, 0), path);
  } else {
    const std::string near = withVertices(text, shifted(vertices, result.shift));
    result.mesh = meshOf(importer, importer.ReadFileFromMemory(near.data(), near.size(), 0, "obj"), path);
  }
  return result;
}

}  // namespace pcl_symmetry::apps
