#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "core/base/check.h"
#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "core/matching/matching_rules.h"
#include "core/matching/shape_signature.h"
#include "core/matching/view_signature.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/symmetry_database.h"
#include "recognition/database_parts.h"
#include "recognition/posed_scan.h"
#include "recognition/recognition_fit.h"

namespace pcl_symmetry {

namespace {

using detail::DatabaseParts;
using detail::kRecognition;
using detail::PosedModel;
using detail::PosedScan;
using detail::PossibleModel;
using detail::StoredModel;

/// The models with the best poses, best first, at most \p num_models, each with its best poses.
std::vector<PossibleModel> screened(const ScreenedSurface& scan, const std::vector<PossibleModel>& models,
                                    int num_models, int num_threads) {
  std::vector<PosesOfShape> poses;
  for (const PossibleModel& model : models) poses.push_back({&model.shape->screened, model.T_model_scan});
  PoseScreeningOptions options;
  options.num_shapes = num_models;
  options.num_threads = num_threads;
  std::vector<PossibleModel> best;
  for (ScreenedShape& shape : screenPoses(scan, poses, options)) {
    best.push_back(models[shape.shape]);
    best.back().T_model_scan = std::move(shape.T_shape_scan);
  }
  return best;
}

/// For each model, the first one of the same shape.
/// \param found best first.
std::vector<std::size_t> firstsOfShapes(const std::vector<PosedModel>& found) {
  std::vector<std::size_t> firsts;
  for (std::size_t i = 0; i < found.size(); ++i) {
    std::size_t first = 0;
    while (first < i &&
           (firsts[first] != first || detail::sharedSurface(found[first], found[i]) < kRecognition.same_shape))
      ++first;
    firsts.push_back(first);
  }
  return firsts;
}

/// See RecognizedModel::confidence.
/// \param found best first.
void fillConfidences(std::vector<PosedModel>& found) {
  const std::vector<std::size_t> firsts = firstsOfShapes(found);
  double sum = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double merit = found[i].model.score.merit();
    std::size_t other = 0;
    while (other < found.size() && firsts[other] == firsts[i]) ++other;
    const double rival = other < found.size() ? found[other].model.score.merit() : 0.0;
    const ModelEvidence& evidence = found[i].model.evidence;
    const double few = kRecognition.few;
    const std::array<double, kRecognitionFit.size()> terms{
        1.0, -std::log(1.0 + few - evidence.on_model),
        std::log(std::min(evidence.shown, kRecognition.most_shown) + few),
        std::min(merit - rival, kRecognition.max_lead)};
    found[i].model.confidence = logistic(std::inner_product(terms.begin(), terms.end(), kRecognitionFit.begin(), 0.0));
    if (firsts[i] == i) sum += found[i].model.confidence;
  }
  if (sum > 1.0)
    for (PosedModel& posed : found) posed.model.confidence /= sum;
}

/// Sorts models, best first, and judges them together.
void rank(std::vector<PosedModel>& found) {
  sortDescending(found, [](const PosedModel& posed) { return posed.model.score.merit(); });
  fillConfidences(found);
}

/// Models registered to the scan from poses that its views and, in a small database, pairs of its points suggest. In a
/// large database, many models look more like a scan than the one that it shows: further ones are tried if none of the
/// first is accepted.
/// \return models, best first.
std::vector<PosedModel> fitLikeViews(DatabaseParts& database, const Points& points, const Points& scan_points,
                                     const Visibility& seen, const RecognitionOptions& options) {
  const std::shared_ptr<const detail::PairSearch> pairs = database.pairs();
  const View view = viewOf(points, boundingBall(points).center - seen.viewpoint());
  const std::vector<detail::ModelOfView> alike = database.views()->nearest(
      view, pairs ? options.num_candidates : std::max(options.num_candidates, options.max_candidates),
      options.num_threads, [&](const StoredModel& model) { return database.viewsOf(model); });
  const std::vector<SurfacePoints> few =
      evenSurfacePoints(scan_points, {kMatching.num_scan_points, kMatching.num_improved_points}, 1);
  const ScreenedSurface screened_scan(few[1], seen);
  const PosedScan scan(scan_points, seen, options.num_threads);

  std::vector<PosedModel> found;
  const auto fit = [&](const std::vector<PossibleModel>& models) {
    for (const PossibleModel& model : screened(screened_scan, models, options.num_refined, options.num_threads))
      found.push_back(scan.fitModel(model.model.name, database.points(model.model, kRecognition.num_fine_points),
                                    model.T_model_scan));
    rank(found);
  };
  const auto isFound = [&] { return !found.empty() && found.front().model.confidence >= options.min_confidence; };
  const auto fitAlike = [&](std::size_t begin, std::size_t end) {
    std::vector<PossibleModel> models(end - begin);
    parallelBlocks(models.size(), options.num_threads, [&](std::size_t i) {
      const detail::ModelOfView& other = alike[begin + i];
      models[i] = {other.model, database.shape(other.model), other.T_model_scan};
    });
    fit(models);
  };
  if (pairs) {
    fit(pairs->possibleModels(few[0], alike, options.num_threads));
  } else {
    const std::size_t num_first = std::min(alike.size(), static_cast<std::size_t>(options.num_candidates));
    fitAlike(0, num_first);
    if (!isFound()) fitAlike(num_first, alike.size());
  }
  // The confidence is not computed anew after this step.
  if (isFound()) found.front() = scan.rotated(found.front());
  return found;
}

/// Models of similar shape, registered to the scan.
std::vector<PosedModel> fitLikeShapes(DatabaseParts& database, const Points& points, const Points& scan_points,
                                      const RecognitionOptions& options) {
  std::vector<PosedModel> found;
  const PosedScan scan(scan_points, std::nullopt, options.num_threads);
  for (const auto& [model, distance] : database.shapes()->nearest(points, nullptr, options.num_candidates)) {
    const Points model_points = database.points(model, kRecognition.num_scan_points);
    const CloudRegistration posed =
        registerClouds(scan_points, std::nullopt, model_points, std::nullopt, Eigen::Isometry3d::Identity(),
                       detail::quickRegistration(options.num_threads));
    found.push_back(scan.judged(model.name, model_points, posed.T_target_source));
  }
  rank(found);
  return found;
}

/// \param scan_points a smaller number of the points, for poses.
/// \param find_seen gives what the scanner saw.
template <typename FindSeen>
Recognition recognizeIn(DatabaseParts& database, const Points& points, const Points& scan_points,
                        const RecognitionOptions& options, const FindSeen& find_seen,
                        const pcl::Indices* indices = nullptr) {
  detail::withBadArguments([&] { options.validate(); });
  std::optional<Visibility> seen;
  if (points.cols() > 0) seen = detail::withBadArguments(find_seen);
  const auto recognized = [&] {
    Recognition accepted;
    for (PosedModel& posed : seen ? fitLikeViews(database, points, scan_points, *seen, options)
                                  : fitLikeShapes(database, points, scan_points, options))
      if (posed.model.confidence >= options.min_confidence) accepted.push_back(std::move(posed.model));
    return accepted;
  };
  return detail::emptyWithoutAnswer(points, recognized, indices);
}

}  // namespace

