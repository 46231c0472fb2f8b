#include "viewer/viewer_model.h"

#include <pcl/common/point_tests.h>
#include <pcl/conversions.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/constants.h"
#include "core/geometry/surface_normals.h"
#include "io/answers.h"
#include "pcl_symmetry/core/iterative_symmetric_points.h"
#include "pcl_symmetry/core/local_maxima.h"
#include "pcl_symmetry/mesh_sampling.h"
#include "pcl_symmetry/symmetry_alignment.h"
#include "pcl_symmetry/symmetry_maxima_refinement.h"
#include "pcl_symmetry/symmetry_segmentation.h"

namespace pcl_symmetry::apps {

namespace {

const char* nameOf(PlaneKind kind) {
  static const char* const names[] = {"symmetry", "possible symmetry", "approximate symmetry", "symmetry of a part"};
  return names[static_cast<int>(kind)];
}

std::string labelOf(const SymmetryPlane& plane, std::size_t index, std::size_t num_planes) {
  return formatted("plane %zu of %zu: %s\nconfidence %.2f   support %.2f   score %.2f", index + 1, num_planes,
                   nameOf(plane.kind), plane.confidence, plane.support, plane.score);
}

/// Takes the ball to the unit ball.
struct ToUnitBall {
  BoundingBall ball;

  Eigen::Vector3d operator()(const Eigen::Vector3d& x) const { return (x - ball.center) / ball.radius; }
  ReflectionPlane operator()(const ReflectionPlane& plane) const {
    return {plane.normal(), plane.signedDistance(ball.center) / -ball.radius};
  }
  void operator()(pcl::PointCloud<pcl::PointXYZ>& cloud) const {
    for (pcl::PointXYZ& point : cloud)
      point.getVector3fMap() = (*this)(point.getVector3fMap().cast<double>().eval()).cast<float>();
  }
};

SymmetryFrame frameOf(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud, const ViewerModelOptions& options) {
  SymmetryAlignment<pcl::PointXYZ> alignment;
  alignment.setGridSize(options.detection.num_cells);
  alignment.setRandomSeed(options.detection.seed);
  alignment.setNumberOfThreads(options.detection.num_threads);
  alignment.setViewpoint(options.viewpoint);
  alignment.setInputCloud(cloud);
  return alignment.compute();
}

SegmentationOptions segmentationOf(const ViewerModelOptions& options, bool seen_from_one_side) {
  SegmentationOptions segmentation;
  segmentation.num_parts = options.num_parts;
  segmentation.seed = options.detection.seed;
  segmentation.num_threads = options.detection.num_threads;
  // Thickness and line of sight need an inside, which a scan from one side does not have.
  if (seen_from_one_side) segmentation.evidence = MergingEvidence::SymmetryAndConcavity;
  return segmentation;
}

std::string summaryOf(const ViewerModel& model, bool seen_from_one_side) {
  std::string summary = counted(model.planes.size(), "plane");
  if (!model.axes.empty()) summary += ", " + counted(model.axes.size(), "axis", "axes");
  if (!model.centers.empty()) summary += ", " + counted(model.centers.size(), "center");
  if (seen_from_one_side) summary += ", seen from one side";
  return summary;
}

pcl::PolygonMesh normalized(pcl::PolygonMesh mesh, const ToUnitBall& normalize) {
  pcl::PointCloud<pcl::PointXYZ> vertices;
  pcl::fromPCLPointCloud2(mesh.cloud, vertices);
  normalize(vertices);
  pcl::toPCLPointCloud2(vertices, mesh.cloud);
  return mesh;
}

// Where the shown refinement starts, radians and radii from the plane.
constexpr double kTurn = 12.0 * kPi / 180.0, kShift = 0.05;
// Width of the weights and the step that ends the refinement, radii.
constexpr double kWeightWidth = 0.12, kResting = 1e-3;
constexpr int kMaxFrames = 20, kNumSamples = 5'000, kNumShown = 120;

IspFrame frameOf(const Points& points, const std::vector<int>& samples, const ReflectionPlane& plane,
                 const IspStep& step) {
  IspFrame frame;
  frame.plane = plane;
  frame.residual = step.residual;
  const std::size_t stride = std::max<std::size_t>(1, samples.size() / kNumShown);
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < samples.size(); i += stride)
    if (step.closest[i] >= 0 && step.sq_distances[i] < kWeightWidth * kWeightWidth) shown.push_back(i);
  for (Points* const set : {&frame.samples, &frame.reflections, &frame.closest}) set->resize(3, shown.size());
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const Eigen::Vector3f x = points.col(samples[shown[k]]);
    frame.samples.col(k) = x;
    frame.reflections.col(k) = plane.reflect(x.cast<double>()).cast<float>();
    frame.closest.col(k) = points.col(step.closest[shown[k]]);
  }
  return frame;
}

}  // namespace

