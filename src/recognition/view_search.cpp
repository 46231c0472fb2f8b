#include "recognition/view_search.h"

#include <algorithm>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/base/parallel.h"
#include "recognition/io_error.h"

namespace pcl_symmetry::detail {

namespace {

// Models whose views are compared in full. measured: of 119 scans of models of the Princeton Shape Benchmark (fold 0 of
// the training half) among 100 000 models, the scanned one is among the 50 models with the nearest codes for 109, among
// 100 for 114, 200 for 117 and 400 for 118. Twice as many are read for one of them.
constexpr std::size_t kViewCandidates = 200;

ViewIndex indexOf(const std::vector<StoredModel>& models, const ViewSearch::ViewReader& read, int num_threads) {
  std::vector<std::vector<View>> views(models.size());
  parallelBlocks(models.size(), num_threads, [&](std::size_t i) { views[i] = read(models[i]); });
  ViewIndex index;
  for (std::vector<View>& of_model : views) index.add(std::exchange(of_model, {}));
  return index;
}

}  // namespace

ViewSearch::ViewSearch(ModelStore& store, const FittedForms& stored, const DatabaseOptions& options)
    : models_(store.models()) {
  if (models_.size() <= kViewCandidates) {
    std::mutex mutex;
    all_ = indexOf(
        models_, [&](const StoredModel& model) { return viewsOf(store, model, mutex); }, options.num_threads);
    return;
  }
  std::sort(models_.begin(), models_.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  const auto num_references = static_cast<std::size_t>(stored.forms ? stored.forms->numReferences() : 0);
  const bool outgrown = isOutgrown(num_references, models_.size(), options.num_references);
  coder_ = outgrown ? fitViewCoder(store, options.num_references, options.num_threads) : stored.coder;
  readCodes(store, outgrown ? 0 : stored.id, options.num_threads);
}

/// \param stored the projection whose codes are read, 0: all codes are made.
void ViewSearch::readCodes(ModelStore& store, std::int64_t stored, int num_threads) {
  const auto fail = [&](std::int64_t id, const std::string& reason) {
    failIO(store.file(), "the code of views of model " + std::to_string(id) + " " + reason +
                             ", pcl_symmetry_database rebuild makes new ones");
  };
  const std::vector<StoredModel> without = stored != 0 ? store.modelsWithoutForms() : models_;
  std::size_t next = 0, next_without = 0;
  std::vector<PackedForms> made;
  const auto isWithout = [&] { return next_without < without.size() && without[next_without].id == models_[next].id; };
  const auto addMade = [&] {
    const std::size_t at = next_without % kModelsAtOnce;
    if (at == 0) {
      const auto begin = without.begin() + static_cast<std::ptrdiff_t>(next_without);
      const std::vector<StoredModel> part(begin, begin + std::min(kModelsAtOnce, without.size() - next_without));
      made = formsOfModels(store, part, nullptr, coder_.get(), num_threads);
    }
    codes_.add(made[at].view_codes);
    ++next_without;
    ++next;
  };
  const auto take = [&](std::int64_t id, const std::string& bytes) {
    while (next < models_.size() && isWithout()) addMade();
    if (next == models_.size() || models_[next].id != id) fail(id, "is that of another model");
    try {
      codes_.add(bytes);
    } catch (const std::invalid_argument& error) {
      fail(id, std::string("is damaged: ") + error.what());
    }
    if (next == 0) codes_.reserve(models_.size(), models_.size() * codes_.numViews());
    ++next;
  };
  if (stored != 0) store.eachViewCodes(stored, take);
  while (next < models_.size() && isWithout()) addMade();
  if (next < models_.size()) fail(models_[next].id, "is missing");
}

std::vector<ModelOfView> ViewSearch::nearest(const View& scan, const ViewSearchOptions& options,
                                             const ViewReader& read) const {
  std::vector<StoredModel> candidates;
  ViewIndex index;
  if (coder_) {
    const auto count = std::max(kViewCandidates, static_cast<std::size_t>(options.num_nearest));
    for (const int model :
         codes_.nearest(coder_->codeOf(scan), options.size_weight, static_cast<int>(count), options.num_threads))
      candidates.push_back(models_[static_cast<std::size_t>(model)]);
    index = indexOf(candidates, read, options.num_threads);
  }
  std::vector<ModelOfView> found;
  for (ShapeOfView& shape : (coder_ ? index : all_).nearest(scan, options))
    found.push_back(
        {(coder_ ? candidates : models_)[static_cast<std::size_t>(shape.shape)], std::move(shape.T_shape_scan)});
  return found;
}

}  // namespace pcl_symmetry::detail
