/// Draws for the pages of algorithms where each of them goes wrong: a frame, a pose, a completion, a name and a group
/// of rotations that the data do not tell, or that the tolerance passes over.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "common/command_line/command_line.h"
#include "common/command_line/run_tool.h"
#include "common/command_line/tool_errors.h"
#include "common/pictures/picture.h"
#include "common/scanner/virtual_scanner.h"
#include "common/shape_input/shape_input.h"
#include "core/base/constants.h"
#include "drawing/frame_axes.h"
#include "drawing/mug_mesh.h"
#include "pcl_symmetry/completion.h"
#include "pcl_symmetry/mesh_sampling.h"
#include "pcl_symmetry/object_symmetries.h"
#include "pcl_symmetry/recognition/symmetry_database.h"
#include "pcl_symmetry/registration/symmetry_registration.h"
#include "pcl_symmetry/symmetry_alignment.h"
#include "pcl_symmetry/symmetry_maxima_refinement.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;
using Cloud = pcl::PointCloud<pcl::PointXYZ>;

constexpr int kNumPoints = 10'000;                  // chosen: the default of the tools
constexpr int kWidth = 420, kHeight = 360;          // pixels of a panel; chosen: two panels fill the width of a page
const Eigen::Vector3d kAwayFromHandle(-1, 0, 0.3);  // chosen: a little from above, as a camera looks at a table

