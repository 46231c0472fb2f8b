#include "recognition/database_parts.h"

#include <utility>

namespace pcl_symmetry::detail {

DatabaseParts::DatabaseParts(const std::string& path, const DatabaseOptions& database_options)
    : options(database_options), folder(path), search(options.num_references, options.num_threads) {
  if (folder.manifest().files.empty()) return;
  SignatureProjection projection = folder.projection();
  models = folder.models(projection);
  search.restore(std::move(projection), folder.manifest().num_references);
  search.index(models, folder);
}

PositionCloud DatabaseParts::modelCloud(const std::string& name) const {
  const auto model = models.find(name);
  if (model == models.end()) throw std::invalid_argument("name = '" + name + "', must be that of a model");
  return folder.cloud(model->second);
}

Points DatabaseParts::modelPoints(const std::string& name, std::size_t max_points) const {
  return finitePoints(modelCloud(name), max_points);
}

}  // namespace pcl_symmetry::detail
