#include "recognition/pair_search.h"

#include <algorithm>
#include <utility>

#include "core/base/parallel.h"

namespace pcl_symmetry::detail {

PairSearch::PairSearch(std::vector<StoredModel> models, const ShapeReader& read, const PairSearch* before,
                       int num_threads)
    : models_(std::move(models)), shapes_(models_.size()) {
  parallelBlocks(models_.size(), num_threads, [&](std::size_t i) {
    const std::size_t known = before ? before->indexOf(models_[i].id) : 0;
    shapes_[i] = before && known < before->shapes_.size() ? before->shapes_[known] : read(models_[i]);
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

std::vector<PossibleModel> PairSearch::possibleModels(const SurfacePoints& scan, const std::vector<ModelOfView>& others,
                                                      int num_threads) const {
  std::vector<PossibleModel> models;
  for (std::size_t i = 0; i < models_.size(); ++i) models.push_back({models_[i], shapes_[i], {}});
  PairSearchOptions by_pairs;
  by_pairs.num_nearest = index_->numShapes();
  by_pairs.num_poses = kRecognition.num_pair_poses;
  by_pairs.num_threads = num_threads;
  for (ShapeOfPairs& shape : index_->nearest(scan, by_pairs))
    models[shape.shape].T_model_scan = std::move(shape.T_shape_scan);
  for (const ModelOfView& other : others) {
    const std::size_t i = indexOf(other.model.id);
    if (i == models.size()) continue;
    auto& poses = models[i].T_model_scan;
    poses.insert(poses.end(), other.T_model_scan.begin(), other.T_model_scan.end());
  }
  return models;
}

}  // namespace pcl_symmetry::detail
