#include "recognition/shape_search.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/matching/shape_description.h"
#include "recognition/io_error.h"

namespace pcl_symmetry::detail {

namespace {

// Forms, at least, whose components are all compared. chosen: exact up to 1024 models; of more, half loses true
// neighbours of noisy queries, twice takes 5 ms more.
constexpr int kShapeCandidates = 2048;

}  // namespace

ShapeSearch::ShapeSearch(ModelStore& store, const FittedForms& stored, const DatabaseOptions& options)
    : num_threads_(options.num_threads), forms_(stored.forms), models_(store.models()) {
  if (models_.empty()) return;
  std::sort(models_.begin(), models_.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  const auto num_references = static_cast<std::size_t>(forms_ ? forms_->numReferences() : 0);
  const bool outgrown = isOutgrown(num_references, models_.size(), options.num_references);
  if (outgrown) forms_ = fitForms(store, options.num_references, num_threads_);
  makeIndex(store, outgrown ? 0 : stored.id, options);
}

/// \param stored the projection whose forms are read, 0: all forms are made.
void ShapeSearch::makeIndex(ModelStore& store, std::int64_t stored, const DatabaseOptions& options) {
  Eigen::MatrixXf compact(forms_->numDimensions(), kFormsPerModel * static_cast<Eigen::Index>(models_.size()));
  std::vector<float> typical(models_.size(), 0.0f);
  const auto take = [&](std::int64_t id, const std::string& bytes) {
    const auto model =
        std::lower_bound(models_.begin(), models_.end(), id, [](const auto& a, std::int64_t b) { return a.id < b; });
    try {
      const CompactForm form = CompactForm::unpacked(bytes);
      if (model == models_.end() || model->id != id || form.compact.rows() != compact.rows())
        throw std::invalid_argument("is that of another model or projection");
      const auto i = model - models_.begin();
      compact.middleCols<kFormsPerModel>(kFormsPerModel * i) = form.compact;
      typical[static_cast<std::size_t>(i)] = form.typical;
    } catch (const std::invalid_argument& error) {
      failIO(store.file(), "the compact form of model " + std::to_string(id) + " " + error.what());
    }
  };
  if (stored != 0) store.eachForms(stored, take);
  const std::vector<StoredModel> without = stored != 0 ? store.modelsWithoutForms() : models_;
  for (std::size_t first = 0; first < without.size(); first += kModelsAtOnce) {
    const auto begin = without.begin() + static_cast<std::ptrdiff_t>(first);
    const std::vector<StoredModel> part(begin, begin + std::min(kModelsAtOnce, without.size() - first));
    for (const PackedForms& made : formsOfModels(store, part, forms_.get(), nullptr, num_threads_))
      take(made.model, made.forms);
  }
  if (std::count(typical.begin(), typical.end(), 0.0f) > 0)
    failIO(store.file(), "has other compact forms than models, pcl_symmetry_database rebuild makes new ones");
  CompactIndexOptions index;
  index.num_candidates = kShapeCandidates;
  index.num_threads = options.num_threads;
  index_ = CompactIndex(std::move(compact), kFormsPerModel, index, std::move(typical));
}

std::vector<ShapeSearch::Found> ShapeSearch::nearest(const Points& points, const Visibility* seen,
                                                     int num_nearest) const {
  std::vector<Found> found;
  if (!forms_) return found;
  DescriptionOptions options;
  options.num_threads = num_threads_;
  const CompactForm form = forms_->formOf(describeShape(points, options, seen).signatures, 0);
  const double root = std::sqrt(form.typical);
  for (const auto& [model, distance] : index_.nearest(forms_->rotations(form), num_nearest))
    found.push_back({models_[static_cast<std::size_t>(model)], distance / root});
  return found;
}

}  // namespace pcl_symmetry::detail