ViewerModel makeViewerModel(const Shape& shape, const ViewerModelOptions& options) {
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud = shape.points;
  if (shape.mesh) cloud = sampleMesh(*shape.mesh, options.mesh_points, options.detection.seed);
  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  refinement.setOptions(options.detection);
  refinement.setViewpoint(options.viewpoint);
  refinement.setInputCloud(cloud);
  ViewerModel model;
  model.planes = refinement.compute();
  if (!refinement.getReason().empty()) detail::throwBadArgument(refinement.getReason());
  model.axes = refinement.getAxes();
  model.centers = refinement.getDetection().centers;
  model.frame = frameOf(cloud, options);

  pcl::Indices finite;
  for (std::size_t i = 0; i < cloud->size(); ++i)
    if (pcl::isXYZFinite((*cloud)[i])) finite.push_back(static_cast<pcl::index_t>(i));
  model.points.reset(new pcl::PointCloud<pcl::PointXYZ>(*cloud, finite));
  const ToUnitBall normalize{boundingBall(model.points->getMatrixXfMap(3, 4, 0))};
  normalize(*model.points);
  if (shape.mesh) model.mesh = normalized(*shape.mesh, normalize);
  for (std::size_t k = 0; k < model.planes.size(); ++k) {
    SymmetryPlane& plane = model.planes[k];
    const std::vector<float> support = refinement.computePointSupport(plane);
    plane.point_support.clear();
    for (const pcl::index_t i : finite) plane.point_support.push_back(support[i]);
    model.labels.push_back(labelOf(plane, k, model.planes.size()));
    plane.ReflectionPlane::operator=(normalize(plane));
  }
  model.frame.center = normalize(model.frame.center);
  for (SymmetryAxis& axis : model.axes) axis.point = normalize(axis.point);
  for (SymmetryCenter& center : model.centers) center.point = normalize(center.point);

  model.views.setPlanes(model.planes, model.axes,
                        findLocalMaxima(refinement.getSymmetryMap(), options.detection.expert.maxima));
  model.views.setInputCloud(model.points);
  if (options.up) model.views.setUp(*options.up);
  model.segmentation = segmentationOf(options, refinement.usedViewpoint());
  model.summary = summaryOf(model, refinement.usedViewpoint());
  return model;
}

std::vector<int> findParts(const ViewerModel& model) {
  SymmetrySegmentation<pcl::PointXYZ> segmentation;
  segmentation.setOptions(model.segmentation);
  if (model.mesh)
    segmentation.setInputMesh(pcl::make_shared<pcl::PolygonMesh>(*model.mesh));
  else
    segmentation.setInputCloud(model.points);
  std::vector<pcl::PointIndices> segments;
  segmentation.segment(segments);
  return segments.empty() ? std::vector<int>() : segmentation.getLabels();
}

std::vector<IspFrame> ispFrames(const Points& points, const ReflectionPlane& plane) {
  const ClosestPointSearch::Ptr search = makeFlannSearch(points);
  const LocalGeometry geometry = localGeometry(points, *search, kNumSupportNeighbors, 0);
  const IspSurface surface{points, geometry.normals, *search};
  std::vector<int> samples;
  const Eigen::Index stride = std::max<Eigen::Index>(1, points.cols() / kNumSamples);
  for (Eigen::Index i = 0; i < points.cols(); i += stride) samples.push_back(static_cast<int>(i));

  const Eigen::Vector3d turned = Eigen::AngleAxisd(kTurn, plane.normal().unitOrthogonal()) * plane.normal();
  ReflectionPlane current(turned, plane.offset() + kShift);
  std::vector<IspFrame> frames;
  for (int i = 0; i < kMaxFrames; ++i) {
    const IspStep step = iterateSymmetricPoints(surface, samples, current, kWeightWidth, IspUpdate::PointToPlane);
    frames.push_back(frameOf(points, samples, current, step));
    const double sign = step.plane.normal().dot(current.normal()) < 0.0 ? -1.0 : 1.0;
    const bool rests =
        step.plane.angleTo(current) < kResting && std::abs(sign * step.plane.offset() - current.offset()) < kResting;
    if (rests) break;
    current = step.plane;
  }
  return frames;
}

}  // namespace pcl_symmetry::apps
