#include "viewer_model.h"

#include <pcl/common/point_tests.h>
#include <pcl/conversions.h>

#include <cstdio>

#include "pcl_symmetry/mesh_sampling.h"
#include "pcl_symmetry/symmetry_alignment.h"
#include "pcl_symmetry/symmetry_maxima_refinement.h"
#include "pcl_symmetry/symmetry_segmentation.h"

namespace pcl_symmetry::apps {

namespace {

const char* nameOf(PlaneKind kind) {
  switch (kind) {
    case PlaneKind::Symmetry:
      return "symmetry";
    case PlaneKind::Possible:
      return "possible symmetry";
    case PlaneKind::Local:
      return "symmetry of a part";
    case PlaneKind::Approximate:
      break;
  }
  return "approximate symmetry";
}

std::string labelOf(const SymmetryPlane& plane, std::size_t index, std::size_t num_planes) {
  char text[160];
  std::snprintf(text, sizeof(text), "plane %zu of %zu: %s\nconfidence %.2f   support %.2f   score %.2f", index + 1,
                num_planes, nameOf(plane.kind), plane.confidence, plane.support, plane.score);
  return text;
}

template <typename Cloud>
void normalize(Cloud& cloud, const BoundingBall& ball) {
  for (auto& point : cloud)
    point.getVector3fMap() =
        ((point.getVector3fMap().template cast<double>() - ball.center) / ball.radius).template cast<float>();
}

}  // namespace

ViewerModel makeViewerModel(const Shape& shape, const ViewerModelOptions& options) {
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud = shape.points;
  if (shape.mesh) cloud = sampleMesh(*shape.mesh, options.mesh_points, options.detection.seed);
  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  refinement.setOptions(options.detection);
  refinement.setViewpointMode(options.viewpoint.mode);
  if (options.viewpoint.mode == Viewpoint::Mode::Given) refinement.setViewpoint(options.viewpoint.position);
  refinement.setInputCloud(cloud);
  ViewerModel model;
  model.planes = refinement.compute();
  model.axes = refinement.getAxes();
  model.centers = refinement.getCenters();

  SymmetryAlignment<pcl::PointXYZ> alignment;
  alignment.setGridSize(options.detection.edt.num_cells);
  alignment.setRandomSeed(options.detection.seed);
  alignment.setNumberOfThreads(options.detection.num_threads);
  alignment.setViewpointMode(options.viewpoint.mode);
  if (options.viewpoint.mode == Viewpoint::Mode::Given) alignment.setViewpoint(options.viewpoint.position);
  alignment.setInputCloud(cloud);
  model.frame = alignment.compute();

  std::vector<std::size_t> finite;
  for (std::size_t i = 0; i < cloud->size(); ++i)
    if (pcl::isXYZFinite((*cloud)[i])) finite.push_back(i);
  model.points.reset(new pcl::PointCloud<pcl::PointXYZ>);
  Points positions(3, finite.size());
  for (std::size_t i = 0; i < finite.size(); ++i) {
    model.points->push_back((*cloud)[finite[i]]);
    positions.col(i) = (*cloud)[finite[i]].getVector3fMap();
  }
  const BoundingBall ball = boundingBall(positions);
  normalize(*model.points, ball);
  if (shape.mesh) {
    model.mesh = shape.mesh;
    pcl::PointCloud<pcl::PointXYZ> vertices;
    pcl::fromPCLPointCloud2(shape.mesh->cloud, vertices);
    normalize(vertices, ball);
    pcl::toPCLPointCloud2(vertices, model.mesh->cloud);
  }
  for (std::size_t k = 0; k < model.planes.size(); ++k) {
    SymmetryPlane& plane = model.planes[k];
    const std::vector<float> support = refinement.computePointSupport(plane);
    plane.point_support.clear();
    for (const std::size_t i : finite) plane.point_support.push_back(support[i]);
    model.labels.push_back(labelOf(plane, k, model.planes.size()));
    static_cast<ReflectionPlane&>(plane) =
        ReflectionPlane(plane.normal(), plane.signedDistance(ball.center) / -ball.radius);
  }
  model.frame.center = (model.frame.center - ball.center) / ball.radius;
  for (SymmetryAxis& axis : model.axes) axis.point = (axis.point - ball.center) / ball.radius;
  for (SymmetryCenter& center : model.centers) center.point = (center.point - ball.center) / ball.radius;
  model.views.setPlanes(model.planes, model.axes);
  model.views.setInputCloud(model.points);
  if (options.up) model.views.setUp(*options.up);
  model.segmentation.num_parts = options.num_parts;
  model.segmentation.seed = options.detection.seed;
  model.segmentation.num_threads = options.detection.num_threads;
  // Thickness and line of sight need an inside, which a scan from one side does not have.
  if (refinement.usedViewpoint()) model.segmentation.merging.evidence = MergingEvidence::SymmetryAndConcavity;
  const auto counted = [](std::size_t number, const char* one, const char* many) {
    return std::to_string(number) + " " + (number == 1 ? one : many);
  };
  model.summary = counted(model.planes.size(), "plane", "planes");
  if (!model.axes.empty()) model.summary += ", " + counted(model.axes.size(), "axis", "axes");
  if (!model.centers.empty()) model.summary += ", " + counted(model.centers.size(), "center", "centers");
  if (refinement.usedViewpoint()) model.summary += ", seen from one side";
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

}  // namespace pcl_symmetry::apps
