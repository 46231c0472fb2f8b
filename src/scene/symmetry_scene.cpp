#include "pcl_symmetry/symmetry_scene.h"

#include <algorithm>
#include <future>
#include <utility>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/base/stopwatch.h"
#include "pcl_symmetry/symmetry_alignment.h"
#include "pcl_symmetry/symmetry_maxima_refinement.h"
#include "scene/convex_pieces.h"
#include "scene/object_feet.h"
#include "scene/scene_parts.h"
#include "scene/support_bulge.h"

namespace pcl_symmetry {

namespace {

using Cloud = SymmetryScene::Cloud;

/// The finite points that are near enough, seen along the rays of the sensor.
pcl::Indices nearPoints(const Cloud& scene, const std::optional<Eigen::Vector3d>& viewpoint, double max_range) {
  pcl::Indices points;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    if (!pcl::isXYZFinite(scene[i])) continue;
    const Eigen::Vector3d from = viewpoint.value_or(Eigen::Vector3d::Zero());
    if (max_range > 0.0 && (scene[i].getVector3fMap().cast<double>() - from).norm() > max_range) continue;
    points.push_back(static_cast<pcl::index_t>(i));
  }
  return points;
}

/// The plane that shows most of the far side of an object.
std::optional<ReflectionPlane> completingPlane(const SceneObject& object, const Visibility* seen) {
  const bool has_plane = !object.planes.empty() && object.planes.front().kind == PlaneKind::Symmetry;
  if (!object.axes.empty() && seen) {
    const SymmetryAxis& axis = object.axes.front();
    const Eigen::Vector3d towards = seen->viewpoint() - axis.point;
    const Eigen::Vector3d across = towards - towards.dot(axis.direction) * axis.direction;
    if (across.norm() > 0.0) return ReflectionPlane(across.normalized(), across.normalized().dot(axis.point));
  }
  if (!has_plane) return std::nullopt;
  return object.planes.front();
}

/// Of one object.
class ObjectAnalysis {
public:
  /// \param found has what the sensor saw and the supporting planes.
  /// \param spacing of the points, input units.
  ObjectAnalysis(const Cloud::ConstPtr& scene, const SceneAnalysis& found, double spacing, const SceneOptions& options,
                 const SymmetryDatabase* database)
      : scene_(scene), found_(found), spacing_(spacing), options_(options), database_(database) {}

  SceneObject analyse(const pcl::Indices& cluster) {
    seen_ = std::make_shared<const SeenSpace>(
        detail::seenOfObject(*found_.seen, *scene_, found_.supports, cluster,
                             {spacing_, found_.plane_distance, found_.cluster_distance}, options_.detection.tolerance));
    SceneObject object;
    object.indices = cluster;
    findPlanes(object);
    if (!object.reason.empty()) return object;
    if (options_.frames) findFrame(object);
    if (options_.complete) complete(object);
    if (database_) object.models = database_->recognize(*scene_, cluster, options_.recognition, seen_);
    return object;
  }

private:
  template <typename Analysis>
  void prepare(Analysis& analysis, const SceneObject& object) const {
    analysis.setNumberOfThreads(options_.num_threads);
    analysis.setMaxPoints(static_cast<std::size_t>(options_.max_points));
    analysis.setInputCloud(scene_);
    analysis.setIndices(pcl::make_shared<pcl::Indices>(object.indices));
    analysis.setSeenSpace(seen_);
  }

  void findPlanes(SceneObject& object) const {
    SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
    refinement.setOptions(options_.detection);
    prepare(refinement, object);
    object.planes = refinement.compute();
    object.axes = refinement.getAxes();
    object.centers = refinement.getCenters();
    object.reason = refinement.getReason();
  }

  void findFrame(SceneObject& object) const {
    SymmetryAlignment<pcl::PointXYZ> alignment;
    FrameOptions options = options_.frame;
    options.turns = false;
    alignment.setOptions(options);
    prepare(alignment, object);
    SymmetryFrame frame = alignment.compute();
    if (!frame.equivalent.empty()) object.frame = std::move(frame);
  }

  void complete(SceneObject& object) const {
    object.completed_by = completingPlane(object, seen_->visibility());
    if (!object.completed_by) return;
    const Cloud cluster(*scene_, object.indices);
    const CompletedCloud<pcl::PointXYZ> completed =
        completeBySymmetry(cluster, *object.completed_by, options_.completion, *seen_);
    pcl::copyPointCloud(completed.cloud, completed.added, object.added);
  }

