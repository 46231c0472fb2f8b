#include "pcl_symmetry/symmetry_database.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <utility>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "recognition/database_parts.h"

namespace pcl_symmetry {

namespace {

[[noreturn]] void failUnknown(const std::string& name) {
  throw std::invalid_argument("name = '" + name + "', must be that of a model");
}

/// Names are looked up in an index of the file, which may be damaged independently of the models.
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

bool isStored(detail::DatabaseParts& parts, const ModelInfo& info) {
  if (info.source.checksum.empty()) return false;
  const std::lock_guard<std::mutex> lock(parts.mutex);
  const auto stored = parts.store.find(info.name);
  return stored && stored->second.source.checksum == info.source.checksum;
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
  detail::checkAtLeast("num_nearest", num_nearest, 1);
  detail::checkedViewpoint(viewpoint);
  const Points points = detail::finitePoints(cloud, parts_->options.max_points);
  SeenSpace seen;
  if (points.cols() > 0)
    seen = detail::withBadArguments([&] { return detail::findSeenSpace(cloud, points, viewpoint); });
  return detail::emptyWithoutAnswer(points, [&] {
    std::vector<ModelMatch> matches;
    for (const auto& [model, distance] : parts_->shapes()->nearest(points, seen.visibility(), num_nearest))
      matches.push_back({model.name, distance});
    return matches;
  });
}

/// Describes models on all threads, each model on one, and stores each as soon as it is described.
BuildReport SymmetryDatabase::build(const std::vector<ModelInput>& models, const BuildProgress& progress) {
  DatabaseOptions options = parts_->options;
  options.num_threads = 1;
  BuildReport report;
  std::map<std::size_t, std::string> failures;  // by index of the input
  std::set<std::string> names;
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < models.size(); ++i) {
    if (names.insert(models[i].name).second)
      used.push_back(i);
    else
      failures[i] = "name = '" + models[i].name + "' is that of an earlier model, names must differ";
  }

  std::mutex mutex;  // guards the report, the failures and calls of progress
  std::atomic<bool> stopped{false};
  std::size_t num_done = 0;
  parallelBlocks(used.size(), parts_->options.num_threads, [&](std::size_t k) {
    if (stopped) return;
    const ModelInput& input = models[used[k]];
    ModelInfo info{input.name, 0, {}, 0};
    std::optional<detail::DescribedModel> model;  // empty if it is stored already
    std::optional<std::string> failure;
    try {
      detail::checkModelName(input.name);
      if (input.source) info.source = input.source();
      if (!isStored(*parts_, info))
        model = detail::describedModel(detail::finitePoints(input.load(), options.max_points), options);
    } catch (const std::exception& error) {
      failure = error.what();
    }
    if (model) {
      info.time = detail::currentTime();
      info.num_points = model->packed.num_points;
      try {
        parts_->add(info, model->packed, model->signatures);
      } catch (...) {
        stopped = true;
        throw;
      }
    }
    const std::lock_guard<std::mutex> lock(mutex);
    if (failure)
      failures[used[k]] = *failure;
    else
      ++(model ? report.num_added : report.num_kept);
    const double share = static_cast<double>(++num_done) / static_cast<double>(used.size());
    if (progress && !stopped && !progress(share)) stopped = report.cancelled = true;
  });
  for (const auto& [i, reason] : failures) report.failures.emplace_back(models[i].name, reason);
  if (!report.cancelled && !parts_->options.is_part) save();
  return report;
}

std::size_t SymmetryDatabase::merge(const std::vector<std::string>& files, const BuildProgress& progress) {
  const std::optional<std::size_t> num_added = detail::withBadArguments([&] {
    const std::lock_guard<std::mutex> lock(parts_->mutex);
    return parts_->store.merge(files, progress);
  });
  if (num_added) save();
  return num_added.value_or(0);
}

}  // namespace pcl_symmetry
