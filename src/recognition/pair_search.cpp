#include "recognition/pair_search.h"

#include <algorithm>
#include <utility>

#include "core/base/parallel.h"

namespace pcl_symmetry::detail {

PairSearch::PairSearch(std::vector<StoredModel> models, const PointReader& read, const PairSearch* before,
                       int num_threads)
    : models_(std::move(models)), shapes_(models_.size()) {
  parallelBlocks(models_.size(), num_threads, [&](std::size_t i) {
    const std::size_t known = before ? before->indexOf(models_[i].id) : 0;
    if (before && known < before->shapes_.size()) {
      shapes_[i] = before->shapes_[known];
      return;
    }
    ModelPoints points = read(models_[i]);
    std::vector<SurfacePoints> few =
        evenSurfacePoints(points.fine, {kMatching.num_pair_points, kMatching.num_screened_points}, 1);
    shapes_[i] = std::make_shared<const Shape>(Shape{std::move(points), std::move(few[0]), ScreenedSurface(few[1])});
  });
  std::vector<SurfacePoints> of_pairs;
  for (const auto& shape : shapes_) of_pairs.push_back(shape->of_pairs);
  index_.emplace(of_pairs, num_threads);
}

std::size_t PairSearch::indexOf(std::int64_t model) const {
  return static_cast<std::size_t>(
      std::find_if(models_.begin(), models_.end(), [&](const StoredModel& other) { return other.id == model; }) -
      models_.begin());
}

const ModelPoints* PairSearch::pointsOf(const StoredModel& model) const {
  const std::size_t i = indexOf(model.id);
  return i < shapes_.size() ? &shapes_[i]->points : nullptr;
}

std::vector<ModelOfView> PairSearch::nearest(const Points& scan, const Visibility& seen,
                                             const std::vector<ModelOfView>& others,
                                             const PoseScreeningOptions& options) const {
  const SurfacePoints points = evenSurfacePoints(scan, kMatching.num_scan_points, 1);
  std::vector<PosesOfShape> poses;
  for (const auto& shape : shapes_) poses.push_back({&shape->screened, {}});
  const auto add = [&](std::size_t model, const std::vector<Eigen::Isometry3d>& more) {
    auto& all = poses[model].T_shape_scan;
    all.insert(all.end(), more.begin(), more.end());
  };
  PairSearchOptions by_pairs;
  by_pairs.num_nearest = index_->numShapes();
  by_pairs.num_poses = kRecognition.num_pair_poses;
  by_pairs.num_threads = options.num_threads;
  for (const ShapeOfPairs& shape : index_->nearest(points, by_pairs))
    add(static_cast<std::size_t>(shape.shape), shape.T_shape_scan);
  for (const ModelOfView& other : others)
    if (const std::size_t model = indexOf(other.model.id); model < poses.size()) add(model, other.T_model_scan);
  std::vector<ModelOfView> found;
  for (ScreenedShape& shape : screenPoses(ScreenedSurface(points, seen), poses, options))
    found.push_back({models_[shape.shape], std::move(shape.T_shape_scan)});
  return found;
}

}  // namespace pcl_symmetry::detail
