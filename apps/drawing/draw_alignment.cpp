/// Draws Figure 10 of the paper with shapes of our own: mugs with handles of different sizes and mailboxes on different
/// stands, with their centers and axes: center of mass and PCA above, center of symmetry and principal symmetry axes
/// below.
#include <cmath>
#include <cstdio>
#include <vector>

#include "common/command_line/command_line.h"
#include "common/command_line/run_tool.h"
#include "common/command_line/tool_errors.h"
#include "common/pictures/picture.h"
#include "core/base/constants.h"
#include "core/geometry/principal_axes.h"
#include "drawing/frame_axes.h"
#include "drawing/mug_mesh.h"
#include "drawing/parametric_mesh.h"
#include "pcl_symmetry/mesh_sampling.h"
#include "pcl_symmetry/symmetry_alignment.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;
using Cloud = pcl::PointCloud<pcl::PointXYZ>;

constexpr int kNumPoints = 10'000;  // chosen: the default of the tools

/// A box with a round roof.
/// \param stand the boxes that it stands on, corner to corner.
pcl::PolygonMesh mailbox(const std::vector<Eigen::AlignedBox3d>& stand) {
  constexpr double kLength = 3.0, kHalfWidth = 0.8, kWall = 0.9;  // chosen: the look of a mailbox
  const auto outline = [&](double u) -> Eigen::Vector2d {         // once around: floor, wall, roof, wall
    if (u < 0.25) return {kHalfWidth * (1.0 - 8.0 * u), 0.0};
    if (u < 0.4) return {-kHalfWidth, kWall * (u - 0.25) / 0.15};
    if (u > 0.85) return {kHalfWidth, kWall * (1.0 - u) / 0.15};
    const double angle = kPi * (1.0 - (u - 0.4) / 0.45);
    return {kHalfWidth * std::cos(angle), kWall + kHalfWidth * std::sin(angle)};
  };
  const auto at = [&](double u, double shrink, double y) {
    const Eigen::Vector2d p =
        Eigen::Vector2d(0.0, 0.5 * kWall) + shrink * (outline(u) - Eigen::Vector2d(0.0, 0.5 * kWall));
    return Eigen::Vector3d(p.x(), y, p.y());
  };
  ParametricMesh mesh;
  mesh.addSurface(80, 1, [&](double u, double v) { return at(u, 1.0, kLength * (v - 0.5)); });
  for (const double end : {-0.5, 0.5})
    mesh.addSurface(80, 1, [&](double u, double v) { return at(u, v, kLength * end); });
  for (const Eigen::AlignedBox3d& box : stand) mesh.addBox(box);
  return mesh.polygonMesh();
}

std::vector<pcl::PolygonMesh> shapes() {
  const auto box = [](double x, double y, double z, double dx, double dy, double dz) {
    return Eigen::AlignedBox3d(Eigen::Vector3d(x, y, z), Eigen::Vector3d(x + dx, y + dy, z + dz));
  };
  return {mug(0.5, 0.6),
          mug(0.9, 0.9),
          mug(1.5, 1.0),
          mailbox({box(-0.12, -0.12, -1.6, 0.24, 0.24, 1.6)}),
          mailbox({box(-0.12, 0.9, -2.6, 0.24, 0.24, 2.6)}),
          mailbox({box(-0.12, -1.2, -2.0, 0.24, 0.24, 2.0), box(-0.7, -1.8, -2.1, 1.4, 1.4, 0.1)})};
}

PicturePanel panelOf(const std::string& label, const Eigen::Vector3d& center, const Eigen::Matrix3d& axes) {
  PicturePanel panel;
  panel.label = label;
  addAxes(panel, center, axes);
  return panel;
}

int run(int argc, char** argv) {
  if (argc != 2) throw UsageError("one argument, the PNG file, must be given");
  std::vector<PictureScene> mass, symmetry;
  for (const pcl::PolygonMesh& mesh : shapes()) {
    const Cloud::Ptr cloud = sampleMesh(mesh, kNumPoints);
    PictureScene scene;
    scene.points = cloud;
    scene.view = {0.9, -1.6, 0.7};
    const PrincipalAxes pca = principalAxes(cloud->getMatrixXfMap(3, 4, 0));
    scene.panels = {panelOf(mass.empty() ? "center of mass, PCA" : "", pca.center, pca.axes)};
    mass.push_back(scene);
    SymmetryAlignment<pcl::PointXYZ> alignment;
    alignment.setInputCloud(cloud);
    const SymmetryFrame frame = alignment.compute();
    scene.panels = {
        panelOf(symmetry.empty() ? "center of symmetry, principal symmetry axes" : "", frame.center, frame.axes)};
    symmetry.push_back(scene);
    std::printf("distance of the two centers %.3f\n", (pca.center - frame.center).norm());
  }
  const int columns = static_cast<int>(mass.size());
  mass.insert(mass.end(), symmetry.begin(), symmetry.end());
  renderPicture(mass, argv[1], 300 * columns, 620, columns);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
