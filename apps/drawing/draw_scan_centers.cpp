/// Draws Figure 11 of the paper: eight scans of a model, and on the whole model the centers found in each of them, by
/// symmetry and by mass.
#include <pcl/common/centroid.h>

#include <cstdio>
#include <string>
#include <vector>

#include "common/command_line/command_line.h"
#include "common/command_line/run_tool.h"
#include "common/pictures/picture.h"
#include "common/scanner/virtual_scanner.h"
#include "common/shape_input/shape_input.h"
#include "pcl_symmetry/symmetry_alignment.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

void addCross(PicturePanel& panel, const Eigen::Vector3d& center, double half_length, const Eigen::Vector3d& color) {
  for (int k = 0; k < 3; ++k) panel.axes.push_back({center, Eigen::Vector3d::Unit(k), color, half_length});
}

Eigen::Vector3d centerOfSymmetry(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud) {
  SymmetryAlignment<pcl::PointXYZ> alignment;
  alignment.setInputCloud(cloud);
  return alignment.compute().center;
}

int run(int argc, char** argv) {
  if (argc != 3) throw UsageError("usage: draw_scan_centers PNG MODEL");
  constexpr int kNumPoints = 10'000, kPanel = 160;  // chosen: the default of the tools; pixels for ten panels on a page
  constexpr double kCross = 0.04;                   // diagonals; chosen: half is hard to see, twice hides the shape
  const Eigen::Vector3d vermilion(0.84, 0.37, 0.0), green(0.0, 0.62, 0.45);
  const Shape shape = loadShape(argv[2]);
  if (!shape.mesh) throw InputError(std::string(argv[2]) + ": has no faces to scan");
  const VirtualScanner scanner(*shape.mesh);
  VirtualScannerOptions how;
  how.num_points = kNumPoints;

  PictureScene whole;
  whole.points = shape.points;
  whole.mesh = shape.mesh;
  whole.panels = {{"centers of symmetry"}, {"centers of mass"}};
  for (PicturePanel& panel : whole.panels) panel.show_points = false;
  std::vector<PictureScene> scenes;
  for (const Eigen::Vector3d& corner : cubeCorners()) {
    const VirtualScan scan = scanner.scan(corner, how);
    Eigen::Vector4d mass;
    pcl::compute3DCentroid(*scan.cloud, mass);
    const Eigen::Vector3d symmetry = centerOfSymmetry(scan.cloud);
    addCross(whole.panels[0], symmetry, kCross * scanner.diagonal(), vermilion);
    addCross(whole.panels[1], mass.head<3>(), kCross * scanner.diagonal(), green);
    std::printf("center of symmetry %7.3f %7.3f %7.3f   center of mass %7.3f %7.3f %7.3f\n", symmetry.x(), symmetry.y(),
                symmetry.z(), mass.x(), mass.y(), mass.z());
    PictureScene scene;
    scene.points = scan.cloud;
    scene.panels = {PicturePanel{"scan " + std::to_string(scenes.size() + 1)}};
    scenes.push_back(scene);
  }
  scenes.push_back(whole);
  constexpr int kColumns = 5;  // chosen: two rows of a scan and its frame fit a page
  renderPicture(scenes, argv[1], kColumns * kPanel, 2 * kPanel, kColumns);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
