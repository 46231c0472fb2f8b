#include "pcl_symmetry/symmetry_database.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/base/check.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "recognition/database_parts.h"

namespace pcl_symmetry {

namespace {

[[noreturn]] void failUnknown(const std::string& name) {
  throw std::invalid_argument("name = '" + name + "', must be that of a model");
}

/// Names are looked up in an index of the file, which can be damaged apart from the models.
bool isListed(detail::ModelStore& store, const std::string& name) {
  const std::vector<detail::StoredModel>& models = store.models();
  return std::any_of(models.begin(), models.end(), [&](const auto& model) { return model.name == name; });
}

std::pair<std::int64_t, ModelInfo> findModel(detail::DatabaseParts& parts, const std::string& name) {
  return detail::withBadArguments([&] {
    const std::lock_guard<std::mutex> lock(parts.mutex);
    auto found = parts.store.find(name);
    if (!found && isListed(parts.store, name)) detail::failIO(parts.store.file(), "the index of names is damaged");
    if (!found) failUnknown(name);
    return std::move(*found);
  });
}

}  // namespace

void DatabaseOptions::validate() const {
  check(num_references >= 1, "num_references", num_references, ">= 1");
  check(num_views >= 1, "num_views", num_views, ">= 1");
  check(max_points >= 100, "max_points", static_cast<double>(max_points), ">= 100");
  check(lock_timeout >= 0.0 && lock_timeout <= 1e6, "lock_timeout", lock_timeout, "in [0, 1e6]");
  checkNumThreads(num_threads);
}

SymmetryDatabase::SymmetryDatabase(const std::string& file, const DatabaseOptions& options) {
  detail::withBadArguments([&] { options.validate(); });
  parts_ = std::make_unique<detail::DatabaseParts>(file, options);
}

SymmetryDatabase::~SymmetryDatabase() = default;
SymmetryDatabase::SymmetryDatabase(SymmetryDatabase&&) noexcept = default;
SymmetryDatabase& SymmetryDatabase::operator=(SymmetryDatabase&&) noexcept = default;

std::vector<std::string> SymmetryDatabase::names() const {
  const std::lock_guard<std::mutex> lock(parts_->mutex);
  std::vector<std::string> names;
  for (const detail::StoredModel& model : parts_->store.models()) names.push_back(model.name);
  return names;
}

std::size_t SymmetryDatabase::size() const {
  const std::lock_guard<std::mutex> lock(parts_->mutex);
  return static_cast<std::size_t>(parts_->store.size());
}

bool SymmetryDatabase::contains(const std::string& name) const {
  const std::lock_guard<std::mutex> lock(parts_->mutex);
  return parts_->store.find(name).has_value();
}

ModelInfo SymmetryDatabase::info(const std::string& name) const {
  return findModel(*parts_, name).second;
}

std::string SymmetryDatabase::unit() const {
  const std::lock_guard<std::mutex> lock(parts_->mutex);
  return parts_->store.fact("unit");
}

void SymmetryDatabase::refresh() {
  const std::lock_guard<std::mutex> lock(parts_->mutex);
  parts_->store.refresh();
}

void SymmetryDatabase::add(const std::string& name, const Cloud& cloud, const ModelSource& source) {
  detail::withBadArguments([&] {
    detail::checkModelName(name);
    const detail::DescribedModel model =
        detail::describedModel(detail::finitePoints(cloud, parts_->options.max_points), parts_->options);
    parts_->add({name, detail::currentTime(), source, model.packed.num_points}, model.packed, model.signatures);
  });
}

void SymmetryDatabase::remove(const std::string& name) {
  detail::withBadArguments([&] {
    const std::lock_guard<std::mutex> lock(parts_->mutex);
    if (!parts_->store.remove(name)) failUnknown(name);
  });
}

void SymmetryDatabase::save() {
  detail::withBadArguments([&] { parts_->save(); });
}

void SymmetryDatabase::rebuild() {
  detail::withBadArguments([&] { parts_->rebuild(); });
}

std::vector<std::string> SymmetryDatabase::check(const std::string& file) {
  if (!std::filesystem::exists(file)) detail::failIO(file, "there is no such file");
  return detail::ModelStore(file, DatabaseOptions().lock_timeout, "").damages();
}

SymmetryDatabase::Cloud SymmetryDatabase::cloud(const std::string& name) const {
  return parts_->cloud({findModel(*parts_, name).first, name});
}

std::vector<ModelMatch> SymmetryDatabase::match(const Cloud& cloud, int num_nearest, const Viewpoint& viewpoint) const {
  detail::checkAtLeast("num_nearest", num_nearest, 0);
  const Points points = detail::finitePoints(cloud, parts_->options.max_points);
  return detail::emptyWithoutAnswer(points, [&] {
    const std::optional<Visibility> seen =
        detail::withBadArguments([&] { return detail::seenSpace(cloud, points, viewpoint); });
    std::vector<ModelMatch> matches;
    for (const auto& [model, distance] : parts_->shapes()->nearest(points, seen ? &*seen : nullptr, num_nearest))
      matches.push_back({model.name, distance});
    return matches;
  });
}

}  // namespace pcl_symmetry
