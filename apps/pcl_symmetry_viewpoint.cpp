/// Good and bad views of a cloud or mesh, by the symmetries that they show: a table, JSON with camera poses, pictures.
#include <pcl/conversions.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "console.h"
#include "options.h"
#include "pcl_symmetry/core/detection/local_maxima.h"
#include "pcl_symmetry/mesh_sampling.h"
#include "pcl_symmetry/symmetry_maxima_refinement.h"
#include "pcl_symmetry/viewpoint_selection.h"
#include "picture.h"
#include "shape_input.h"
#include "shape_output.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

struct ViewpointToolOptions {
  std::string input;
  std::optional<std::string> png_path, icon_path;
  std::optional<Eigen::Vector3d> up;
  int num_views = 4, mesh_points = 10'000, size = 400;
  double separation = 40.0;  // degrees
  CommonOptions common;
};

CommandLine commandLine(ViewpointToolOptions& options) {
  CommandLine line("pcl_symmetry_viewpoint", "Chooses views of a cloud or mesh that show little symmetry.",
                   "pcl_symmetry_viewpoint chair.off -up 0,1,0 -png chair_views.png -json chair_views.json");
  line.positional("input", options.input, ".pcd, .ply, .obj, .stl or .off")
      .text("png", "FILE", options.png_path, "picture: score of all directions, best view, worst view")
      .text("icon", "FILE", options.icon_path, "picture of the best view alone")
      .vector("up", options.up, "about where up is, input frame (0,0,1)")
      .number("views", options.num_views, Range::closed(1, 100), "good views at most")
      .number("separation", options.separation, Range::closed(0, 180), "least angle between good views, degrees")
      .number("size", options.size, Range::closed(16, 4096), "edge of each view, pixels")
      .number("points", options.mesh_points, Range::closed(100, 10'000'000), "points spread over a mesh")
      .common(options.common, kAllCommonFlags);
  return line;
}