  const Cloud::ConstPtr& scene_;
  const SceneAnalysis& found_;
  SeenSpace::ConstPtr seen_;  // for the object
  const double spacing_;
  const SceneOptions& options_;
  const SymmetryDatabase* database_;
};

/// \return clusters whose objects do not touch, most points first.
std::vector<pcl::Indices> separated(const Cloud& scene, const std::vector<pcl::Indices>& clusters, double spacing,
                                    int min_points) {
  std::vector<pcl::Indices> all;
  for (const pcl::Indices& cluster : clusters)
    for (pcl::Indices& piece : detail::convexPieces(scene, cluster, spacing))
      if (piece.size() >= static_cast<std::size_t>(min_points)) all.push_back(std::move(piece));
  std::stable_sort(all.begin(), all.end(),
                   [](const pcl::Indices& a, const pcl::Indices& b) { return a.size() > b.size(); });
  return all;
}

/// \param spacing of the points, input units.
/// \return the objects of the clusters, in their order. Where there are no fewer clusters than threads, each has one.
std::vector<SceneObject> analyseObjects(const Cloud::ConstPtr& scene, const std::vector<pcl::Indices>& clusters,
                                        const SceneAnalysis& found, double spacing, const SceneOptions& options,
                                        const SymmetryDatabase* database) {
  SceneOptions of_object = options;
  int num_at_once = 1;
  if (const int num_threads = resolveNumThreads(options.num_threads);
      clusters.size() >= static_cast<std::size_t>(num_threads)) {
    num_at_once = num_threads;
    of_object.num_threads = of_object.recognition.num_threads = 1;
  }
  std::vector<SceneObject> objects(clusters.size());
  parallelBlocks(clusters.size(), num_at_once, [&](std::size_t k) {
    objects[k] = ObjectAnalysis(scene, found, spacing, of_object, database).analyse(clusters[k]);
  });
  return objects;
}

}  // namespace

void SceneOptions::validate() const {
  check(plane_distance >= 0.0, "plane_distance", plane_distance, ">= 0");
  check(cluster_distance >= 0.0, "cluster_distance", cluster_distance, ">= 0");
  check(min_points >= 20, "min_points", min_points, ">= 20");
  check(max_range >= 0.0, "max_range", max_range, ">= 0");
  check(max_points >= 100, "max_points", max_points, ">= 100");
  detection.validate();
  frame.validate();
  completion.validate();
  recognition.validate();
  checkNumThreads(num_threads);
}

void SymmetryScene::setOptions(const SceneOptions& options) {
  detail::changeOptions(options_, [&](SceneOptions& changed) { changed = options; });
}

SceneAnalysis SymmetryScene::compute() const {
  SceneAnalysis analysis;
  Stopwatch watch;
  const auto timed = [&](const char* stage) { analysis.timing_ms.emplace_back(stage, watch.lap()); };
  Cloud::ConstPtr frame = input_;
  if (frame) analysis.seen = std::make_shared<const SeenSpace>(*frame, viewpoint_);
  const double seen_ms = watch.lap();
  // What the database reads is ready when the clusters are: planes are searched for by one thread.
  std::future<void> prepared;
  if (database_ && analysis.seen && analysis.seen->visibility() && resolveNumThreads(options_.num_threads) > 1)
    prepared = std::async(std::launch::async, [&] { database_->prepare(); });
  if (frame && options_.filter) frame = withoutDepthErrors(frame, *analysis.seen, options_.num_threads);
  if (frame != input_) analysis.seen = std::make_shared<const SeenSpace>(*frame, viewpoint_);
  std::optional<Eigen::Vector3d> viewpoint;
  if (analysis.seen && analysis.seen->visibility()) viewpoint = analysis.seen->visibility()->viewpoint();
  const pcl::Indices points = frame ? nearPoints(*frame, viewpoint, options_.max_range) : pcl::Indices();
  if (points.empty()) {
    detail::warnOfNoAnswer("SymmetryScene", input_ ? "scene: no finite point" : "scene: not set");
    return analysis;
  }
  analysis.timing_ms = {{"seen_space", seen_ms}, {"filter", watch.lap()}};
  // The filter leaves the bends of a camera's picture: the distances follow from the frame as it was.
  const detail::SceneDistances distances = detail::sceneDistances(*input_, points);
  analysis.plane_distance = options_.plane_distance > 0.0 ? options_.plane_distance : distances.plane;
  analysis.cluster_distance = options_.cluster_distance > 0.0 ? options_.cluster_distance : distances.cluster;
  if (!(analysis.plane_distance > 0.0 && analysis.cluster_distance > 0.0)) {
    detail::warnOfNoAnswer("SymmetryScene", "scene: all points at one place");
    return analysis;
  }
  analysis.supports = detail::findSupports(frame, points, viewpoint, analysis.plane_distance);
  timed("supports");
  const pcl::Indices rest = detail::withoutSupports(points, analysis.supports, frame->size());
  std::vector<pcl::Indices> clusters = detail::findClusters(frame, rest, analysis.supports, analysis.plane_distance,
                                                            analysis.cluster_distance, options_.min_points);
  if (options_.separate) clusters = separated(*frame, clusters, distances.spacing, options_.min_points);
  detail::returnFeet(frame, analysis.supports, clusters, distances.spacing, analysis.cluster_distance);
  const auto is_bulge = [&](const pcl::Indices& cluster) {
    return detail::isBulge(*frame, cluster, analysis.supports, options_.detection.tolerance, analysis.cluster_distance);
  };
  clusters.erase(std::remove_if(clusters.begin(), clusters.end(), is_bulge), clusters.end());
  timed("clusters");
  if (database_ && !clusters.empty() && viewpoint) {
    prepared.valid() ? prepared.get() : database_->prepare();
    timed("database");
  }
  analysis.objects = analyseObjects(frame, clusters, analysis, distances.spacing, options_, database_.get());
  timed("objects");
  return analysis;
}

}  // namespace pcl_symmetry
