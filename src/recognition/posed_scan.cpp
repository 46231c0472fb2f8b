#include "recognition/posed_scan.h"

#include <algorithm>
#include <utility>

namespace pcl_symmetry::detail {

namespace {

// Ratio of the radius of a scan's bounding ball to that of the whole object. chosen: 1 would hold if every scan showed
// the longest extent; half takes the object for twice its size, so that widths in radii are too wide by that factor.
constexpr double kSeenRadius = 0.95;

}  // namespace

PosedScan::PosedScan(const Points& points, const Visibility& seen, const CloudRegistrationOptions& options)
    : options_(options),
      ball_(boundingBall(points)),
      scale_(ball_.radius / kSeenRadius),
      surface_(surfaceOf(points, ball_.center, seen.normalized(ball_.center, scale_))) {}

void PosedScan::bringTo(const std::string& name, const Points& points, const std::vector<Eigen::Isometry3d>& poses,
                        PointReader read) {
  const SearchFrames frames{ball_.center, boundingBall(points).center, scale_};
  std::vector<Eigen::Isometry3d> hypotheses;
  for (const Eigen::Isometry3d& pose : poses) hypotheses.push_back(frames.toSearch(pose));
  PoseSearchOptions search = options_.search;
  search.num_threads = options_.num_threads;
  search.num_rotations = 0;
  const PosedSurface surface = surfaceOf(points, frames.target_center, std::nullopt);
  models_.push_back({name, frames, searchPoses(surface_, surface, hypotheses, search), std::move(read)});
}

Recognition PosedScan::refined(int num_refined) {
  std::stable_sort(models_.begin(), models_.end(), [](const PosedModel& a, const PosedModel& b) {
    return a.poses.front().score.merit() > b.poses.front().score.merit();
  });
  Recognition found;
  for (const PosedModel& model : models_) {
    if (found.size() == static_cast<std::size_t>(num_refined)) break;
    const PosedSurface surface = surfaceOf(model.read(), model.frames.target_center, std::nullopt);
    const RankedPose best = refinePoses(surface_, surface, RefinementTarget(surface), model.poses, options_).front();
    found.push_back({model.name, model.frames.toInput(best.T_model_scan), best.score, 0.0});
  }
  models_.clear();
  return found;
}

PosedSurface PosedScan::surfaceOf(const Points& points, const Eigen::Vector3d& center,
                                  std::optional<Visibility> seen) const {
  return {normalizePoints(points, center, scale_), std::move(seen), options_.seed, options_.num_threads};
}

}  // namespace pcl_symmetry::detail
