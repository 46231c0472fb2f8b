#include "pcl_symmetry/symmetry_scene.h"

#include <algorithm>
#include <functional>
#include <future>
#include <sstream>
#include <utility>

#include "core/base/check.h"
#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/base/stopwatch.h"
#include "core/geometry/point_samples.h"
#include "pcl_symmetry/symmetry_alignment.h"
#include "pcl_symmetry/symmetry_maxima_refinement.h"
#include "scene/convex_pieces.h"
#include "scene/scene_parts.h"
#include "scene/scene_rules.h"
#include "scene/symmetric_joining.h"

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

/// What the sensor of a frame saw. A frame was seen from its viewpoint by definition: if rows and columns do not show
/// one, and none is given, it is the viewpoint stored with the frame, even amid the points.
SeenSpace::ConstPtr seenSpaceOf(const Cloud& frame, const Viewpoint& viewpoint) {
  if (viewpoint.mode == Viewpoint::Mode::Auto) {
    const Viewpoint stored{Viewpoint::Mode::Given, frame.sensor_origin_.head<3>().cast<double>()};
    const bool has_points = std::any_of(frame.begin(), frame.end(), [&](const pcl::PointXYZ& point) {
      return pcl::isXYZFinite(point) && point.getVector3fMap() != frame.sensor_origin_.head<3>();
    });
    if (!frame.isOrganized() && has_points)
      return std::make_shared<const SeenSpace>(*SeenSpace(frame, stored).visibility(), ViewpointSource::Stored);
  }
  return std::make_shared<const SeenSpace>(frame, viewpoint);
}

/// Planes that may show the far side of an object: the best one, and others that are nearly certain. If the best one
/// lies along the view and adds nothing, a less certain one would often add points beside the object.
std::vector<ReflectionPlane> completingPlanes(const SceneObject& object, const Visibility* seen) {
  if (seen)
    if (const auto plane = planeAcrossView(object, seen->viewpoint())) return {*plane};
  std::vector<ReflectionPlane> planes;
  for (const SymmetryPlane& plane : object.planes)
    if (plane.kind == PlaneKind::Symmetry && (planes.empty() || plane.confidence >= detail::kScene.sure))
      planes.push_back(plane);
  return planes;
}

/// Whether all four borders of an image are empty, and supporting planes are slices of a curved body.
bool isCutOut(const Cloud& scene, const SceneAnalysis& found) {
  constexpr unsigned border = 50;  // one row or column in this many
  if (!scene.isOrganized()) return false;
  for (const SupportingPlane& support : found.supports) {
    double sum = 0.0;
    for (const int i : support.indices) {
      const double distance = support.coefficients.dot(scene[i].getVector3fMap().cast<double>().homogeneous());
      sum += distance * distance;
    }
    if (std::sqrt(sum / static_cast<double>(support.indices.size())) < detail::kScene.curved * found.plane_distance)
      return false;
  }
  const unsigned rows = scene.height / border, columns = scene.width / border;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const std::size_t u = i % scene.width, v = i / scene.width;
    const bool is_inside = u > columns && u + columns + 1 < scene.width && v > rows && v + rows + 1 < scene.height;
    if (!is_inside && pcl::isXYZFinite(scene[i])) return false;
  }
  return true;
}

/// Evidence for a single object: a table, a floor or a wall is wider than what it carries, and than the image.
std::string signOfOneObject(const Cloud& scene, const SceneAnalysis& found) {
  if (isCutOut(scene, found)) return "no point is near the border of the picture";
  if (found.supports.empty()) return "no supporting plane (table, floor, wall) was found";
  if (found.objects.empty()) return "no object was found";
  if (found.objects.size() > 1) return "";
  const auto radius = [&](const pcl::Indices& part) { return boundingBall(detail::pointsOf(scene, part)).radius; };
  const double width = detail::kScene.wider * radius(found.objects.front().indices);
  const bool has_wide = std::any_of(found.supports.begin(), found.supports.end(),
                                    [&](const SupportingPlane& support) { return radius(support.indices) > width; });
  return has_wide ? "" : "no supporting plane is much wider than the object";
}

/// Analyzes single objects.
class ObjectAnalysis {
public:
  /// \param found what the sensor saw, and the supporting planes.
  ObjectAnalysis(const Cloud::ConstPtr& scene, const SceneAnalysis& found, const detail::SceneDistances& distances,
                 SceneOptions options, const SymmetryDatabase* database)
      : scene_(scene), found_(found), distances_(distances), options_(std::move(options)), database_(database) {}

  SeenSpace seenOf(const pcl::Indices& object) const {
    return detail::seenOfObject(*found_.seen, *scene_, found_.supports, object, distances_,
                                options_.detection.tolerance);
  }

  SceneObject withPlanes(const pcl::Indices& indices) const {
    SceneObject object;
    object.indices = indices;
    SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
    DetectionOptions detection = options_.detection;
    detection.folds = false;  // objects have planes, axes of revolution and centers
    refinement.setOptions(detection);
    prepare(refinement, object, std::make_shared<const SeenSpace>(seenOf(indices)));
    refinement.compute();
    static_cast<Detection&>(object) = refinement.getDetection();
    object.map = {};  // it is large, and not part of the result
    object.reason = refinement.getReason();
    return object;
  }