std::vector<double> toVector(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

nlohmann::json toJson(const SelectedView& view) {
  std::vector<double> pose;
  for (int i = 0; i < 16; ++i) pose.push_back(view.pose.matrix()(i / 4, i % 4));
  return {{"direction", toVector(view.direction)}, {"score", view.score}, {"pose", pose}};
}

void printView(const char* name, const SelectedView& view) {
  std::printf("%-6s %9.6f %9.6f %9.6f %7.3f\n", name, view.direction.x(), view.direction.y(), view.direction.z(),
              view.score);
}

PictureScene sceneOf(const Shape& shape, const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud,
                     const SelectedView& view, const std::string& label) {
  PictureScene scene;
  scene.points = cloud;
  scene.mesh = shape.mesh;
  PicturePanel panel;
  panel.label = label;
  panel.show_points = !shape.mesh;
  scene.panels.push_back(panel);
  scene.view = view.direction;
  scene.up = -view.pose.linear().col(1).cast<double>();
  return scene;
}

/// The score as a spherical function (Figure 16): directions scaled and coloured by it.
PictureScene scoreSphere(const ViewpointSelection& selection, const SelectedView& best, const SelectedView& worst) {
  constexpr int kRings = 120, kAround = 240;
  const Eigen::Vector3d up = selection.getUpAxis(), side = up.unitOrthogonal(), front = up.cross(side);
  pcl::PointCloud<pcl::PointXYZ>::Ptr surface(new pcl::PointCloud<pcl::PointXYZ>);
  PicturePanel panel;
  panel.label = "score of each direction";
  panel.show_points = false;
  const double range = std::max(best.score - worst.score, 1e-9);
  for (int ring = 0; ring <= kRings; ++ring) {
    for (int k = 0; k < kAround; ++k) {
      const double theta = M_PI * ring / kRings, phi = 2.0 * M_PI * k / kAround;
      const Eigen::Vector3d v = std::cos(theta) * up + std::sin(theta) * (std::cos(phi) * side + std::sin(phi) * front);
      const double score = selection.getScore(v);
      const Eigen::Vector3f p = (std::max(score, 1e-3 * range) * v).cast<float>();
      surface->emplace_back(p.x(), p.y(), p.z());
      panel.support.push_back((score - worst.score) / range);
    }
  }
  pcl::PolygonMesh mesh;
  pcl::toPCLPointCloud2(*surface, mesh.cloud);
  for (int ring = 0; ring < kRings; ++ring) {
    for (int k = 0; k < kAround; ++k) {
      const int next = (k + 1) % kAround;
      pcl::Vertices quad;
      quad.vertices = {ring * kAround + k, (ring + 1) * kAround + k, (ring + 1) * kAround + next,
                       ring * kAround + next};
      mesh.polygons.push_back(quad);
    }
  }
  PictureScene scene;
  scene.points = surface;
  scene.mesh = mesh;
  scene.panels.push_back(panel);
  scene.show_color_bar = false;
  // Beside the best view, so that its peak is seen in profile.
  scene.view = Eigen::AngleAxisd(0.3 * M_PI, up) * best.direction + 0.2 * up;
  scene.up = up;
  if (scene.view.normalized().cross(up).norm() < 0.2) scene.view = side + 0.5 * up;
  return scene;
}

/// Chooses by the local maxima of the transform of the cloud. \return milliseconds.
double choose(ViewpointSelection& selection, const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud,
              const ViewpointToolOptions& options, const Console& console) {
  DetectionOptions detection;
  detection.approximate = true;
  detection.seed = options.common.seed + 1;
  detection.num_threads = detection.edt.num_threads = options.common.threads;
  detection.edt.num_cells = options.common.grid;
  Step searching(console, "Searching planes");
  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  std::vector<SymmetryPlane> planes;
  try {
    refinement.setOptions(detection);
    refinement.setViewpoint(options.common.viewpoint);
    refinement.setInputCloud(cloud);
    planes = refinement.compute();
    if (!refinement.getReason().empty()) throw InputError(options.input + ": " + refinement.getReason());
  } catch (const pcl::BadArgumentException& error) {
    throw InputError(options.input + ": " + error.detailedMessage());
  }
  selection.setPlanes(planes, refinement.getAxes(), findLocalMaxima(refinement.getSymmetryMap(), detection.maxima));
  selection.setInputCloud(cloud);
  if (options.up) selection.setUp(*options.up);
  selection.setSeparation(options.separation * M_PI / 180.0);
  const std::size_t num_axes = refinement.getAxes().size();
  return searching.done(std::to_string(planes.size()) + " planes, " + std::to_string(num_axes) +
                        (num_axes == 1 ? " axis" : " axes"));
}

nlohmann::json describe(const ViewpointToolOptions& options, const ViewpointSelection& selection,
                        const std::vector<SelectedView>& good, const SelectedView& worst) {
  nlohmann::json json{{"file", options.input},
                      {"up", toVector(selection.getUpAxis())},
                      {"best", toJson(good[0])},
                      {"worst", toJson(worst)},
                      {"good", nlohmann::json::array()}};
  for (const SelectedView& view : good) json["good"].push_back(toJson(view));
  return json;
}

int run(int argc, char** argv) {
  ViewpointToolOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  if (options.up && options.up->norm() == 0.0) throw UsageError("-up = 0,0,0, must not be zero");
  const Console console(options.common.quiet);

  Step loading(console, "Loading " + options.input);
  const Shape shape = loadShape(options.input);
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud = shape.points;
  if (shape.mesh) cloud = sampleMesh(*shape.mesh, options.mesh_points, options.common.seed + 1);
  const double loading_ms = loading.done(std::to_string(cloud->size()) + " points");

  ViewpointSelection selection;
  const double searching_ms = choose(selection, cloud, options, console);
  Step choosing(console, "Choosing views");
  const std::vector<SelectedView> good = selection.getGoodViews(options.num_views);
  const SelectedView worst = selection.getWorstView();
  const double choosing_ms = choosing.done(std::to_string(good.size()) + (good.size() == 1 ? " view" : " views"));

  std::printf("%-6s %9s %9s %9s %7s\n", "view", "x", "y", "z", "score");
  for (std::size_t i = 0; i < good.size(); ++i) printView(i == 0 ? "best" : "good", good[i]);
  printView("worst", worst);
  if (options.common.json_path) {
    nlohmann::json json = describe(options, selection, good, worst);
    json["timing_ms"] = {{"load", loading_ms}, {"planes", searching_ms}, {"views", choosing_ms}};
    writeText(*options.common.json_path, json.dump(2) + "\n");
  }
  if (options.icon_path)
    renderPicture(sceneOf(shape, cloud, good[0], ""), *options.icon_path, options.size, options.size);
  if (options.png_path) {
    Step drawing(console, "Drawing " + *options.png_path);
    renderPicture({scoreSphere(selection, good[0], worst), sceneOf(shape, cloud, good[0], "best view"),
                   sceneOf(shape, cloud, worst, "worst view")},
                  *options.png_path, 3 * options.size, options.size, 3);
    drawing.done();
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
