/// Takes the greatest plane out of a scene, cuts the rest into clusters, asks a database for each, and draws what it
/// found: the scene alone, and with the points of the models in their poses.
#include <pcl/common/transforms.h>
#include <pcl/io/pcd_io.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "common/command_line/command_line.h"
#include "common/command_line/run_tool.h"
#include "common/command_line/tool_errors.h"
#include "common/pictures/picture.h"
#include "pcl_symmetry/recognition/symmetry_database.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;
using Cloud = pcl::PointCloud<pcl::PointXYZ>;

struct SceneOptions {
  std::string database, scene, picture;
  double farthest = 1.5;         // greatest distance of points from the scanner
  double plane_distance = 0.03;  // greatest distance of points that belong to the plane
  double cluster_distance = 0.02;
  int least_cluster = 1000;
};

CommandLine commandLine(SceneOptions& o) {
  CommandLine line("draw_recognition", "Recognizes the objects that stand on a plane, and draws them.",
                   "draw_recognition models.db scene.pcd found.png");
  line.positional("database", o.database, "file of pcl_symmetry_database")
      .positional("scene", o.scene, ".pcd, as a scanner took it")
      .positional("picture", o.picture, "PNG file")
      .number("farthest", o.farthest, Range::above(0), "depth of the points that are looked at, input units")
      .number("plane", o.plane_distance, Range::above(0), "distance of points that belong to the plane, input units")
      .number("gap", o.cluster_distance, Range::above(0), "distance of points of one object, input units")
      .number("least", o.least_cluster, Range::closed(1, 1'000'000'000), "points of an object");
  return line;
}

/// The finite points that are near enough.
Cloud::Ptr nearPoints(const Cloud& scene, double farthest) {
  auto points = pcl::make_shared<Cloud>();
  for (const pcl::PointXYZ& point : scene)
    if (pcl::isXYZFinite(point) && point.z < farthest) points->push_back(point);
  points->sensor_origin_ = scene.sensor_origin_;
  return points;
}

Cloud::Ptr withoutPlane(const Cloud::Ptr& points, double distance) {
  pcl::SACSegmentation<pcl::PointXYZ> segmentation;
  segmentation.setModelType(pcl::SACMODEL_PLANE);
  segmentation.setMethodType(pcl::SAC_RANSAC);
  segmentation.setMaxIterations(500);
  segmentation.setDistanceThreshold(distance);
  segmentation.setInputCloud(points);
  pcl::PointIndices plane;
  pcl::ModelCoefficients coefficients;
  segmentation.segment(plane, coefficients);
  std::vector<bool> in_plane(points->size(), false);
  for (const auto i : plane.indices) in_plane[static_cast<std::size_t>(i)] = true;
  auto rest = pcl::make_shared<Cloud>();
  for (std::size_t i = 0; i < points->size(); ++i)
    if (!in_plane[i]) rest->push_back((*points)[i]);
  rest->sensor_origin_ = points->sensor_origin_;
  return rest;
}

std::vector<Cloud> clustersOf(const Cloud::Ptr& points, double distance, int least) {
  pcl::EuclideanClusterExtraction<pcl::PointXYZ> extraction;
  extraction.setClusterTolerance(distance);
  extraction.setMinClusterSize(least);
  extraction.setInputCloud(points);
  std::vector<pcl::PointIndices> indices;
  extraction.extract(indices);
  std::vector<Cloud> clusters;
  for (const pcl::PointIndices& cluster : indices) clusters.emplace_back(*points, cluster.indices);
  return clusters;
}

int run(int argc, char** argv) {
  SceneOptions options;
  if (!commandLine(options).parse(argc, argv)) return 0;
  Cloud scene;
  if (pcl::io::loadPCDFile(options.scene, scene) < 0) throw InputError(options.scene + ": cannot be read");
  const SymmetryDatabase database(options.database);
  const Cloud::Ptr points = nearPoints(scene, options.farthest);
  auto shown = pcl::make_shared<Cloud>(*points);
  std::vector<int> labels(points->size(), -1);
  for (const Cloud& cluster :
       clustersOf(withoutPlane(points, options.plane_distance), options.cluster_distance, options.least_cluster)) {
    const Recognition found = database.recognize(cluster);
    if (found.empty()) {
      std::printf("%zu points: unknown object\n", cluster.size());
      continue;
    }
    const RecognizedModel& best = found.front();
    std::printf("%zu points: %s, confidence %.3f, support %.3f, conflict %.3f\n", cluster.size(), best.name.c_str(),
                best.confidence, best.score.support, best.score.conflict);
    Cloud posed;
    pcl::transformPointCloud(database.cloud(best.name), posed, best.T_model_scan.inverse().matrix());
    *shown += posed;
    labels.resize(shown->size(), labels.empty() ? 0 : 1 + *std::max_element(labels.begin(), labels.end()));
  }
  PictureScene picture;
  picture.points = shown;
  picture.view = {0.25, -0.35, -1.0};
  picture.up = {0.0, -1.0, 0.0};
  PicturePanel panel;
  panel.segments = labels;
  picture.panels = {panel};
  renderPicture(picture, options.picture, 800, 600);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
