#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/matching/compact_index.h"
#include "pcl_symmetry/core/geometry/point_set.h"
#include "pcl_symmetry/core/scan/visibility.h"
#include "recognition/search/compact_forms.h"
#include "recognition/storage/model_store.h"

namespace pcl_symmetry::detail {

/// A projection with the number that it is stored under, 0: it is not stored.
struct NumberedForms {
  std::int64_t id = 0;
  std::shared_ptr<const CompactForms> forms;
};

/// True where there are no references, or less than half of those that would be taken now.
bool isOutgrown(std::size_t num_references, std::size_t num_models, int max_references);

/// Fits compact forms to the signatures of up to \p max_references models, spread evenly over all.
/// \throws pcl::IOException, std::invalid_argument where all models are alike.
std::shared_ptr<const CompactForms> fitForms(ModelStore& store, int max_references, int num_threads);

/// Makes the forms of some models, on several threads.
/// \throws pcl::IOException.
std::vector<PackedForms> formsOfModels(ModelStore& store, const std::vector<StoredModel>& models,
                                       const CompactForms& forms, int num_threads);

/// Finds models of like shape by their compact forms.
class ShapeSearch {
public:
  /// Reads the compact forms of all models, and makes those that are missing.
  /// \param stored the projection of the store.
  /// \throws pcl::IOException naming file and reason.
  ShapeSearch(ModelStore& store, NumberedForms stored, const DatabaseOptions& options);

  struct Found {
    StoredModel model;
    double distance;  ///< see ModelMatch
  };
  /// Models of like shape, nearest first.
  /// \param points 3 x N, finite, input units, at least two different ones.
  /// \param seen what a scanner saw; null = the points show the object from all sides.
  /// \param num_nearest >= 0.
  std::vector<Found> nearest(const Points& points, const Visibility* seen, int num_nearest) const;

private:
  int num_threads_;
  std::shared_ptr<const CompactForms> forms_;  // null: there are no models
  std::vector<StoredModel> models_;            // in the order of the index
  CompactIndex index_;
};

}  // namespace pcl_symmetry::detail
