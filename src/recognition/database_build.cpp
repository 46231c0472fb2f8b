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

using detail::DatabaseParts;

/// Describes models on all threads, a model on one, and stores each when it is described.
class DatabaseBuild {
public:
  DatabaseBuild(DatabaseParts& parts, const std::vector<ModelInput>& inputs, const BuildProgress& progress)
      : parts_(parts), inputs_(inputs), progress_(progress), options_(parts.options) {
    options_.num_threads = 1;
  }

  BuildReport run() {
    std::set<std::string> names;
    std::vector<std::size_t> used;
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      if (names.insert(inputs_[i].name).second)
        used.push_back(i);
      else
        failures_[i] = "name = '" + inputs_[i].name + "' is that of an earlier model, names must differ";
    }
    parallelBlocks(used.size(), parts_.options.num_threads, [&](std::size_t i) {
      if (stopped_) return;
      try {
        use(used[i]);
      } catch (...) {
        stopped_ = true;
        throw;
      }
      told(static_cast<double>(++num_done_) / static_cast<double>(used.size()));
    });
    for (const auto& [i, reason] : failures_) report_.failures.emplace_back(inputs_[i].name, reason);
    return report_;
  }

private:
  void use(std::size_t i) {
    const ModelInput& input = inputs_[i];
    ModelInfo info{input.name, 0, {}, 0};
    detail::DescribedModel model;
    try {
      detail::checkModelName(input.name);
      if (input.source) info.source = input.source();
      if (isStored(info)) return count(report_.num_kept);
      const Points points = detail::finitePoints(input.load(), options_.max_points);
      model = detail::describedModel(points, options_);
    } catch (const std::exception& error) {
      const std::lock_guard<std::mutex> lock(mutex_);
      failures_[i] = error.what();
      return;
    }
    info.time = detail::currentTime();
    info.num_points = model.packed.num_points;
    parts_.add(info, model.packed, model.signatures);
    count(report_.num_added);
  }

  bool isStored(const ModelInfo& info) {
    if (info.source.checksum.empty()) return false;
    const std::lock_guard<std::mutex> lock(parts_.mutex);
    const auto stored = parts_.store.find(info.name);
    return stored && stored->second.source.checksum == info.source.checksum;
  }

  void count(std::size_t& counter) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++counter;
  }

  void told(double share) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!progress_ || stopped_ || progress_(share)) return;
    stopped_ = report_.cancelled = true;
  }

  DatabaseParts& parts_;
  const std::vector<ModelInput>& inputs_;
  const BuildProgress& progress_;
  DatabaseOptions options_;  // of one model
  std::mutex mutex_;         // of what follows, and of calls of progress_
  BuildReport report_;
  std::map<std::size_t, std::string> failures_;  // by number of the input
  std::atomic<bool> stopped_{false};
  std::atomic<std::size_t> num_done_{0};
};

}  // namespace

BuildReport SymmetryDatabase::build(const std::vector<ModelInput>& models, const BuildProgress& progress) {
  BuildReport report = DatabaseBuild(*parts_, models, progress).run();
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