std::string rounded(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

Cloud::Ptr scanOf(const pcl::PolygonMesh& mesh, const Eigen::Vector3d& direction) {
  VirtualScannerOptions how;
  how.num_points = kNumPoints;
  return VirtualScanner(mesh).scan(direction, how).cloud;
}

/// A mesh in grey, and a cloud beside or in it.
PictureScene sceneOf(const pcl::PolygonMesh& mesh, const Cloud::ConstPtr& cloud, const std::string& label) {
  PictureScene scene;
  scene.mesh = mesh;
  scene.points = cloud;
  scene.panels = {PicturePanel{label}};
  return scene;
}

void draw(const std::vector<PictureScene>& scenes, const std::string& path) {
  const int num_panels = static_cast<int>(scenes.size());
  renderPicture(scenes, path, num_panels * kWidth, kHeight, num_panels);
  std::printf("%s\n", path.c_str());
}

/// A hand is not symmetric: its whole and a scan of it have frames of their own.
void drawFrame(const Shape& hand, const std::string& path) {
  std::vector<PictureScene> scenes;
  Eigen::Matrix3d axes_of_whole;
  for (const bool whole : {true, false}) {
    const Cloud::Ptr cloud = whole ? sampleMesh(*hand.mesh, kNumPoints) : scanOf(*hand.mesh, {1, 1, 1});
    SymmetryAlignment<pcl::PointXYZ> alignment;
    alignment.setInputCloud(cloud);
    const SymmetryFrame frame = alignment.compute();
    if (whole) axes_of_whole = frame.axes;
    const double cosine = (axes_of_whole.transpose() * frame.axes).diagonal().cwiseAbs().minCoeff();
    const double off = std::acos(std::min(1.0, cosine)) * 180.0 / kPi;
    PictureScene scene = sceneOf(*hand.mesh, cloud,
                                 whole ? "frame of the whole hand" : rounded("of a scan of it, %.0f degrees off", off));
    standUpright(scene, Eigen::Vector3d::UnitY());
    addAxes(scene.panels[0], frame.center, frame.axes);
    scenes.push_back(scene);
  }
  draw(scenes, path);
}

/// A mug whose handle the scanner does not see fits at any angle at which the handle is hidden.
void drawPose(const std::string& path) {
  const pcl::PolygonMesh mesh = mug(0.9, 0.9);
  const Cloud::Ptr scan = scanOf(mesh, kAwayFromHandle);
  SymmetryRegistration<pcl::PointXYZ, pcl::PointXYZ> registration;
  registration.setInputSource(scan);
  registration.setInputTarget(sampleMesh(mesh, kNumPoints));
  Cloud::Ptr aligned(new Cloud);
  registration.align(*aligned);
  const Eigen::Matrix4f T_model_scan = registration.getFinalTransformation();
  const double turn = Eigen::AngleAxisf(T_model_scan.topLeftCorner<3, 3>()).angle() * 180.0 / kPi;
  std::vector<PictureScene> scenes{sceneOf(mesh, scan, "true pose"),
                                   sceneOf(mesh, aligned,
                                           rounded("pose found, %.0f degrees off", turn) +
                                               rounded(", merit %.2f", registration.getScore().merit()))};
  for (PictureScene& scene : scenes) scene.view = {-0.6, -1.0, 1.3};
  draw(scenes, path);
}

/// The other half of a hand is not that of its best plane.
void drawCompletion(const Shape& hand, const std::string& path) {
  const Cloud::Ptr scan = scanOf(*hand.mesh, {1, 1, 1});
  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  refinement.setInputCloud(scan);
  const std::vector<SymmetryPlane> planes = refinement.compute();
  if (planes.empty() && !refinement.getBestPlane()) throw InputError("the scan of the hand has no plane");
  const auto completed = completeBySymmetry(*scan, planes.empty() ? *refinement.getBestPlane() : planes[0]);
  PictureScene made_up;
  made_up.points = std::make_shared<Cloud>(completed.cloud);
  PicturePanel panel{"measured (orange), added (blue)"};
  panel.segments.assign(completed.cloud.size(), 0);
  for (const pcl::index_t i : completed.added) panel.segments[static_cast<std::size_t>(i)] = 1;
  made_up.panels = {panel};
  PictureScene truth = sceneOf(*hand.mesh, scan, "the hand");
  truth.panels[0].show_points = false;
  std::vector<PictureScene> scenes{truth, made_up};
  for (PictureScene& scene : scenes) {
    scene.view = {-1.0, -1.4, 0.4};
    standUpright(scene, Eigen::Vector3d::UnitY());
  }
  draw(scenes, path);
}

/// Seen from the side without a handle, a mug is a cup.
void drawName(const std::string& path) {
  const pcl::PolygonMesh with_handle = mug(0.9, 0.9), without = mug(0.01, 0.01);
  SymmetryDatabase database(":memory:");
  database.add("mug", *sampleMesh(with_handle, kNumPoints));
  database.add("cup", *sampleMesh(without, kNumPoints));
  std::vector<PictureScene> scenes;
  for (const double side : {1.0, -1.0}) {
    const Cloud::Ptr scan = scanOf(with_handle, {-side * kAwayFromHandle.x(), 0.7, kAwayFromHandle.z()});
    std::string label = "no name";
    for (const RecognizedModel& model : database.recognize(*scan))
      label = (label == "no name" ? "" : label + ", ") + model.name + rounded(" %.2f", model.confidence);
    PictureScene scene;
    scene.points = scan;
    scene.panels = {PicturePanel{"scan of the mug: " + label}};
    scene.view = {-side * kAwayFromHandle.x(), 0.7, 0.8};
    scenes.push_back(scene);
  }
  draw(scenes, path);
}

/// What is smaller than max_feature is passed over.
void drawRotations(const std::string& path) {
  std::vector<PictureScene> scenes;
  for (const double handle : {0.25, 0.9}) {
    const pcl::PolygonMesh mesh = mug(handle, handle);
    const ObjectSymmetries found = detectObjectSymmetries(mesh);
    scenes.push_back(
        sceneOf(mesh, sampleMesh(mesh, 2), "group " + found.name() + rounded(", confidence %.2f", found.confidence)));
    scenes.back().panels[0].show_points = false;
    scenes.back().view = {0.9, -1.6, 0.7};
  }
  draw(scenes, path);
}

int run(int argc, char** argv) {
  if (argc != 3 || argv[1][0] == '-') throw UsageError("usage: draw_failures FOLDER HAND");
  const std::filesystem::path folder(argv[1]);
  const Shape hand = loadShape(argv[2]);
  if (!hand.mesh) throw InputError(std::string(argv[2]) + ": has no faces to scan");
  drawFrame(hand, folder / "failure_frame.png");
  drawPose(folder / "failure_pose.png");
  drawCompletion(hand, folder / "failure_completion.png");
  drawName(folder / "failure_name.png");
  drawRotations(folder / "failure_rotations.png");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
