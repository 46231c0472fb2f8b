#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "core/matching/view_code.h"
#include "recognition/compact_forms.h"
#include "recognition/model_store.h"

namespace pcl_symmetry::detail {

/// What is fitted to the models of a database. Every function throws pcl::IOException, which names file and reason.
struct FittedForms {
  std::int64_t id = 0;  ///< the number that it is stored under, 0: it is not stored
  std::shared_ptr<const CompactForms> forms;
  std::shared_ptr<const ViewCoder> coder;

  PackedProjection packed() const;
  /// \throws std::invalid_argument for other bytes.
  static FittedForms unpacked(const PackedProjection& packed);
};

/// Models whose forms are made at a time where they are not stored. chosen: their views take 50 MB; half and twice take
/// the same time.
constexpr std::size_t kModelsAtOnce = 512;

/// True where there are no references, or less than half of those that would be taken now.
bool isOutgrown(std::size_t num_references, std::size_t num_models, int max_references);

/// Fits to up to \p max_references models, spread evenly over all.
/// \throws std::invalid_argument where all models are alike.
std::shared_ptr<const CompactForms> fitForms(ModelStore& store, int max_references, int num_threads);
std::shared_ptr<const ViewCoder> fitViewCoder(ModelStore& store, int max_references, int num_threads);

/// Makes forms of some models, on several threads: compact forms, codes of views, or both; what is null is left out.
std::vector<PackedForms> formsOfModels(ModelStore& store, const std::vector<StoredModel>& models,
                                       const CompactForms* forms, const ViewCoder* coder, int num_threads);

/// Views of a model. \param mutex held while the store is read.
std::vector<View> viewsOf(ModelStore& store, const StoredModel& model, std::mutex& mutex);

}  // namespace pcl_symmetry::detail
