#include <atomic>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <utility>

#include "core/base/parallel.h"
#include "pcl_symmetry/symmetry_database.h"
#include "recognition/database_parts.h"

namespace pcl_symmetry {

namespace {

bool isStored(detail::DatabaseParts& parts, const ModelInfo& info) {
  if (info.source.checksum.empty()) return false;
  const std::lock_guard<std::mutex> lock(parts.mutex);
  const auto stored = parts.store.find(info.name);
  return stored && stored->second.source.checksum == info.source.checksum;
}

}  // namespace

/// Describes models on all threads, a model on one, and stores each when it is described.
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

  std::mutex mutex;  // of the report, the failures and calls of progress
  std::atomic<bool> stopped{false};
  std::size_t num_done = 0;
  parallelBlocks(used.size(), parts_->options.num_threads, [&](std::size_t k) {
    if (stopped) return;
    const ModelInput& input = models[used[k]];
    ModelInfo info{input.name, 0, {}, 0};
    std::optional<detail::DescribedModel> model;  // nothing where it is stored already
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
