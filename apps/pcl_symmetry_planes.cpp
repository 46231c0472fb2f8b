/// Symmetry planes of a cloud or mesh: a table, JSON, the support of every point, a picture.
#include <pcl/conversions.h>

#include <boost/filesystem/path.hpp>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cloud_fields.h"
#include "console.h"
#include "options.h"
#include "pcl_symmetry/mesh_sampling.h"
#include "pcl_symmetry/symmetry_maxima_refinement.h"
#include "picture.h"
#include "shape_input.h"
#include "shape_output.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

constexpr std::size_t kMaxPanels = 9;

struct PlanesOptions {
  std::string input;
  std::optional<std::string> png_path, support_path;
  int mesh_points = 10'000;
  DetectionOptions detection;
  std::optional<double> sigma;
  CommonOptions common;
};

CommandLine commandLine(PlanesOptions& options) {
  CommandLine line("pcl_symmetry_planes", "Finds the planes of symmetry of a cloud or mesh.",
                   "pcl_symmetry_planes chair.pcd -json planes.json -png planes.png");
  line.positional("input", options.input, ".pcd, .ply, .obj, .stl or .off")
      .text("png", "FILE", options.png_path, "picture: cloud, planes and support, best planes first")
      .text("support", "FILE", options.support_path,
            "cloud with one more field per plane, support_1, support_2 ...: how well the point supports the plane")
      .flag("approximate", options.detection.approximate,
            "also report approximate symmetries and symmetries of parts, marked as such")
      .number("min_confidence", options.detection.min_confidence, Range::closed(0, 1),
              "probability from which on a plane is called a symmetry")
      .number("max_planes", options.detection.max_planes, Range::closed(1, 1000), "planes reported at most")
      .number("sigma", options.sigma, Range::above(0), "width of the Gaussian, input units (two cells)")
      .number("points", options.mesh_points, Range::closed(100, 10'000'000), "points spread over a mesh")
      .common(options.common, kAllCommonFlags);
  return line;
}

/// What was found, best first.
struct Findings {
  std::vector<SymmetryPlane> planes;
  std::vector<SymmetryAxis> axes;
  std::vector<SymmetryCenter> centers;

  bool empty() const { return planes.empty() && axes.empty() && centers.empty(); }
};

const char* toString(PlaneKind kind) {
  switch (kind) {
    case PlaneKind::Symmetry:
      return "symmetry";
    case PlaneKind::Possible:
      return "possible";
    case PlaneKind::Local:
      return "local";
    case PlaneKind::Approximate:
      break;
  }
  return "approximate";
}

nlohmann::json toJson(const Eigen::VectorXd& v) {
  return std::vector<double>(v.data(), v.data() + v.size());
}

void printTable(const Findings& findings) {
  if (findings.empty()) {
    std::printf("no symmetry plane\n");
    return;
  }
  for (const SymmetryCenter& center : findings.centers)
    std::printf("center of all planes: %.6g %.6g %.6g, confidence %.3f\n", center.point.x(), center.point.y(),
                center.point.z(), center.confidence);
  for (const SymmetryAxis& axis : findings.axes)
    std::printf("axis of revolution: through %.6g %.6g %.6g along %.6f %.6f %.6f, confidence %.3f\n", axis.point.x(),
                axis.point.y(), axis.point.z(), axis.direction.x(), axis.direction.y(), axis.direction.z(),
                axis.confidence);
  const std::vector<SymmetryPlane>& planes = findings.planes;
  if (planes.empty()) return;
  std::printf("%5s %10s %10s %10s %12s %10s %7s %7s %6s  %s\n", "plane", "a", "b", "c", "d", "confidence", "support",
              "score", "seen", "kind");
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const Eigen::Vector4d c = planes[i].coefficients();
    std::printf("%5zu %10.6f %10.6f %10.6f %12.6g %10.3f %7.3f %7.3f %6.3f  %s\n", i + 1, c[0], c[1], c[2], c[3],
                planes[i].confidence, planes[i].support, planes[i].score, planes[i].seen, toString(planes[i].kind));
  }
}

nlohmann::json describe(const PlanesOptions& options, const Findings& findings, std::size_t num_points,
                        bool used_viewpoint, const std::vector<std::pair<std::string, double>>& timing_ms) {
  nlohmann::json json{{"file", options.input},
                      {"num_points", num_points},
                      {"partial", used_viewpoint},
                      {"planes", nlohmann::json::array()},
                      {"axes", nlohmann::json::array()},
                      {"centers", nlohmann::json::array()},
                      {"timing_ms", nlohmann::json::object()}};
  for (const SymmetryPlane& plane : findings.planes) {
    json["planes"].push_back({{"coefficients", toJson(plane.coefficients())},
                              {"kind", toString(plane.kind)},
                              {"confidence", plane.confidence},
                              {"score", plane.score},
                              {"support", plane.support},
                              {"seen", plane.seen},
                              {"residual", plane.residual},
                              {"iterations", plane.iterations},
                              {"converged", plane.converged}});
  }
  for (const SymmetryAxis& axis : findings.axes) {
    json["axes"].push_back({{"point", toJson(axis.point)},
                            {"direction", toJson(axis.direction)},
                            {"confidence", axis.confidence},
                            {"score", axis.score},
                            {"support", axis.support}});
  }
  for (const SymmetryCenter& center : findings.centers) {
    json["centers"].push_back({{"point", toJson(center.point)},
                               {"confidence", center.confidence},
                               {"score", center.score},
                               {"support", center.support}});
  }
  for (const auto& [stage, ms] : timing_ms) json["timing_ms"][stage] = ms;
  return json;
}

