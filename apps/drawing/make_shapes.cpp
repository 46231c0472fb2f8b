/// Writes shapes of our own as PLY, for the gallery: familiar objects that no package brings.
#include <pcl/io/ply_io.h>

#include <boost/filesystem.hpp>
#include <cmath>
#include <vector>

#include "common/command_line/command_line.h"
#include "common/command_line/run_tool.h"
#include "common/command_line/tool_errors.h"
#include "common/shape_output/shape_output.h"
#include "core/base/constants.h"
#include "drawing/mug_mesh.h"
#include "drawing/parametric_mesh.h"
#include "drawing/solids.h"

namespace {

using namespace pcl_symmetry::apps;
using Eigen::AlignedBox3d;
using Eigen::Vector3d;
using pcl_symmetry::kPi;

/// In the manner of the one in Utah.
pcl::PolygonMesh teapot() {
  const Solid body = common(ellipsoid({0, 0, 0}, {1.05, 1.05, 0.8}), box({0, 0, -0.02}, {2, 2, 0.62}));
  const Solid pot = joined({body, ring({0, 0, 0.6}, 0.64, 0.05), ellipsoid({0, 0, 0.58}, {0.6, 0.6, 0.2}),
                            ellipsoid({0, 0, 0.86}, {0.13, 0.13, 0.11})},
                           0.05);
  const Solid handle =
      tube({Vector3d(-0.8, 0, 0.4), {-1.75, 0, 0.6}, {-1.85, 0, -0.25}, {-0.85, 0, -0.38}}, 0.09, 0.09);
  const Solid spout = tube({Vector3d(0.7, 0, -0.25), {1.55, 0, -0.4}, {1.25, 0, 0.45}, {1.85, 0, 0.58}}, 0.33, 0.1);
  return surfaceOf(joined({pot, handle, spout}, 0.08), AlignedBox3d(Vector3d(-2, -1.2, -0.8), Vector3d(2.1, 1.2, 1.1)),
                   110);
}

/// Each arm in another pose.
pcl::PolygonMesh octopus() {
  std::vector<Solid> parts{ellipsoid({-0.05, 0, 1.0}, {0.62, 0.62, 0.8})};
  // chosen: arms that are all bent differently.
  constexpr double kBends[] = {0.25, -0.35, 0.1, 0.45, -0.2, 0.35, -0.45, -0.05};
  for (int i = 0; i < 8; ++i) {
    const double angle = 2.0 * kPi * (i + 0.5) / 8, bend = kBends[i];
    const Eigen::AngleAxisd turn(angle, Vector3d::UnitZ());
    parts.push_back(
        tube({turn * Vector3d(0.3, 0, 0.35), turn * Vector3d(0.9, 0, 0.5), turn * Vector3d(1.3, 0.3 * bend, -0.35),
              turn * Vector3d(2.1 - std::abs(bend), 1.6 * bend, bend)},
             0.19, 0.06));
  }
  return surfaceOf(joined(parts, 0.12), AlignedBox3d(Vector3d(-2.4, -2.4, -0.8), Vector3d(2.4, 2.4, 1.95)), 130);
}

pcl::PolygonMesh car() {
  std::vector<Solid> parts{box({0, 0, 0.65}, {2.1, 0.85, 0.33}, 0.18), box({-0.3, 0, 1.1}, {1.1, 0.75, 0.38}, 0.28)};
  for (const double x : {-1.25, 1.3})
    for (const double y : {-0.75, 0.75}) parts.push_back(wheel({x, y, 0.38}, 0.38, 0.14));
  return surfaceOf(joined(parts, 0.04), AlignedBox3d(Vector3d(-2.3, -1.1, -0.1), Vector3d(2.3, 1.1, 1.6)), 130);
}

pcl::PolygonMesh airplane() {
  // Wings: tubes pressed flat.
  const auto wing = [](const Vector3d& root, const Vector3d& tip, double from, double to) -> Solid {
    constexpr double kFlat = 5.0;  // chosen: thickness of a wing against its chord, as of a toy
    const Solid round = tube({root, root, tip, tip}, from, to);
    return [=](const Vector3d& x) { return round({x.x(), x.y(), kFlat * x.z()}) / kFlat; };
  };
  std::vector<Solid> parts{tube({Vector3d(1.7, 0, 0), {0.8, 0, 0}, {-1.0, 0, 0}, {-2.1, 0, 0.12}}, 0.27, 0.12),
                           ellipsoid({1.7, 0, 0}, {0.5, 0.27, 0.27}),
                           tube({Vector3d(-1.9, 0, 0.1), {-2.0, 0, 0.3}, {-2.1, 0, 0.5}, {-2.3, 0, 0.75}}, 0.12, 0.08)};
  for (const double side : {-1.0, 1.0}) {
    parts.push_back(wing({0.25, 0.2 * side, -0.3}, {-0.65, 2.1 * side, 0.3}, 0.42, 0.2));
    parts.push_back(wing({-1.9, 0.1 * side, 0.6}, {-2.25, 0.8 * side, 0.7}, 0.22, 0.12));
    parts.push_back(tube({Vector3d(0.4, 0.75 * side, -0.2),
                          {0.3, 0.75 * side, -0.2},
                          {0.0, 0.75 * side, -0.2},
                          {-0.15, 0.75 * side, -0.2}},
                         0.13, 0.1));
  }
  return surfaceOf(joined(parts, 0.05), AlignedBox3d(Vector3d(-2.6, -2.5, -0.6), Vector3d(2.4, 2.5, 1.0)), 150);
}

AlignedBox3d bounds(double x, double y, double z, double dx, double dy, double dz) {
  return {Vector3d(x, y, z), Vector3d(x + dx, y + dy, z + dz)};
}

pcl::PolygonMesh chair() {
  ParametricMesh mesh;
  mesh.addBox(bounds(-0.5, -0.5, 0.85, 1.0, 1.0, 0.1));
  mesh.addBox(bounds(-0.5, -0.5, 0.95, 0.08, 1.0, 1.05));
  for (const double x : {-0.5, 0.4})
    for (const double y : {-0.5, 0.4}) mesh.addBox(bounds(x, y, 0.0, 0.1, 0.1, 0.85));
  return mesh.polygonMesh();
}

/// A milk carton with a gable and the fin on it.
pcl::PolygonMesh carton() {
  constexpr double kHalf = 0.48, kWall = 1.9, kRidge = 2.4, kFin = 0.18;  // chosen: the look of a milk carton
  ParametricMesh mesh;
  mesh.addBox(bounds(-kHalf, -kHalf, 0.0, 2.0 * kHalf, 2.0 * kHalf, kWall));
  const auto roof = [=](double side) {
    return [=](double u, double v) {
      return Vector3d(kHalf * (2.0 * u - 1.0), side * kHalf * (1.0 - v), kWall + (kRidge - kWall) * v);
    };
  };
  const auto gable = [=](double side) {
    return [=](double u, double v) {
      return Vector3d(side * kHalf * (1.0 - 0.5 * v * (1.0 - std::abs(2.0 * u - 1.0))),
                      kHalf * (2.0 * u - 1.0) * (1.0 - v), kWall + (kRidge - kWall) * v);
    };
  };
  for (const double side : {-1.0, 1.0}) {
    mesh.addSurface(1, 1, roof(side));
    mesh.addSurface(2, 1, gable(side));
  }
  mesh.addBox(bounds(-kHalf, -0.02, kRidge, 2.0 * kHalf, 0.04, kFin));
  return mesh.polygonMesh();
}

/// A solid turned by an angle about z.
Solid turnedAboutZ(const Solid& solid, double angle) {
  const Eigen::Matrix3d back = Eigen::AngleAxisd(-angle, Vector3d::UnitZ()).toRotationMatrix();
  return [=](const Vector3d& x) { return solid(back * x); };
}

/// Three pitched blades on a hub: turns without a plane.
pcl::PolygonMesh propeller() {
  constexpr double kFlat = 4.0, kPitch = 0.6;  // chosen: chord over thickness, and radians: a propeller of a boat
  const Eigen::Matrix3d pitch = Eigen::AngleAxisd(-kPitch, Vector3d::UnitX()).toRotationMatrix();
  const Solid round = ellipsoid({1.05, 0, 0}, {0.85, 0.42, 0.42});
  const Solid blade = [=](const Vector3d& x) {
    const Vector3d y = pitch * x;
    return round({y.x(), y.y(), kFlat * y.z()}) / kFlat;
  };
  std::vector<Solid> parts{ellipsoid({0, 0, 0}, {0.36, 0.36, 0.5})};
  for (int k = 0; k < 3; ++k) parts.push_back(turnedAboutZ(blade, 2.0 * kPi * k / 3));
  return surfaceOf(joined(parts, 0.05), AlignedBox3d(Vector3d(-2, -2, -0.7), Vector3d(2, 2, 0.7)), 130);
}

/// The wheel of a car without its tyre.
pcl::PolygonMesh rim() {
  std::vector<Solid> parts{ellipsoid({0, 0, 0.15}, {0.3, 0.3, 0.15}), ring({0, 0, 0.2}, 1.35, 0.12),
                           ring({0, 0, -0.3}, 1.35, 0.12), ring({0, 0, -0.05}, 1.3, 0.17)};
  const Solid spoke = tube({Vector3d(0.1, 0, 0.15), {0.5, 0, 0.25}, {0.9, 0, 0.25}, {1.35, 0, 0.1}}, 0.17, 0.12);
  for (int k = 0; k < 5; ++k) parts.push_back(turnedAboutZ(spoke, 2.0 * kPi * k / 5));
  return surfaceOf(joined(parts, 0.06), AlignedBox3d(Vector3d(-1.7, -1.7, -0.6), Vector3d(1.7, 1.7, 0.6)), 130);
}

pcl::PolygonMesh bottle() {
  ParametricMesh mesh;
  mesh.addTurned({{0.0, 0.0},
                  {0.42, 0.0},
                  {0.45, 0.08},
                  {0.45, 1.3},
                  {0.38, 1.55},
                  {0.17, 1.85},
                  {0.15, 2.3},
                  {0.19, 2.32},
                  {0.19, 2.42},
                  {0.0, 2.42}});
  return mesh.polygonMesh();
}

int run(int argc, char** argv) {
  if (argc != 2 || argv[1][0] == '-') throw UsageError("usage: make_shapes FOLDER");
  const boost::filesystem::path folder(argv[1]);
  makeFolder(folder.string());
  const std::pair<const char*, pcl::PolygonMesh> shapes[] = {
      {"teapot", teapot()},     {"octopus", octopus()}, {"mug", mug(0.9, 0.9)}, {"car", car()},
      {"airplane", airplane()}, {"chair", chair()},     {"carton", carton()},   {"propeller", propeller()},
      {"rim", rim()},           {"bottle", bottle()}};
  for (const auto& [name, mesh] : shapes) {
    const std::string path = (folder / (std::string(name) + ".ply")).string();
    if (pcl::io::savePLYFileBinary(path, mesh) < 0) throw InputError(path + ": cannot be written");
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
