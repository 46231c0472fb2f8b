/// A window that shows a cloud or mesh and its planes of symmetry; or its content as a picture.
#include <pcl/common/point_tests.h>
#include <pcl/visualization/pcl_visualizer.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "io/answers.h"
#include "io/input_shape.h"
#include "io/shape_output.h"
#include "pcl_symmetry/symmetry_maxima_refinement.h"
#include "pictures/drawing.h"
#include "pictures/patch_geometry.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;
using Window = pcl::visualization::PCLVisualizer;

constexpr const char* kKeys =
    "n, b: next plane, plane before it   m: the reflected points   q: quit   h: all keys of "
    "PCL";

struct ViewerOptions {
  std::string input;
  std::optional<std::string> screenshot_path;
  std::optional<Eigen::Vector3d> up;
  int plane = 1;
  bool symmetries_only = false;
  CommonOptions common;
};

CommandLine commandLine(ViewerOptions& options) {
  CommandLine line("pcl_symmetry_viewer", "Shows a cloud or mesh and its planes of symmetry in a window of PCL.",
                   "pcl_symmetry_viewer bull.off -up 0,1,0");
  line.positional("input", options.input, kShapeFiles)
      .text("screenshot", "FILE.png", options.screenshot_path, "write a picture and open no window; needs no screen")
      .number("plane", options.plane, Range::closed(1, 1000), "number of the plane that is shown first")
      .flag("symmetries", options.symmetries_only, "leave out approximate symmetries and those of parts")
      .direction("up", options.up, "direction that is about up, input frame (0,0,1)")
      .common(options.common, kShapeFlags & ~kJson);
  return line;
}

/// The content of the window: the points in the colors of their support for one plane, the plane, and what keys add.
class View {
public:
  View(Window& window, const Cloud::Ptr& points, SymmetryMaximaRefinement<pcl::PointXYZ>& refinement, int plane)
      : window_(window), refinement_(refinement), planes_(refinement.getDetection().planes), plane_(plane) {
    scene_.points = points;
    draw();
  }

  void press(const std::string& key) {
    const int num_planes = static_cast<int>(planes_.size());
    if (key == "n") plane_ = std::min(plane_ + 1, num_planes);
    if (key == "b") plane_ = std::max(plane_ - 1, 1);
    if (key == "m") reflected_ = !reflected_;
    if (key == "n" || key == "b" || key == "m") draw();
  }

private:
  using Colored = pcl::PointCloud<pcl::PointXYZRGB>;

  void draw() {
    window_.removeAllPointClouds();
    window_.removeAllShapes();
    const SymmetryPlane* const plane = planes_.empty() ? nullptr : &planes_[plane_ - 1];
    const std::vector<float> support = plane ? refinement_.computePointSupport(*plane) : std::vector<float>();
    Colored::Ptr cloud(new Colored), reflected(new Colored);
    for (std::size_t i = 0; i < scene_.points->size(); ++i) {
      const pcl::PointXYZ& point = (*scene_.points)[i];
      if (!pcl::isXYZFinite(point)) continue;
      add(*cloud, point.getVector3fMap(), plane ? cividis(support[i]) : kPlainPointColor);
      if (plane && reflected_)
        add(*reflected, plane->reflect(point.getVector3fMap().cast<double>()).cast<float>(), distinctColor(5));
    }
    window_.addPointCloud<pcl::PointXYZRGB>(cloud, "cloud");
    window_.setPointCloudRenderingProperties(pcl::visualization::PCL_VISUALIZER_POINT_SIZE, 3, "cloud");
    if (!reflected->empty()) window_.addPointCloud<pcl::PointXYZRGB>(reflected, "reflected");
    std::string text = "no plane";
    if (plane) {
      text = formatted("plane %d of %zu: confidence %.2f, support %.2f", plane_, planes_.size(), plane->confidence,
                       plane->support);
      const PlanePatch patch{plane->normal(), plane->offset()};
      Cloud::Ptr corners(new Cloud);
      for (const Eigen::Vector3d& corner : patchCorners(patch, scene_)) corners->push_back(toPoint(corner));
      window_.addPolygon<pcl::PointXYZ>(corners, patch.color.x(), patch.color.y(), patch.color.z(), "plane");
      using namespace pcl::visualization;
      window_.setShapeRenderingProperties(PCL_VISUALIZER_REPRESENTATION, PCL_VISUALIZER_REPRESENTATION_SURFACE,
                                          "plane");
      window_.setShapeRenderingProperties(PCL_VISUALIZER_OPACITY, 0.5, "plane");
    }
    for (const SymmetryAxis& axis : refinement_.getAxes()) {
      const auto [from, to] = axisEnds({axis.point, axis.direction}, scene_);
      window_.addLine(toPoint(from), toPoint(to), 0.0, 0.0, 0.0, formatted("axis %p", static_cast<const void*>(&axis)));
    }
    window_.addText(text, 10, 26, 14, 0.1, 0.1, 0.1, "title");
    window_.addText(kKeys, 10, 8, 12, 0.4, 0.4, 0.4, "keys");
  }

