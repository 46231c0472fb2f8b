#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/check.h"
#include "core/descriptors/shape_signature.h"
#include "core/views/view_signature.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/recognition/symmetry_database.h"
#include "recognition/database_parts.h"
#include "recognition/posed_scan.h"

namespace pcl_symmetry {

namespace {

using detail::DatabaseParts;
using detail::PosedScan;
using detail::StoredModel;

// Exponent of the soft maximum of merits. chosen: a merit that is 0.05 lower counts 1 / e; half the value spreads the
// confidence over similar models, twice gives it to the best one alone.
constexpr double kMeritSharpness = 20.0;
// Points of the scan and of a model that poses are judged by. chosen: time grows with them; half loses accuracy of the
// pose, twice gains little as fine steps use a few hundred points.
constexpr std::size_t kScanPoints = 10'000;
constexpr std::size_t kModelPoints = 5'000;  // chosen: see above
// Points of a model that its poses are searched by. measured: of 119 scans of models of the Princeton Shape Benchmark
// (fold 0 of the training half) among 100 000 models, 103 are right with 1250 and with 5000, in 0.38 and 0.49 s.
constexpr std::size_t kCoarsePoints = 1'250;

/// Models that look like the scan from some side, brought to it from the poses of these views: the most alike first,
/// and others where none of these is accepted. In a large database many look more like a scan than the model that it
/// shows.
Recognition fitLikeViews(DatabaseParts& database, const Points& points, const Points& scan_points,
                         const Visibility& seen, const RecognitionOptions& options) {
  ViewSearchOptions search;
  search.num_nearest = std::max(options.num_candidates, options.max_candidates);
  search.size_weight = options.size_weight;
  search.num_threads = options.num_threads;
  const View view = viewOf(points, boundingBall(points).center - seen.viewpoint());
  PosedScan scan(scan_points, seen, options.registration);
  const auto read = [&](const StoredModel& model) { return database.viewsOf(model); };
  const std::vector<detail::ModelOfView> candidates = database.views()->nearest(view, search, read);
  const std::size_t first = std::min(candidates.size(), static_cast<std::size_t>(options.num_candidates));
  const auto fitted = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const StoredModel& model = candidates[i].model;
      scan.bringTo(model.name, database.points(model, kCoarsePoints), candidates[i].T_model_scan,
                   [&] { return database.points(model, kModelPoints); });
    }
    return scan.refined(options.num_refined);
  };
  const auto isAccepted = [&](const RecognizedModel& model) { return model.score.merit() >= options.min_merit; };
  Recognition found = fitted(0, first);
  if (std::none_of(found.begin(), found.end(), isAccepted)) found = fitted(first, candidates.size());
  return found;
}

/// Models of like shape, registered to the scan.
Recognition fitLikeShapes(DatabaseParts& database, const Points& points, const Points& scan_points,
                          const RecognitionOptions& options) {
  Recognition found;
  for (const auto& [model, distance] : database.shapes()->nearest(points, nullptr, options.num_candidates)) {
    const Points model_points = database.points(model, kScanPoints);
    const CloudRegistration posed = registerClouds(scan_points, std::nullopt, model_points, std::nullopt,
                                                   Eigen::Isometry3d::Identity(), options.registration);
    found.push_back({model.name, posed.T_target_source, posed.score, 0.0});
  }
  return found;
}

/// Drops poses whose merit is too low and sorts the others, best first.
void keepFitting(Recognition& found, double min_merit) {
  found.erase(std::remove_if(found.begin(), found.end(),
                             [&](const RecognizedModel& model) { return model.score.merit() < min_merit; }),
              found.end());
  std::stable_sort(found.begin(), found.end(), [](const RecognizedModel& a, const RecognizedModel& b) {
    return a.score.merit() > b.score.merit();
  });
}

/// See RecognizedModel::confidence.
void fillConfidences(Recognition& found, double min_merit) {
  double sum = 0.0;
  for (const RecognizedModel& model : found) sum += std::exp(kMeritSharpness * model.score.merit());
  for (RecognizedModel& model : found) {
    const double merit = model.score.merit();
    const double above = min_merit < 1.0 ? (merit - min_merit) / (1.0 - min_merit) : 1.0;
    model.confidence = std::exp(kMeritSharpness * merit) / sum * std::sqrt(std::clamp(above, 0.0, 1.0));
  }
}

/// \param scan_points fewer of the points, for poses.
/// \param find_seen gives what the scanner saw.
template <typename FindSeen>
Recognition recognizeIn(DatabaseParts& database, const Points& points, const Points& scan_points,
                        const RecognitionOptions& options, const FindSeen& find_seen) {
  RecognitionOptions used = options;
  used.registration.num_threads = options.num_threads;
  detail::withBadArguments([&] { used.validate(); });
  return detail::emptyWithoutAnswer(points, [&] {
    const std::optional<Visibility> seen = detail::withBadArguments(find_seen);
    Recognition found = seen ? fitLikeViews(database, points, scan_points, *seen, used)
                             : fitLikeShapes(database, points, scan_points, used);
    keepFitting(found, options.min_merit);
    fillConfidences(found, options.min_merit);
    return found;
  });
}

}  // namespace

CloudRegistrationOptions RecognitionOptions::quickRegistration() {
  // chosen: a fifth to a third of the defaults of the search, as candidates come with poses or frames of their own.
  // Half misses poses, twice takes twice the time.
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
  check(max_candidates >= 1, "max_candidates", max_candidates, ">= 1");
  check(num_refined >= 1, "num_refined", num_refined, ">= 1");
  check(size_weight >= 0.0, "size_weight", size_weight, ">= 0");
  check(min_merit >= -1.0 && min_merit <= 1.0, "min_merit", min_merit, "in [-1, 1]");
  checkNumThreads(num_threads);
  registration.validate();
}

Recognition SymmetryDatabase::recognize(const Cloud& scan, const RecognitionOptions& options,
                                        const Viewpoint& viewpoint) const {
  const Points points = detail::finitePoints(scan, parts_->options.max_points);
  return recognizeIn(*parts_, points, detail::finitePoints(scan, kScanPoints), options,
                     [&] { return detail::seenSpace(scan, points, viewpoint); });
}

Recognition SymmetryDatabase::recognize(const Cloud& scene, const pcl::Indices& cluster,
                                        const RecognitionOptions& options, const SeenSpace::ConstPtr& seen) const {
  const Points points = detail::selectPoints(scene, &cluster, parts_->options.max_points, 1).points;
  return recognizeIn(*parts_, points, detail::selectPoints(scene, &cluster, kScanPoints, 1).points, options,
                     [&] { return detail::visibilityOf(seen ? *seen : SeenSpace(scene)); });
}

std::vector<Recognition> SymmetryDatabase::recognize(const std::vector<Cloud>& clusters,
                                                     const RecognitionOptions& options, const Viewpoint& viewpoint,
                                                     const BuildProgress& progress) const {
  std::vector<Recognition> found(clusters.size());
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    found[i] = recognize(clusters[i], options, viewpoint);
    if (progress && !progress(static_cast<double>(i + 1) / static_cast<double>(clusters.size()))) break;
  }
  return found;
}

}  // namespace pcl_symmetry