  /// Adds what follows from the planes.
  void finish(SceneObject& object) const {
    if (database_) object.model_reason = object.reason;
    if (!object.reason.empty()) return;
    const auto seen = std::make_shared<const SeenSpace>(seenOf(object.indices));
    if (options_.frames) findFrame(object, seen);
    if (options_.complete) complete(object, *seen);
    if (database_ && object.models.empty()) recognize(object);
    if (!database_ || !object.models.empty()) return;
    std::ostringstream reason;
    reason << "none of " << database_->size() << " reaches a confidence of " << options_.recognition.min_confidence;
    object.model_reason = database_->size() > 0 ? reason.str() : "the database is empty";
  }

  /// \return whether a model of the database is accepted.
  bool recognize(SceneObject& object) const {
    const SeenSpace of_model = detail::seenOfModel(*found_.seen, *scene_, found_.supports, object.indices, distances_);
    object.models = database_->recognize(*scene_, object.indices, options_.recognition,
                                         std::make_shared<const SeenSpace>(of_model));
    const double accepted = std::max(options_.recognition.min_confidence, RecognitionOptions().min_confidence);
    return !object.models.empty() && object.models.front().confidence >= accepted;
  }

private:
  template <typename Analysis>
  void prepare(Analysis& analysis, const SceneObject& object, const SeenSpace::ConstPtr& seen) const {
    analysis.setNumberOfThreads(options_.num_threads);
    analysis.setMaxPoints(static_cast<std::size_t>(options_.max_points));
    analysis.setInputCloud(scene_);
    analysis.setIndices(pcl::make_shared<pcl::Indices>(object.indices));
    analysis.setSeenSpace(seen);
  }

  void findFrame(SceneObject& object, const SeenSpace::ConstPtr& seen) const {
    SymmetryAlignment<pcl::PointXYZ> alignment;
    FrameOptions options = options_.frame;
    options.rotations = options.probabilities = false;
    alignment.setOptions(options);
    prepare(alignment, object, seen);
    SymmetryFrame frame = alignment.compute();
    if (frame.equivalent.empty()) return;
    bringToSymmetry(object, frame);
    object.frame = std::move(frame);
  }

  void complete(SceneObject& object, const SeenSpace& seen) const {
    const Cloud cluster(*scene_, object.indices);
    for (const ReflectionPlane& plane : completingPlanes(object, seen.visibility())) {
      const CompletedCloud<pcl::PointXYZ> completed = completeBySymmetry(cluster, plane, options_.completion, seen);
      if (object.completed_by && completed.added.size() <= object.added.size()) continue;
      object.completed_by = plane;
      pcl::copyPointCloud(completed.cloud, completed.added, object.added);
    }
  }

  const Cloud::ConstPtr& scene_;
  const SceneAnalysis& found_;
  const detail::SceneDistances& distances_;
  const SceneOptions options_;
  const SymmetryDatabase* database_;
};

/// Pieces of clusters.
struct Pieces {
  std::vector<pcl::Indices> indices;  // most points first
  std::vector<int> cluster_of;
};

Pieces piecesOf(const Cloud& scene, const std::vector<pcl::Indices>& clusters,
                const std::optional<Eigen::Vector3d>& viewpoint, double spacing, const SceneOptions& options) {
  std::vector<std::vector<pcl::Indices>> found(clusters.size());
  parallelBlocks(clusters.size(), options.num_threads, [&](std::size_t k) {
    found[k] = {clusters[k]};
    if (options.separate && viewpoint)
      found[k] = detail::convexPieces(scene, clusters[k], *viewpoint, spacing, options.min_points);
  });
  std::vector<std::pair<pcl::Indices, int>> all;
  for (std::size_t k = 0; k < found.size(); ++k)
    for (pcl::Indices& piece : found[k]) all.emplace_back(std::move(piece), static_cast<int>(k));
  sortDescending(all, [](const auto& entry) { return entry.first.size(); });
  Pieces pieces;
  for (auto& [indices, cluster] : all) {
    pieces.indices.push_back(std::move(indices));
    pieces.cluster_of.push_back(cluster);
  }
  return pieces;
}

/// Options for one of several objects: if there are at least as many objects as threads, each has one thread.
SceneOptions ofOneObject(const SceneOptions& options, std::size_t num_objects) {
  SceneOptions of_one = options;
  if (num_objects >= static_cast<std::size_t>(resolveNumThreads(options.num_threads)))
    of_one.num_threads = of_one.completion.num_threads = of_one.recognition.num_threads = 1;
  return of_one;
}

}  // namespace

