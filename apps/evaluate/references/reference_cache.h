/// Reference symmetries in a file: the search takes about a second for each mesh.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "evaluate/references/reference_symmetries.h"

namespace pcl_symmetry::apps {

nlohmann::json toJson(const ReferenceSymmetries& symmetries);

/// \throws nlohmann::json::exception where the JSON is not what toJson() made.
ReferenceSymmetries referencesFromJson(const nlohmann::json& json);

class ReferenceCache {
public:
  /// \param path read if it exists; empty for a cache that lives in memory only.
  /// \throws InputError where the file cannot be understood or was made with other options.
  ReferenceCache(std::string path, const ReferenceOptions& options);

  /// \param key as Model::key.
  /// \param num_faces of the mesh: another number is another mesh under the same name.
  std::optional<ReferenceSymmetries> find(const std::string& key, std::size_t num_faces) const;

  void add(const std::string& key, std::size_t num_faces, const ReferenceSymmetries& symmetries);

  /// All that is in it.
  std::string text() const { return content_.dump(); }
  /// \param text of another cache of the same options.
  void setText(const std::string& text) { content_ = nlohmann::json::parse(text); }

  /// Writes the file if add() was called since.
  void save();

private:
  std::string path_;
  nlohmann::json content_;
  bool changed_ = false;
};

}  // namespace pcl_symmetry::apps
