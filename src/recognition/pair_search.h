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

/// Points of a model, drawn at random from those that are stored.
struct ModelPoints {
  Points fine, coarse;  ///< by which poses are judged, and searched
};

/// Finds models that a scan can show, also where much of the object is hidden: by poses that pairs of its points
/// suggest, see PointPairIndex, and that are tried, see screenPoses().
class PairSearch {
public:
  /// Reads points of a model, called by several threads at once.
  using PointReader = std::function<ModelPoints(const StoredModel&)>;

  /// \param before whose points are taken over for the models that it has; null: none.
  PairSearch(std::vector<StoredModel> models, const PointReader& read, const PairSearch* before, int num_threads);

  /// Models that have poses in which they fit a scan best, best first. Poses that pairs of points suggest are tried for
  /// all models.
  /// \param scan 3 x N, finite, N >= 1, unit of the models.
  /// \param seen what the scanner saw.
  /// \param others more poses to try.
  std::vector<ModelOfView> nearest(const Points& scan, const Visibility& seen, const std::vector<ModelOfView>& others,
                                   const PoseScreeningOptions& options) const;

  /// The points that were read of one of the models; null of another one.
  const ModelPoints* pointsOf(const StoredModel& model) const;

private:
  /// What is kept of a model.
  struct Shape {
    ModelPoints points;
    SurfacePoints of_pairs;
    ScreenedSurface screened;
  };

  std::size_t indexOf(std::int64_t model) const;

  std::vector<StoredModel> models_;
  std::vector<std::shared_ptr<const Shape>> shapes_;  // of the models
  std::optional<PointPairIndex> index_;
};

}  // namespace pcl_symmetry::detail