  static pcl::PointXYZ toPoint(const Eigen::Vector3d& x) {
    return {static_cast<float>(x.x()), static_cast<float>(x.y()), static_cast<float>(x.z())};
  }

  static void add(Colored& cloud, const Eigen::Vector3f& x, const Eigen::Vector3d& color) {
    const Eigen::Matrix<std::uint8_t, 3, 1> bytes = (255.0 * color).cast<std::uint8_t>();
    cloud.emplace_back(x.x(), x.y(), x.z(), bytes.x(), bytes.y(), bytes.z());
  }

  Window& window_;
  SymmetryMaximaRefinement<pcl::PointXYZ>& refinement_;
  const std::vector<SymmetryPlane>& planes_;
  PictureScene scene_;
  int plane_;
  bool reflected_ = false;
};

int run(int argc, char** argv) {
  ViewerOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  if (!options.screenshot_path && !hasDisplay())
    throw InputError("cannot open a window: there is no display that draws with OpenGL; -screenshot FILE needs none");
  const Console console(options.common.quiet);
  const InputShape input = loadInput(console, options.input, options.common);

  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  DetectionOptions detection;
  detection.approximate = !options.symmetries_only;
  options.common.applyTo(detection);
  refinement.setOptions(detection);
  setInput(refinement, input, options.common);
  Step searching(console, "Searching planes");
  const std::size_t num_planes =
      namingFile(options.input, [&] { return checked(refinement, input, refinement.compute()).size(); });
  searching.done(counted(num_planes, "plane"));
  if (options.plane > 1 && options.plane > static_cast<int>(num_planes))
    throw UsageError(formatted("-plane: %d, must be <= %zu, the number of planes", options.plane, num_planes));
  if (options.screenshot_path) requireDisplay(*options.screenshot_path);

  Window window(options.input);
  window.setSize(1000, 750);
  window.setBackgroundColor(1.0, 1.0, 1.0);
  View view(window, input.points, refinement, options.plane);
  PictureScene upright;
  standUpright(upright, options.up.value_or(Eigen::Vector3d::UnitZ()));
  window.setCameraPosition(upright.view.x(), upright.view.y(), upright.view.z(), upright.up.x(), upright.up.y(),
                           upright.up.z());
  window.resetCamera();
  if (options.screenshot_path) {
    window.spinOnce();
    writeAtomically(*options.screenshot_path, [&](const std::string& file) { window.saveScreenshot(file); });
    return 0;
  }
  window.registerKeyboardCallback([&](const pcl::visualization::KeyboardEvent& event) {
    if (event.keyDown()) view.press(event.getKeySym());
  });
  while (!window.wasStopped()) {
    window.spinOnce(20);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
