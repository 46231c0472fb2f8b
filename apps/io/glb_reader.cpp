#include "io/glb_reader.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "io/header_lines.h"

namespace pcl_symmetry::apps {

namespace {

using nlohmann::json;

// The numbers of types and modes in what follows are those of the glTF 2.0 specification.
constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;  // derived: "JSON" and "BIN\0"
// Corners that nodes may repeat a mesh to. chosen: ten times as many do not fit into the memory of most machines, a
// tenth is the size of large scans.
constexpr std::uint64_t kMostCorners = 100'000'000;

/// Values of a buffer: count elements, each of several components.
struct Accessor {
  std::string_view bytes;
  std::uint64_t stride = 0, count = 0;
  int type = 0;
  bool is_normalized = false;
};

template <typename Value>
Value valueAt(std::string_view bytes, std::uint64_t offset) {
  Value value;
  std::memcpy(&value, bytes.data() + offset, sizeof(value));
  return value;
}

std::uint64_t sizeOfType(int type) {
  switch (type) {
    case 5120:
    case 5121:
      return 1;
    case 5122:
    case 5123:
      return 2;
    case 5125:
    case 5126:
      return 4;
    default:
      return 0;
  }
}

/// Component k of element i.
double numberAt(const Accessor& accessor, std::uint64_t i, std::uint64_t k) {
  const std::uint64_t at = i * accessor.stride + k * sizeOfType(accessor.type);
  // Integers may stand for fractions of the greatest one.
  const auto fraction = [&](double value, double greatest) {
    return accessor.is_normalized ? std::max(value / greatest, -1.0) : value;
  };
  switch (accessor.type) {
    case 5120:
      return fraction(valueAt<std::int8_t>(accessor.bytes, at), 127.0);
    case 5121:
      return fraction(valueAt<std::uint8_t>(accessor.bytes, at), 255.0);
    case 5122:
      return fraction(valueAt<std::int16_t>(accessor.bytes, at), 32767.0);
    case 5123:
      return fraction(valueAt<std::uint16_t>(accessor.bytes, at), 65535.0);
    case 5125:
      return valueAt<std::uint32_t>(accessor.bytes, at);
    default:
      return static_cast<double>(valueAt<float>(accessor.bytes, at));
  }
}

/// The two chunks of a file, and the objects of its JSON.
class GLBFile {
public:
  explicit GLBFile(const std::string& path) : path_(path), text_(readWholeFile(path)) {
    if (text_.size() < 20 || text_.compare(0, 4, "glTF") != 0 || valueAt<std::uint32_t>(text_, 4) != 2)
      reject("cannot be read as binary glTF of version 2");
    for (std::uint64_t at = 12; text_.size() - at >= 8;) {
      const std::uint64_t size = valueAt<std::uint32_t>(text_, at);
      const auto kind = valueAt<std::uint32_t>(text_, at + 4);
      at += 8;
      if (size > text_.size() - at) reject("cannot be read, a chunk is longer than the file");
      const std::string_view chunk = std::string_view(text_).substr(at, size);
      if (kind == kJsonChunk && json_.is_null()) json_ = json::parse(chunk, nullptr, false);
      if (kind == kBinaryChunk) binary_ = chunk;
      at += size;
    }
    if (!json_.is_object()) reject("cannot be read, its JSON is damaged");
    for (const char* name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression"})
      if (const auto required = json_.find("extensionsRequired"); required != json_.end() && required->is_array())
        if (std::find(required->begin(), required->end(), name) != required->end())
          reject(std::string("is compressed by ") + name + ", which is not supported");
  }

  [[noreturn]] void reject(const std::string& what) const { apps::reject(path_, what); }

  const json& root() const { return json_; }

  /// Entry \p index of a list of the file.
  const json& item(const char* list, std::uint64_t index) const {
    const auto found = json_.find(list);
    const std::uint64_t size = found != json_.end() && found->is_array() ? found->size() : 0;
    if (index >= size)
      reject(std::string(list) + "[" + std::to_string(index) + "] is missing, there are " + std::to_string(size));
    const json& entry = (*found)[index];
    if (!entry.is_object()) reject(std::string(list) + "[" + std::to_string(index) + "] must be an object");
    return entry;
  }

  /// A whole number of an entry, or the default where there is none.
  std::uint64_t count(const json& entry, const char* field, std::optional<std::uint64_t> without = std::nullopt) const {
    const auto found = entry.find(field);
    if (found == entry.end() && without) return *without;
    if (found == entry.end() || !found->is_number_unsigned())
      reject(std::string(field) + " = " + (found == entry.end() ? "nothing" : found->dump().substr(0, 40)) +
             ", must be a whole number >= 0");
    return found->get<std::uint64_t>();
  }

  /// \param index among the accessors.
  /// \param num_components of each element: 3 for positions, 1 for indices.
  Accessor accessor(std::uint64_t index, std::uint64_t num_components) const {
    const json& entry = item("accessors", index);
    const std::string name = "accessors[" + std::to_string(index) + "]";
    if (entry.contains("sparse") || !entry.contains("bufferView"))
      reject(name + " has no values of its own, must have a bufferView and not be sparse");
    const json& view = item("bufferViews", count(entry, "bufferView"));
    if (count(view, "buffer", 0) != 0 || item("buffers", 0).contains("uri"))
      reject(name + " has its values in another file, must have them in this one");
    Accessor result;
    result.type = static_cast<int>(std::min<std::uint64_t>(count(entry, "componentType"), 10'000));
    const std::uint64_t size = num_components * sizeOfType(result.type);
    const char* type = num_components == 3 ? "VEC3" : "SCALAR";
    if (size == 0 || entry.value("type", json()) != type)
      reject(name + " must have a known componentType and type " + type);
    result.is_normalized = entry.value("normalized", json()) == true;
    result.stride = count(view, "byteStride", size);
    result.count = count(entry, "count");
    result.bytes = bytesOf(view);
    const std::uint64_t offset = count(entry, "byteOffset", 0);
    const std::uint64_t available = result.bytes.size() - std::min<std::uint64_t>(offset, result.bytes.size());
    const bool fits = result.count == 0 || (result.stride >= size && size <= available &&
                                            result.count - 1 <= (available - size) / result.stride);
    if (!fits) reject(name + ": count = " + std::to_string(result.count) + ", its bufferView holds fewer values");
    result.bytes.remove_prefix(result.bytes.size() - available);
    return result;
  }

private:
  std::string_view bytesOf(const json& view) const {
    const std::uint64_t offset = count(view, "byteOffset", 0), size = count(view, "byteLength");
    if (offset > binary_.size() || size > binary_.size() - offset)
      reject("a bufferView of " + std::to_string(size) + " bytes goes beyond the " + std::to_string(binary_.size()) +
             " bytes of the file's values");
    return binary_.substr(offset, size);
  }

  const std::string& path_;
  std::string text_;
  json json_;
  std::string_view binary_;
};

std::vector<double> nodeNumbers(const GLBFile& file, const json& node, const char* field, std::vector<double> without) {
  const auto found = node.find(field);
  if (found == node.end()) return without;
  const bool fits = found->is_array() && found->size() == without.size() &&
                    std::all_of(found->begin(), found->end(), [](const json& value) { return value.is_number(); });
  if (!fits) file.reject(std::string(field) + " of a node must be " + std::to_string(without.size()) + " numbers");
  return found->get<std::vector<double>>();
}

Eigen::Affine3d poseOf(const GLBFile& file, const json& node) {
  if (node.contains("matrix")) {
    Eigen::Affine3d pose;
    pose.matrix() =
        Eigen::Map<const Eigen::Matrix4d>(nodeNumbers(file, node, "matrix", std::vector<double>(16)).data());
    return pose;
  }
  const auto t = nodeNumbers(file, node, "translation", {0, 0, 0}), s = nodeNumbers(file, node, "scale", {1, 1, 1});
  const auto q = nodeNumbers(file, node, "rotation", {0, 0, 0, 1});
  const Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
  if (!(rotation.norm() > 0.0)) file.reject("rotation of a node must not be zero");
  return Eigen::Translation3d(t[0], t[1], t[2]) * rotation.normalized() * Eigen::Scaling(s[0], s[1], s[2]);
}

/// Walks through the nodes of the scene and collects what their meshes hold.
class SceneReader {
public:
  explicit SceneReader(const GLBFile& file) : file_(file) {}

  GLBShape read() {
    struct Step {
      std::uint64_t node;
      Eigen::Affine3d T_scene_parent;
    };
    std::vector<Step> steps;
    const auto add = [&](const json& entry, const char* field, const Eigen::Affine3d& pose) {
      const auto list = entry.find(field);
      if (list == entry.end()) return;
      if (!list->is_array()) file_.reject(std::string(field) + " must be a list of nodes");
      for (auto node = list->rbegin(); node != list->rend(); ++node) {
        if (!node->is_number_unsigned()) file_.reject(std::string(field) + " must be numbers of nodes");
        steps.push_back({node->get<std::uint64_t>(), pose});
      }
    };
    add(file_.item("scenes", file_.count(file_.root(), "scene", 0)), "nodes", Eigen::Affine3d::Identity());
    std::unordered_set<std::uint64_t> seen;
    while (!steps.empty()) {
      const Step step = steps.back();
      steps.pop_back();
      const json& node = file_.item("nodes", step.node);
      if (!seen.insert(step.node).second)
        file_.reject("nodes[" + std::to_string(step.node) + "] stands in the scene twice, must have one parent");
      const Eigen::Affine3d T_scene_node = step.T_scene_parent * poseOf(file_, node);
      if (node.contains("mesh")) addMesh(file_.item("meshes", file_.count(node, "mesh")), T_scene_node);
      add(node, "children", T_scene_node);
    }
    if (shape_.triangles.empty()) keepPoints();
    return std::move(shape_);
  }

private:
  using Key = std::array<std::uint64_t, 3>;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      return std::hash<std::string_view>()({reinterpret_cast<const char*>(key.data()), sizeof(key)});
    }
  };

  void addMesh(const json& mesh, const Eigen::Affine3d& T_scene_mesh) {
    const auto primitives = mesh.find("primitives");
    if (primitives == mesh.end() || !primitives->is_array()) file_.reject("a mesh must have a list of primitives");
    for (const json& primitive : *primitives) {
      if (!primitive.is_object() || !primitive.contains("attributes") || !primitive["attributes"].is_object())
        file_.reject("a primitive must have attributes");
      if (!primitive["attributes"].contains("POSITION")) continue;
      addPrimitive(primitive, T_scene_mesh);
    }
  }

  void addPrimitive(const json& primitive, const Eigen::Affine3d& T_scene_mesh) {
    const Accessor positions = file_.accessor(file_.count(primitive["attributes"], "POSITION"), 3);
    std::optional<Accessor> indices;
    if (primitive.contains("indices")) indices = file_.accessor(file_.count(primitive, "indices"), 1);
    if (indices && indices->type != 5121 && indices->type != 5123 && indices->type != 5125)
      file_.reject("indices must be whole numbers without a sign");
    const std::uint64_t num_corners = indices ? indices->count : positions.count;
    num_corners_ += std::max(num_corners, positions.count);
    if (num_corners_ > kMostCorners)
      file_.reject("its nodes have more than " + std::to_string(kMostCorners) + " corners");
    const auto corner = [&](std::uint64_t i) {
      const auto index = indices ? static_cast<std::uint64_t>(numberAt(*indices, i, 0)) : i;
      if (index >= positions.count)
        file_.reject("an index = " + std::to_string(index) + ", must be < " + std::to_string(positions.count));
      return addVertex(positions, index, T_scene_mesh);
    };
    const std::uint64_t mode = file_.count(primitive, "mode", 4);
    const auto addTriangle = [&](std::uint64_t a, std::uint64_t b, std::uint64_t c) {
      shape_.triangles.push_back({corner(a), corner(b), corner(c)});  // in this order: braces, not a call
    };
    if (mode == 4)
      for (std::uint64_t i = 0; i + 3 <= num_corners; i += 3) addTriangle(i, i + 1, i + 2);
    if (mode == 5 || mode == 6)
      for (std::uint64_t i = 0; i + 3 <= num_corners; ++i) {
        const bool is_turned = mode == 5 && i % 2 == 1;
        addTriangle(mode == 5 ? i : 0, is_turned ? i + 2 : i + 1, is_turned ? i + 1 : i + 2);
      }
    if (mode < 4)
      for (std::uint64_t i = 0; i < positions.count; ++i) others_.push_back(vertexOf(positions, i, T_scene_mesh));
  }

  static Eigen::Vector3d vertexOf(const Accessor& positions, std::uint64_t i, const Eigen::Affine3d& T_scene_mesh) {
    return T_scene_mesh *
           Eigen::Vector3d(numberAt(positions, i, 0), numberAt(positions, i, 1), numberAt(positions, i, 2));
  }

  std::uint32_t addVertex(const Accessor& positions, std::uint64_t i, const Eigen::Affine3d& T_scene_mesh) {
    return indexOf(vertexOf(positions, i, T_scene_mesh));
  }

  /// Its bits are compared, so that values that are no numbers are no trouble.
  std::uint32_t indexOf(const Eigen::Vector3d& vertex) {
    Key key;
    for (int k = 0; k < 3; ++k) {
      const double value = vertex[k] + 0.0;  // of -0 too
      std::memcpy(&key[static_cast<std::size_t>(k)], &value, sizeof(value));
    }
    const auto [entry, is_new] = index_of_.emplace(key, static_cast<std::uint32_t>(shape_.vertices.size()));
    if (is_new) shape_.vertices.push_back(vertex);
    return entry->second;
  }

  void keepPoints() {
    for (const Eigen::Vector3d& point : others_) indexOf(point);
  }

  const GLBFile& file_;
  GLBShape shape_;
  std::unordered_map<Key, std::uint32_t, Hash> index_of_;
  std::vector<Eigen::Vector3d> others_;  ///< vertices of points and lines
  std::uint64_t num_corners_ = 0;
};

}  // namespace

GLBShape readGLB(const std::string& path) {
  const GLBFile file(path);
  GLBShape shape = SceneReader(file).read();
  if (shape.vertices.empty()) file.reject("has neither faces nor points");
  return shape;
}

}  // namespace pcl_symmetry::apps
