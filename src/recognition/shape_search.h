#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/matching/compact_index.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/visibility.h"
#include "recognition/fitted_forms.h"
#include "recognition/model_store.h"

namespace pcl_symmetry::detail {

/// Finds models of similar shape by their compact forms.
class ShapeSearch {
public:
  /// Reads the compact forms of all models, and makes those that are missing.
  /// \param stored what is fitted in the store.
  /// \throws pcl::IOException naming file and reason.
  ShapeSearch(ModelStore& store, const FittedForms& stored, const DatabaseOptions& options);

  struct Found {
    StoredModel model;
    double distance;  ///< see ModelMatch
  };
  /// Models of similar shape, nearest first.
  /// \param points 3 x N, finite, input units, at least two different ones.
  /// \param seen what a scanner saw; null = the points show the object from all sides.
  /// \param num_nearest >= 0.
  std::vector<Found> nearest(const Points& points, const Visibility* seen, int num_nearest) const;

private:
  void makeIndex(ModelStore& store, std::int64_t stored, const DatabaseOptions& options);

  int num_threads_;
  std::shared_ptr<const CompactForms> forms_;  // null: there are no models
  std::vector<StoredModel> models_;            // in the order of the index
  CompactIndex index_;
};

}  // namespace pcl_symmetry::detail
