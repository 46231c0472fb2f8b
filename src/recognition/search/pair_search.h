#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "core/matching/pairs/point_pair_index.h"
#include "recognition/search/view_search.h"
#include "recognition/storage/model_store.h"

namespace pcl_symmetry::detail {

/// Finds models that a scan can show by pairs of its points, see PointPairIndex: also where much of the object is
/// hidden.
class PairSearch {
public:
  /// Models of a database from which on there is no such search. chosen: the pairs of a model take 0.3 MB and 10 ms to
  /// make, each time that a database is opened; twice takes twice the memory and time.
  static constexpr std::size_t kMostModels = 300;
  /// Points of a model that give normals. chosen: half blurs edges, twice takes twice the time.
  static constexpr std::size_t kModelPoints = 5000;

  /// Reads points of a model, called by several threads at once.
  using PointReader = std::function<Points(const StoredModel&)>;

  /// \param before whose points are taken over for the models that it has; null: none.
  PairSearch(std::vector<StoredModel> models, const PointReader& read, const PairSearch* before, int num_threads);

  /// Models that have pairs as a scan has, those with most first.
  /// \param scan 3 x N, finite, N >= 1, unit of the models.
  std::vector<ModelOfView> nearest(const Points& scan, const PairSearchOptions& options) const;

private:
  const SurfacePoints* find(std::int64_t model) const;

  std::vector<StoredModel> models_;
  std::vector<SurfacePoints> shapes_;  // of the models
  std::optional<PointPairIndex> index_;
};

}  // namespace pcl_symmetry::detail