void SceneOptions::validate() const {
  check(plane_distance >= 0.0, "plane_distance", plane_distance, ">= 0");
  check(cluster_distance >= 0.0, "cluster_distance", cluster_distance, ">= 0");
  check(min_points >= kMinDistinctPoints, "min_points", min_points, ">= 20");
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

void SymmetryScene::setGround(const Eigen::Vector4d& coefficients) {
  ground_ = detail::unitPlane(coefficients);
}

SceneAnalysis SymmetryScene::compute() const {
  SceneAnalysis analysis;
  StageTimes done(analysis.timing_ms);
  const auto without = [&](const std::string& reason) {
    detail::warnOfNoAnswer("SymmetryScene", "scene: " + reason);
    analysis.reason = reason;
    return analysis;
  };
  Cloud::ConstPtr frame = input_;
  if (frame) analysis.seen = seenSpaceOf(*frame, viewpoint_);
  done("seen_space");
  // What the database reads is ready when the clusters are: planes are searched for by one thread.
  std::shared_future<void> prepared;
  if (database_ && analysis.seen && analysis.seen->visibility() && resolveNumThreads(options_.num_threads) > 1)
    prepared = std::async(std::launch::async, [&] { database_->prepare(); });
  if (frame) frame = withoutDepthErrors(frame, *analysis.seen, options_.num_threads);
  if (frame != input_) analysis.seen = seenSpaceOf(*frame, viewpoint_);
  std::optional<Eigen::Vector3d> viewpoint;
  if (analysis.seen && analysis.seen->visibility()) viewpoint = analysis.seen->visibility()->viewpoint();
  const pcl::Indices points = frame ? nearPoints(*frame, viewpoint, options_.max_range) : pcl::Indices();
  if (points.empty()) {
    return without(!input_                    ? "not set"
                   : options_.max_range > 0.0 ? "no finite point within max_range"
                                              : "no finite point");
  }
  if (points.size() < static_cast<std::size_t>(options_.min_points))
    return without(std::to_string(points.size()) + " points, too few for an object (min_points)");
  done("filter");
  // The filter leaves the distortions of the depth image: the distances follow from the original frame.
  detail::SceneDistances distances = detail::sceneDistances(*input_, points);
  if (options_.plane_distance > 0.0) distances.plane = options_.plane_distance;
  if (options_.cluster_distance > 0.0) distances.cluster = options_.cluster_distance;
  analysis.plane_distance = distances.plane;
  analysis.cluster_distance = distances.cluster;
  if (!(distances.plane > 0.0 && distances.cluster > 0.0)) return without("all points at one place");
  if (ground_)
    analysis.supports = {detail::supportOf(*frame, points, viewpoint, *ground_, distances.plane)};
  else
    analysis.supports = detail::findSupports(frame, points, points, viewpoint, distances.plane);
  done("supports");
  const pcl::Indices rest = detail::withoutSupports(points, analysis.supports, frame->size());
  const bool has_picture = viewpoint && frame->isOrganized();
  const double least_share = has_picture ? detail::kScene.hidden_part : 1.0;
  std::vector<pcl::Indices> clusters = detail::findClusters(frame, rest, analysis.supports, distances,
                                                            static_cast<int>(least_share * options_.min_points));
  if (has_picture) detail::attachHiddenParts(*frame, *viewpoint, options_.min_points, clusters);
  const auto is_bulge = [&](const pcl::Indices& cluster) {
    return detail::isBulge(*frame, cluster, analysis.seen->visibility(), options_.detection.tolerance,
                           distances.cluster);
  };
  eraseIf(clusters, is_bulge);
  Pieces pieces = piecesOf(*frame, clusters, viewpoint, distances.spacing, options_);
  detail::returnFeet(*frame, analysis.supports, pieces.indices, distances);
  done("clusters");
  const auto of = [&](std::size_t num_objects) {
    return ObjectAnalysis(frame, analysis, distances, ofOneObject(options_, num_objects), database_.get());
  };
  const auto prepare = [&] { prepared.valid() ? prepared.get() : database_->prepare(); };
  std::function<bool(SceneObject&)> is_named;
  if (database_ && viewpoint)
    is_named = [&](SceneObject& object) {
      prepare();
      return of(1).recognize(object);
    };
  detail::JoinedPieces joined = detail::joinBySymmetry(
      {frame, analysis.supports, distances, options_.detection.tolerance, options_.num_threads,
       [&](const pcl::Indices& object) { return of(1).seenOf(object); },
       [&](const pcl::Indices& object, std::size_t num_objects) { return of(num_objects).withPlanes(object); },
       is_named},
      pieces.indices, pieces.cluster_of);
  analysis.objects = std::move(joined.objects);
  analysis.junctions = std::move(joined.junctions);
  done("planes");
  if (database_ && !analysis.objects.empty() && viewpoint) {
    prepare();
    done("database");
  }
  const std::size_t num_objects = analysis.objects.size();
  const bool one_each = num_objects >= static_cast<std::size_t>(resolveNumThreads(options_.num_threads));
  parallelBlocks(num_objects, one_each ? options_.num_threads : 1,
                 [&](std::size_t k) { of(num_objects).finish(analysis.objects[k]); });
  done("objects");
  analysis.alone = signOfOneObject(*input_, analysis);
  return analysis;
}

}  // namespace pcl_symmetry
