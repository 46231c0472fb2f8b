#include "io/shape_readers.h"

#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <boost/algorithm/string.hpp>
#include <nlohmann/json.hpp>

#include "command_line/tool_errors.h"

namespace pcl_symmetry::apps {

namespace {

/// Assimp's numbers are float; products of poses are taken in double, so that a large translation keeps the shape.
Eigen::Affine3d poseOf(const aiMatrix4x4& matrix) {
  Eigen::Affine3d pose;
  for (unsigned row = 0; row < 4; ++row)
    for (unsigned column = 0; column < 4; ++column) pose(row, column) = matrix[row][column];
  return pose;
}

class SceneReader {
public:
  explicit SceneReader(const aiScene& scene) : scene_(scene) { read(*scene.mRootNode, Eigen::Affine3d::Identity()); }

  ExactShape shape() {
    if (shape_.polygons.empty())
      for (const Eigen::Vector3d& point : points_) welder_.add(point);
    return std::move(shape_);
  }

private:
  static constexpr std::size_t kMostFaces = 50'000'000;  // small files can ask for any number

  void read(const aiNode& node, const Eigen::Affine3d& T_scene_parent) {
    const Eigen::Affine3d T_scene_node = T_scene_parent * poseOf(node.mTransformation);
    for (unsigned m = 0; m < node.mNumMeshes; ++m) {
      const aiMesh& mesh = *scene_.mMeshes[node.mMeshes[m]];
      if (shape_.polygons.size() + mesh.mNumFaces > kMostFaces)
        throw std::length_error("it has more than 50 million faces, those of a mesh that nodes share counted for each");
      const auto corner = [&](unsigned i) {
        const aiVector3D& v = mesh.mVertices[i];
        return Eigen::Vector3d(T_scene_node * Eigen::Vector3d(v.x, v.y, v.z));
      };
      for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        const aiFace& face = mesh.mFaces[f];
        if (face.mNumIndices >= 3) shape_.polygons.emplace_back();
        for (unsigned k = 0; k < face.mNumIndices; ++k)
          if (face.mNumIndices >= 3)
            shape_.polygons.back().vertices.push_back(welder_.add(corner(face.mIndices[k])));
          else
            points_.push_back(corner(face.mIndices[k]));
      }
    }
    for (unsigned c = 0; c < node.mNumChildren; ++c) read(*node.mChildren[c], T_scene_node);
  }

  const aiScene& scene_;
  ExactShape shape_;
  VertexWelder welder_{shape_};
  std::vector<Eigen::Vector3d> points_;  // vertices of points and lines
};

/// Assimp subtracts one or two from the number of vertices of a line, a strip or a fan.
void checkPrimitives(const std::string& path, const nlohmann::json& scene) {
  const nlohmann::json none = nlohmann::json::array(), accessors = scene.value("accessors", none);
  for (const nlohmann::json& mesh : scene.value("meshes", none))
    for (const nlohmann::json& primitive : mesh.value("primitives", none)) {
      const nlohmann::json attributes = primitive.value("attributes", nlohmann::json::object());
      const std::size_t list = primitive.value("indices", attributes.value("POSITION", accessors.size()));
      const std::size_t num_vertices = list < accessors.size() ? accessors[list].value("count", std::size_t{0}) : 0;
      const int mode = primitive.value("mode", 4);
      if (num_vertices < (mode == 0 || mode == 1 || mode == 4 ? 0 : mode < 4 ? 2 : 3))
        throw InputError(path + ": a line, strip or fan of a mesh has " + std::to_string(num_vertices) + " vertices");
    }
}

/// Assimp trusts the sizes of chunks, follows values and nodes by recursion, and reads a node again for each of its
/// parents: this check protects it.
void checkGLB(const std::string& path, const std::string& text) {
  constexpr int kMostNested = 64, kMostLevels = 1000;
  const auto chunkAt = [&](std::size_t begin) {
    std::uint32_t size = 0;
    if (text.size() >= begin + 8) std::memcpy(&size, &text[begin], sizeof(size));
    if (text.size() < begin + 8 || size > text.size() - begin - 8)
      throw InputError(path + ": cannot be read as glb, it is cut off");
    return std::string_view(text).substr(begin + 8, size);
  };
  if (text.compare(0, 4, "glTF") != 0) throw InputError(path + ": cannot be read as glb, does not begin with glTF");
  const std::string_view chunk = chunkAt(12);
  const std::size_t next = (20 + chunk.size() + 3) / 4 * 4;
  if (next < text.size()) chunkAt(next);
  const auto keep = [&](int depth, nlohmann::json::parse_event_t, const nlohmann::json&) {
    if (depth > kMostNested) throw InputError(path + ": its values are nested too deeply");
    return true;
  };
  const nlohmann::json scene = nlohmann::json::parse(chunk.substr(0, chunk.find('\0')), keep, false);
  if (!scene.is_object()) throw InputError(path + ": cannot be read as glb, its JSON is damaged");
  const nlohmann::json nodes = scene.value("nodes", nlohmann::json::array());
  std::vector<int> parents(nodes.size(), -1);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (const nlohmann::json& child : nodes[i].value("children", nlohmann::json::array())) {
      if (!child.is_number_unsigned() || child >= nodes.size()) continue;
      int& parent = parents[child.get<std::size_t>()];
      if (parent >= 0) throw InputError(path + ": node " + child.dump() + " has two parents, must have one");
      parent = static_cast<int>(i);
    }
  for (const int first : parents) {
    int levels = 0;
    for (int i = first; i >= 0; i = parents[i])
      if (++levels > kMostLevels) throw InputError(path + ": its nodes are nested too deeply, or in a circle");
  }
  checkPrimitives(path, scene);
}

}  // namespace

void readGLB(const std::string& path, const std::string& content, ExactShape& shape) {
  // Assimp 5.2 would read the bytes of these extensions as if they were plain numbers.
  for (const char* extension : {"KHR_mesh_quantization", "EXT_meshopt_compression"})
    if (content.find(extension) != std::string::npos)
      throw InputError(path + ": is compressed by " + extension + ", which is not supported");
  try {
    checkGLB(path, content);
  } catch (const nlohmann::json::exception&) {  // a value has the wrong type
    throw InputError(path + ": cannot be read as glb, its JSON is damaged");
  }
  Assimp::Importer importer;
  const aiScene* const scene = importer.ReadFileFromMemory(content.data(), content.size(), 0, "glb");
  if (!scene || !scene->mRootNode) {
    std::string reason = boost::algorithm::replace_all_copy(std::string(importer.GetErrorString()), "\n", " ");
    boost::algorithm::erase_all(reason, " for $$$___magic___$$$.glb");  // Assimp's name for memory
    boost::algorithm::trim(reason);
    throw InputError(path + ": cannot be read as glb" + (reason.empty() ? "" : ", " + reason));
  }
  shape = SceneReader(*scene).shape();
  if (shape.vertices.empty()) throw InputError(path + ": has neither faces nor points");
}

}  // namespace pcl_symmetry::apps
