#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/recognition/symmetry_database.h"

namespace pcl_symmetry {

namespace {

constexpr double kSeenRadius = 0.95;         // of a scan's bounding ball, of that of its whole object, typically
constexpr double kMeritSharpness = 20.0;     // of the soft maximum of merits
constexpr std::size_t kScanPoints = 10'000;  // that are brought to a model ...
constexpr std::size_t kModelPoints = 5'000;  // ... of so many

/// A scan from a viewpoint that is brought to many models: all are searched for poses, the best are refined.
class PosedScan {
public:
  PosedScan(const Points& points, const Visibility& seen, const CloudRegistrationOptions& options)
      : options_(options),
        ball_(boundingBall(points)),
        scale_(ball_.radius / kSeenRadius),
        surface_(surfaceOf(points, ball_.center, seen.normalized(ball_.center, scale_))) {}

  /// \param poses T_model_scan to try.
  void bringTo(const std::string& name, const Points& points, const std::vector<Eigen::Isometry3d>& poses) {
    const SearchFrames frames{ball_.center, boundingBall(points).center, scale_};
    std::vector<Eigen::Isometry3d> hypotheses;
    for (const Eigen::Isometry3d& pose : poses) hypotheses.push_back(frames.toSearch(pose));
    PoseSearchOptions search = options_.search;
    search.num_threads = options_.num_threads;
    search.num_rotations = 0;
    PosedSurface surface = surfaceOf(points, frames.target_center, std::nullopt);
    std::vector<RankedPose> found = searchPoses(surface_, surface, hypotheses, search);
    models_.push_back({name, frames, std::move(surface), std::move(found)});
  }

  /// \return the \p num_refined models with the best poses, in any order.
  Recognition refined(int num_refined) {
    std::stable_sort(models_.begin(), models_.end(), [](const PosedModel& a, const PosedModel& b) {
      return a.poses.front().score.merit() > b.poses.front().score.merit();
    });
    Recognition found;
    for (const PosedModel& model : models_) {
      if (found.size() == static_cast<std::size_t>(num_refined)) break;
      const RankedPose best = refinePoses(surface_, model.surface, model.poses, options_);
      found.push_back({model.name, model.frames.toInput(best.T_model_scan), best.score, 0.0});
    }
    return found;
  }

private:
  struct PosedModel {
    std::string name;
    SearchFrames frames;
    PosedSurface surface;
    std::vector<RankedPose> poses;
  };

  PosedSurface surfaceOf(const Points& points, const Eigen::Vector3d& center, std::optional<Visibility> seen) const {
    return {normalizePoints(points, center, scale_), std::move(seen), options_.seed, options_.num_threads};
  }

  CloudRegistrationOptions options_;
  BoundingBall ball_;
  double scale_;
  PosedSurface surface_;
  std::vector<PosedModel> models_;
};

/// Best first, with confidences.
void rank(Recognition& found, double min_merit) {
  std::stable_sort(found.begin(), found.end(), [](const RecognizedModel& a, const RecognizedModel& b) {
    return a.score.merit() > b.score.merit();
  });
  double sum = 0.0;
  for (const RecognizedModel& model : found) sum += std::exp(kMeritSharpness * model.score.merit());
  for (RecognizedModel& model : found) {
    const double merit = model.score.merit();
    const double above = min_merit < 1.0 ? (merit - min_merit) / (1.0 - min_merit) : 1.0;
    model.confidence = std::exp(kMeritSharpness * merit) / sum * std::sqrt(std::clamp(above, 0.0, 1.0));
  }
}

}  // namespace

CloudRegistrationOptions RecognitionOptions::quickRegistration() {
  CloudRegistrationOptions options;
  options.frame = signatureFrameOptions();
  options.search.num_rotations = 200;
  options.search.num_screened = 16;
  options.search.num_refined = 6;
  options.search.max_poses = 2;
  return options;
}

void RecognitionOptions::validate() const {
  check(num_candidates >= 1, "num_candidates", num_candidates, ">= 1");
  check(num_refined >= 1, "num_refined", num_refined, ">= 1");
  check(size_weight >= 0.0, "size_weight", size_weight, ">= 0");
  check(min_merit >= -1.0 && min_merit <= 1.0, "min_merit", min_merit, "in [-1, 1]");
  check(num_threads >= 0, "num_threads", num_threads, ">= 0");
  registration.validate();
}

/// Candidates look like the scan from some side, and in some poses.
Recognition SymmetryDatabase::recognizeView(const Points& points, const Points& scan, const Visibility& seen,
                                            const RecognitionOptions& options,
                                            const CloudRegistrationOptions& registration) const {
  const BoundingBall ball = boundingBall(points);
  if (!(ball.radius > 0.0)) throw std::invalid_argument("scan: no extent, must have different finite points");
  ViewSearchOptions search;
  search.num_nearest = options.num_candidates;
  search.size_weight = options.size_weight;
  search.num_threads = options.num_threads;
  PosedScan posed(scan, seen, registration);
  for (const ShapeOfView& shape : view_index_.nearest(viewOf(points, ball.center - seen.viewpoint()), search)) {
    const std::string& name = indexed_[static_cast<std::size_t>(shape.shape)];
    posed.bringTo(name, detail::selectPoints(cloud(name), nullptr, kModelPoints, 1).points, shape.T_shape_scan);
  }
  return posed.refined(options.num_refined);
}

/// Candidates are of like shape.
Recognition SymmetryDatabase::recognizeWhole(const Points& points, const Points& scan,
                                             const RecognitionOptions& options,
                                             const CloudRegistrationOptions& registration) const {
  Recognition found;
  for (const auto& [model, distance] : nearest(points, nullptr, options.num_candidates)) {
    const std::string& name = indexed_[static_cast<std::size_t>(model)];
    const CloudRegistration posed =
        registerClouds(scan, std::nullopt, detail::selectPoints(cloud(name), nullptr, kScanPoints, 1).points,
                       std::nullopt, Eigen::Isometry3d::Identity(), registration);
    found.push_back({name, posed.T_target_source, posed.score, 0.0});
  }
  return found;
}

Recognition SymmetryDatabase::recognize(const Cloud& scan, const RecognitionOptions& options,
                                        const Viewpoint& viewpoint) const {
  return detail::withBadArguments([&] {
    options.validate();
    const Points points = detail::selectPoints(scan, nullptr, options_.max_points, 1).points;
    const Points scan_points = detail::selectPoints(scan, nullptr, kScanPoints, 1).points;
    const std::optional<Visibility> seen = detail::seenSpace(scan, points, viewpoint);
    CloudRegistrationOptions registration = options.registration;
    registration.num_threads = options.num_threads;
    Recognition found = seen ? recognizeView(points, scan_points, *seen, options, registration)
                             : recognizeWhole(points, scan_points, options, registration);
    found.erase(std::remove_if(found.begin(), found.end(),
                               [&](const RecognizedModel& model) { return model.score.merit() < options.min_merit; }),
                found.end());
    rank(found, options.min_merit);
    return found;
  });
}

}  // namespace pcl_symmetry
