#include "recognition/search/pair_search.h"

#include <algorithm>
#include <utility>

#include "core/base/parallel.h"

namespace pcl_symmetry::detail {

namespace {

// Seed of the choice of points. chosen: any number
constexpr std::uint64_t kPairSeed = 1;

}  // namespace

PairSearch::PairSearch(std::vector<StoredModel> models, const PointReader& read, const PairSearch* before,
                       int num_threads)
    : models_(std::move(models)), shapes_(models_.size()) {
  parallelBlocks(models_.size(), num_threads, [&](std::size_t i) {
    if (const SurfacePoints* known = before ? before->find(models_[i].id) : nullptr)
      shapes_[i] = *known;
    else
      shapes_[i] = evenSurfacePoints(read(models_[i]), PointPairIndex::kShapePoints, kPairSeed, 1);
  });
  index_.emplace(shapes_, num_threads);
}

const SurfacePoints* PairSearch::find(std::int64_t model) const {
  const auto found =
      std::find_if(models_.begin(), models_.end(), [&](const StoredModel& other) { return other.id == model; });
  return found == models_.end() ? nullptr : &shapes_[static_cast<std::size_t>(found - models_.begin())];
}

std::vector<ModelOfView> PairSearch::nearest(const Points& scan, const PairSearchOptions& options) const {
  const SurfacePoints points = evenSurfacePoints(scan, PointPairIndex::kScanPoints, kPairSeed, options.num_threads);
  std::vector<ModelOfView> found;
  for (ShapeOfPairs& shape : index_->nearest(points, options))
    if (!shape.T_shape_scan.empty())
      found.push_back({models_[static_cast<std::size_t>(shape.shape)], std::move(shape.T_shape_scan)});
  return found;
}

}  // namespace pcl_symmetry::detail
