/// Joins vertices of exactly equal coordinates: STL repeats them for each face, OBJ and glTF for each group.
#pragma once

#include <cstring>
#include <functional>
#include <string_view>
#include <unordered_map>

#include "io/exact_coordinates.h"

namespace pcl_symmetry::apps {

class VertexWelder {
public:
  explicit VertexWelder(ExactShape& shape) : shape_(shape) {}

  /// \return the index of the vertex in the shape.
  pcl::index_t add(const Eigen::Vector3d& vertex) {
    const Key key{vertex + Eigen::Vector3d::Zero()};  // 0 in place of -0
    const auto [entry, is_new] = index_of_.emplace(key, static_cast<pcl::index_t>(shape_.vertices.size()));
    if (is_new) shape_.vertices.push_back(vertex);
    return entry->second;
  }

private:
  /// Bits are compared, so that values that are no numbers are no trouble.
  struct Key {
    Eigen::Vector3d xyz;
    std::string_view bytes() const { return {reinterpret_cast<const char*>(xyz.data()), sizeof(double) * 3}; }
    bool operator==(const Key& other) const { return bytes() == other.bytes(); }
  };
  struct Hash {
    std::size_t operator()(const Key& key) const { return std::hash<std::string_view>()(key.bytes()); }
  };
  ExactShape& shape_;
  std::unordered_map<Key, pcl::index_t, Hash> index_of_;
};

}  // namespace pcl_symmetry::apps
