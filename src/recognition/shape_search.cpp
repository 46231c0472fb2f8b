#include "recognition/shape_search.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/matching/shape_signature.h"
#include "recognition/recognition_rules.h"

namespace pcl_symmetry::detail {

ShapeSearch::ShapeSearch(ModelStore& store, const FittedForms& stored, const DatabaseOptions& options)
    : num_threads_(options.num_threads), forms_(stored.forms), models_(store.models()) {
  if (models_.empty()) return;
  const bool is_fitted = stored.isOf(referencesOf(store, options.num_references));
  if (!is_fitted) forms_ = fitForms(store, options.num_references, num_threads_);
  makeIndex(store, is_fitted ? stored.id : 0, options);
}

/// \param stored the projection whose forms are read, 0: all forms are made.
void ShapeSearch::makeIndex(ModelStore& store, std::int64_t stored, const DatabaseOptions& options) {
  Eigen::MatrixXf compact(forms_->numDimensions(), kFormsPerModel * static_cast<Eigen::Index>(models_.size()));
  std::vector<float> typical;
  for (const std::string& bytes : allForms(store, models_, stored, forms_.get(), nullptr, num_threads_)) {
    const std::size_t i = typical.size();
    try {
      const CompactForm form = CompactForm::unpacked(bytes);
      if (form.compact.rows() != compact.rows()) throw std::invalid_argument("is that of another projection");
      compact.middleCols<kFormsPerModel>(kFormsPerModel * static_cast<Eigen::Index>(i)) = form.compact;
      typical.push_back(form.typical);
    } catch (const std::invalid_argument& error) {
      failIO(store.file(), "the compact form of model " + std::to_string(models_[i].id) + " " + error.what());
    }
  }
  CompactIndexOptions index;
  index.num_candidates = kRecognition.num_shape_forms;
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
    found.push_back({models_[model], distance / root});
  return found;
}

}  // namespace pcl_symmetry::detail