void RecognitionOptions::validate() const {
  check(num_candidates >= 1, "num_candidates", num_candidates, ">= 1");
  check(max_candidates >= 1, "max_candidates", max_candidates, ">= 1");
  check(num_refined >= 1, "num_refined", num_refined, ">= 1");
  check(min_confidence >= 0.0 && min_confidence <= 1.0, "min_confidence", min_confidence, "in [0, 1]");
  checkNumThreads(num_threads);
}

void SymmetryDatabase::prepare() const {
  parts_->views();  // by one thread, so that others can work at the same time
  parts_->pairs();
}

Recognition SymmetryDatabase::recognize(const Cloud& scan, const RecognitionOptions& options,
                                        const Viewpoint& viewpoint) const {
  detail::checkedViewpoint(viewpoint);
  const Points points = detail::finitePoints(scan, parts_->options.max_points);
  return recognizeIn(*parts_, points, detail::finitePoints(scan, kRecognition.num_scan_points), options,
                     [&] { return detail::visibilityOf(detail::findSeenSpace(scan, points, viewpoint)); });
}

Recognition SymmetryDatabase::recognize(const Cloud& scene, const pcl::Indices& cluster,
                                        const RecognitionOptions& options, const SeenSpace::ConstPtr& seen) const {
  const Points points = detail::selectPoints(scene, &cluster, parts_->options.max_points, 1).points;
  return recognizeIn(
      *parts_, points, detail::selectPoints(scene, &cluster, kRecognition.num_scan_points, 1).points, options,
      [&] { return detail::visibilityOf(seen ? *seen : SeenSpace(scene)); }, &cluster);
}

}  // namespace pcl_symmetry
