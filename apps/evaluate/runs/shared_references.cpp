#include "evaluate/runs/shared_references.h"

#include <exception>
#include <optional>
#include <string>

#include "common/shape_input/shape_input.h"
#include "evaluate/runs/packed_rows.h"

namespace pcl_symmetry::apps {

namespace {

struct FoundReferences {
  std::size_t num_faces;
  ReferenceSymmetries symmetries;
};

void put(detail::PackedBytes& bytes, const FoundReferences& found) {
  bytes.put(found.num_faces);
  bytes.putText(toJson(found.symmetries).dump());
}

void get(detail::UnpackedBytes& bytes, FoundReferences& found) {
  found.num_faces = bytes.get<std::size_t>();
  found.symmetries = referencesFromJson(nlohmann::json::parse(bytes.text()));
}

ItemRows<FoundReferences> referencesOf(const Model& model, const ReferenceOptions& options,
                                       const ReferenceCache& known) {
  try {
    const Shape shape = loadShape(model.path);
    if (!shape.mesh || known.find(model.key, shape.mesh->polygons.size())) return {};
    ItemRows<FoundReferences> item;
    item.rows.push_back({shape.mesh->polygons.size(), findReferenceSymmetries(*shape.mesh, options)});
    return item;
  } catch (const std::exception&) {
    return {};  // who uses the model meets the same and says so
  }
}

}  // namespace

void shareReferences(const std::vector<Model>& models, const ReferenceOptions& options, ReferenceCache& cache,
                     ResumableRun& work, const Console& console) {
  Step step(console, "Searching symmetries of " + std::to_string(models.size()) + " models");
  std::vector<std::string> names;
  for (const Model& model : models) names.push_back("references of " + model.key);
  const auto found = rowsOfItems<FoundReferences>(
      names, [&](std::size_t i) { return referencesOf(models[i], options, cache); }, work, step);
  int num_found = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (const FoundReferences& references : found[i].rows) {
      cache.add(models[i].key, references.num_faces, references.symmetries);
      ++num_found;
    }
  }
  if (work.isFirst()) cache.save();
  std::string text = work.isFirst() ? cache.text() : "";
  work.broadcast(text);
  if (!work.isFirst()) cache.setText(text);
  step.done(std::to_string(num_found) + " new");
}

}  // namespace pcl_symmetry::apps
