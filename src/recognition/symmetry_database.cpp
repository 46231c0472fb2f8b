#include "pcl_symmetry/recognition/symmetry_database.h"

#include <cmath>
#include <utility>

#include "core/base/check.h"
#include "core/matching/shape_description.h"
#include "core/views/view_signature.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "recognition/database_parts.h"

namespace pcl_symmetry {

namespace {

void checkModelName(const std::string& name) {
  if (!detail::isModelName(name))
    throw std::invalid_argument("name = '" + name +
                                "', must be 1 to 100 letters, digits, '_', '-' or '.', not '.' first");
}

detail::Model describedModel(const Points& points, const DatabaseOptions& options) {
  DescriptionOptions description;
  description.num_threads = options.num_threads;
  detail::Model model;
  model.signatures = describeShape(points, description).signatures;
  model.views = viewsAround(points, options.num_views, options.num_threads);
  model.cloud.resize(static_cast<std::size_t>(points.cols()));
  model.cloud.getMatrixXfMap(3, 4, 0) = points;
  return model;
}

}  // namespace

void DatabaseOptions::validate() const {
  check(num_references >= 1, "num_references", num_references, ">= 1");
  check(num_views >= 1, "num_views", num_views, ">= 1");
  check(max_points >= 100, "max_points", static_cast<double>(max_points), ">= 100");
  checkNumThreads(num_threads);
}

SymmetryDatabase::SymmetryDatabase(const std::string& folder, const DatabaseOptions& options) {
  detail::withBadArguments([&] { options.validate(); });
  parts_ = std::make_unique<detail::DatabaseParts>(folder, options);
}

SymmetryDatabase::~SymmetryDatabase() = default;
SymmetryDatabase::SymmetryDatabase(SymmetryDatabase&&) noexcept = default;
SymmetryDatabase& SymmetryDatabase::operator=(SymmetryDatabase&&) noexcept = default;

std::vector<std::string> SymmetryDatabase::names() const {
  std::vector<std::string> names;
  for (const auto& [name, model] : parts_->models) names.push_back(name);
  return names;
}

std::size_t SymmetryDatabase::size() const {
  return parts_->models.size();
}

bool SymmetryDatabase::contains(const std::string& name) const {
  return parts_->models.count(name) > 0;
}

void SymmetryDatabase::add(const std::string& name, const Cloud& cloud) {
  detail::withBadArguments([&] {
    checkModelName(name);
    const Points points = detail::finitePoints(cloud, parts_->options.max_points);
    if (const std::string reason = detail::reasonForNoAnswer(points); !reason.empty())
      throw std::invalid_argument(reason);
    parts_->models[name] = describedModel(points, parts_->options);
    parts_->search.forget(name);
    parts_->changed = true;
  });
}

void SymmetryDatabase::remove(const std::string& name) {
  detail::withBadArguments([&] {
    if (parts_->models.erase(name) == 0) throw std::invalid_argument("name = '" + name + "', must be that of a model");
    parts_->search.forget(name);
    parts_->changed = true;
  });
}

void SymmetryDatabase::rebuild() {
  parts_->changed = true;
  detail::withBadArguments([&] { parts_->search.fit(parts_->models, parts_->folder); });
  parts_->search.index(parts_->models, parts_->folder);
}

void SymmetryDatabase::save() {
  if (!parts_->changed) return;
  if (parts_->search.isOutgrown(parts_->models))
    rebuild();
  else
    parts_->search.index(parts_->models, parts_->folder);
  parts_->folder.save(parts_->models, parts_->search.projection(), parts_->search.numReferences());
  parts_->changed = false;
}

SymmetryDatabase::Cloud SymmetryDatabase::cloud(const std::string& name) const {
  return detail::withBadArguments([&] { return parts_->modelCloud(name); });
}

std::vector<ModelMatch> SymmetryDatabase::match(const Cloud& cloud, int num_nearest, const Viewpoint& viewpoint) const {
  detail::checkAtLeast("num_nearest", num_nearest, 0);
  const Points points = detail::finitePoints(cloud, parts_->options.max_points);
  return detail::emptyWithoutAnswer(points, [&] {
    const std::optional<Visibility> seen =
        detail::withBadArguments([&] { return detail::seenSpace(cloud, points, viewpoint); });
    return parts_->search.likeShapes(points, seen ? &*seen : nullptr, num_nearest);
  });
}

}  // namespace pcl_symmetry