PictureScene makeScene(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud, const Findings& findings,
                       const std::vector<std::vector<float>>& support) {
  PictureScene scene;
  scene.points = cloud;
  const std::vector<SymmetryPlane>& planes = findings.planes;
  for (const SymmetryAxis& axis : findings.axes) {
    PicturePanel panel;
    char label[96];
    std::snprintf(label, sizeof(label), "axis of revolution: confidence %.2f", axis.confidence);
    panel.label = label;
    panel.axes = {{axis.point, axis.direction}};
    scene.panels.push_back(panel);
  }
  for (const SymmetryCenter& center : findings.centers) {
    PicturePanel panel;
    char label[96];
    std::snprintf(label, sizeof(label), "every plane through the center: confidence %.2f", center.confidence);
    panel.label = label;
    for (int k = 0; k < 3; ++k) panel.axes.push_back({center.point, Eigen::Vector3d::Unit(k)});
    scene.panels.push_back(panel);
  }
  for (std::size_t k = 0; k < planes.size() && scene.panels.size() < kMaxPanels; ++k) {
    PicturePanel panel;
    char label[96];
    std::snprintf(label, sizeof(label), "plane %zu (%s): confidence %.2f, support %.2f", k + 1,
                  toString(planes[k].kind), planes[k].confidence, planes[k].support);
    panel.label = label;
    panel.support.assign(support[k].begin(), support[k].end());
    PlanePatch patch;
    patch.normal = planes[k].normal();
    patch.offset = planes[k].offset();
    patch.color = distinctColor(k);
    panel.planes = {patch};
    scene.panels.push_back(panel);
  }
  if (scene.panels.empty()) scene.panels.push_back({"no symmetry plane"});
  // Off the normals of the planes shown, so that none is seen edge on or face on; see ViewpointSelection for more.
  if (!planes.empty()) {
    const Eigen::Vector3d n = planes[0].normal();
    Eigen::Vector3d across = Eigen::Vector3d::UnitZ() - n.z() * n;
    if (across.norm() < 0.3) across = Eigen::Vector3d::UnitX() - n.x() * n;
    across.normalize();
    const Eigen::Vector3d along = n.cross(across);
    scene.view = 0.75 * n + along + 0.55 * across;
    scene.up = across;
  }
  return scene;
}

int run(int argc, char** argv) {
  PlanesOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  if (options.support_path) checkCloudExtension(*options.support_path);
  const Console console(options.common.quiet);

  Step loading(console, "Loading " + options.input);
  Shape shape = loadShape(options.input);
  const bool from_mesh = shape.mesh.has_value();
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud = shape.points;
  if (from_mesh) cloud = sampleMesh(*shape.mesh, options.mesh_points, options.common.seed + 1);
  const double loading_ms = loading.done(std::to_string(cloud->size()) + " points");

  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  DetectionOptions& detection = options.detection;
  detection.seed = options.common.seed + 1;
  detection.num_threads = detection.edt.num_threads = options.common.threads;
  detection.edt.num_cells = options.common.grid;
  detection.edt.sigma = options.sigma.value_or(0.0);
  refinement.setViewpoint(options.common.viewpoint);
  Step searching(console, "Searching planes");
  Findings findings;
  try {
    refinement.setOptions(detection);
    refinement.setInputCloud(cloud);
    findings.planes = refinement.compute();
    if (!refinement.getReason().empty()) throw InputError(options.input + ": " + refinement.getReason());
    findings.axes = refinement.getAxes();
    findings.centers = refinement.getCenters();
  } catch (const pcl::BadArgumentException& error) {
    throw InputError(options.input + ": " + error.detailedMessage());
  }
  const std::vector<SymmetryPlane>& planes = findings.planes;
  std::string summary = std::to_string(planes.size()) + (planes.size() == 1 ? " plane" : " planes");
  if (!findings.axes.empty()) summary += ", " + std::to_string(findings.axes.size()) + " axes";
  if (refinement.usedViewpoint()) summary += ", seen from one side";
  const double searching_ms = searching.done(summary);

  std::vector<std::vector<float>> support;
  if (options.support_path || options.png_path)
    for (const SymmetryPlane& plane : planes) support.push_back(refinement.computePointSupport(plane));

  printTable(findings);
  if (options.common.json_path) {
    auto timing_ms = refinement.getTiming();
    timing_ms.emplace_back("load", loading_ms);
    timing_ms.emplace_back("total", searching_ms);
    writeText(
        *options.common.json_path,
        describe(options, findings, refinement.getUsedIndices().size(), refinement.usedViewpoint(), timing_ms).dump(2) +
            "\n");
  }
  if (options.support_path) {
    pcl::PCLPointCloud2 base = shape.cloud;
    if (from_mesh) pcl::toPCLPointCloud2(*cloud, base);
    std::vector<std::string> names;
    for (std::size_t k = 0; k < support.size(); ++k) names.push_back("support_" + std::to_string(k + 1));
    saveCloud(*options.support_path, withFields(base, names, support), shape.sensor_origin, shape.sensor_orientation);
  }
  if (options.png_path) {
    Step drawing(console, "Drawing " + *options.png_path);
    PictureScene scene = makeScene(cloud, findings, support);
    renderPicture(scene, *options.png_path, scene.panels.size() > 1 ? 1400 : 800, scene.panels.size() > 2 ? 1100 : 600);
    drawing.done();
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
