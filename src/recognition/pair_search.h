#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/matching/point_pair_index.h"
#include "core/matching/pose_screening.h"
#include "recognition/model_store.h"
#include "recognition/recognition_rules.h"
#include "recognition/view_search.h"

namespace pcl_symmetry::detail {

/// A few points of a model, spread evenly.
struct ModelShape {
  SurfacePoints of_pairs;    ///< that pairs are made of
  ScreenedSurface screened;  ///< that poses are screened by
};

/// A model that a scan may show, and how it may lie there.
struct PossibleModel {
  StoredModel model;
  std::shared_ptr<const ModelShape> shape;
  std::vector<Eigen::Isometry3d> T_model_scan;
};

/// Finds models that a scan can show, also where much of the object is hidden, by poses that pairs of its points
/// suggest, see PointPairIndex.
class PairSearch {
public:
  /// Reads a model, called by several threads at once.
  using ShapeReader = std::function<std::shared_ptr<const ModelShape>(const StoredModel&)>;

  /// \param before whose shapes are taken over for the models that it has; null: none.
  PairSearch(std::vector<StoredModel> models, const ShapeReader& read, const PairSearch* before, int num_threads);

  /// All models, each with the poses that pairs of points suggest.
  /// \param scan few points, unit of the models.
  /// \param others more poses.
  std::vector<PossibleModel> possibleModels(const SurfacePoints& scan, const std::vector<ModelOfView>& others,
                                            int num_threads) const;

private:
  std::size_t indexOf(std::int64_t model) const;

  std::vector<StoredModel> models_;
  std::vector<std::shared_ptr<const ModelShape>> shapes_;  // of the models
  std::optional<PointPairIndex> index_;
};

}  // namespace pcl_symmetry::detail
