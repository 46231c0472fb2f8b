/// Good and bad views of a cloud or mesh, by the symmetries that they show: a table, JSON with camera poses, pictures.
#include <pcl/conversions.h>

#include <cmath>

#include "command_line/run_on_files.h"
#include "core/base/constants.h"
#include "io/answers.h"
#include "io/input_shape.h"
#include "io/shape_output.h"
#include "pcl_symmetry/symmetry_maxima_refinement.h"
#include "pcl_symmetry/viewpoint_selection.h"
#include "pictures/picture.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

struct ViewpointToolOptions {
  BatchOptions batch;
  std::optional<std::string> png_path, icon_path;
  std::optional<Eigen::Vector3d> up;
  int num_views = 4, size = 400;
  double separation = 40.0;  // degrees
  bool as_published = false;
  CommonOptions common;
};

CommandLine commandLine(ViewpointToolOptions& options) {
  CommandLine line("pcl_symmetry_viewpoint", "Chooses views of a cloud or mesh that show little symmetry.",
                   "pcl_symmetry_viewpoint chair.off -up 0,1,0 -png chair_views.png -json chair_views.json");
  options.batch.outputs = {&options.png_path, &options.icon_path};
  line.positionals("input", options.batch.inputs, kManyInputs)
      .text("png", "FILE.png", options.png_path, "picture: score of all directions, best view, worst view")
      .text("icon", "FILE.png", options.icon_path, "picture of the best view alone")
      .direction("up", options.up, "direction that is about up, input frame (0,0,1)")
      .number("views", options.num_views, Range::closed(1, 100), "largest number of good views")
      .number("separation", options.separation, Range::closed(0, 180), "least angle between good views, degrees")
      .flag("as_published", options.as_published,
            "the paper's sum: over all maxima of the exact map as Section 4.4 refines them")
      .number("size", options.size, Range::closed(16, 4096), "edge of each view, pixels")
      .common(options.common, kShapeFlags);
  options.batch.addTo(line);
  return line;
}

nlohmann::json toJson(const SelectedView& view, const Eigen::Vector3d& shift) {
  const Eigen::Isometry3d pose(view.pose.matrix().cast<double>());
  return {{"direction", numbersOf(view.direction)},
          {"score", view.score},
          {"pose", rowMajor(shiftedBack(pose, Eigen::Vector3d::Zero(), shift))}};
}

PictureScene sceneOf(const InputShape& input, const SelectedView& view, const std::string& label) {
  PicturePanel panel{label};
  panel.show_points = !input.shape.mesh;
  return {input.points, input.shape.mesh, {panel}, view.direction, -view.pose.linear().col(1).cast<double>()};
}

/// The score as a spherical function (Figure 16): directions scaled and colored by the score.
PictureScene scoreSphere(const ViewpointSelection& selection, const SelectedView& best, const SelectedView& worst) {
  constexpr int kRings = 120, kAround = 240;  // 1.5 degrees
  const Eigen::Vector3d up = selection.getUpAxis(), side = up.unitOrthogonal(), front = up.cross(side);
  Cloud::Ptr surface(new Cloud);
  PicturePanel panel{"score of each direction"};
  panel.show_points = false;
  const double range = std::max(best.score - worst.score, 1e-9);
  for (int ring = 0; ring <= kRings; ++ring) {
    for (int k = 0; k < kAround; ++k) {
      const double theta = kPi * ring / kRings, phi = 2.0 * kPi * k / kAround;
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
  // Beside the best view, so that its peak is seen in profile.
  Eigen::Vector3d view = Eigen::AngleAxisd(0.3 * kPi, up) * best.direction + 0.2 * up;
  if (view.normalized().cross(up).norm() < 0.2) view = side + 0.5 * up;
  return {surface, mesh, {panel}, view, up, false};
}

/// Selects views by the local maxima of the transform of the cloud.
/// \return milliseconds.
double choose(ViewpointSelection& selection, const InputShape& input, const ViewpointToolOptions& options,
              const FileJob& job) {
  DetectionOptions detection;
  detection.approximate = true;
  job.common.applyTo(detection);
  Step searching(job.console, "Searching planes");
  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  const std::vector<SymmetryPlane> planes = namingFile(input.path, [&] {
    refinement.setOptions(detection);
    refinement.setAsPublished(options.as_published);
    setInput(refinement, input, job.common);
    return checked(refinement, input, refinement.compute());
  });
  if (options.as_published)
    selection.setPlanes(planes);
  else
    selection.setPlanes(planes, refinement.getAxes(),
                        findLocalMaxima(refinement.getSymmetryMap(), detection.expert.maxima));
  selection.setInputCloud(input.points);
  if (options.up) selection.setUp(*options.up);
  selection.setSeparation(options.separation * kPi / 180.0);
  return searching.done(counted(planes.size(), "plane") + ", " + counted(refinement.getAxes().size(), "axis", "axes"));
}

struct ChosenViews {
  std::vector<SelectedView> good;
  SelectedView worst;
};

/// A line of the table, an entry of the JSON and a row for each view.
FileReport reportOf(const InputShape& input, const ViewpointSelection& selection, const ChosenViews& views) {
  FileReport report;
  report.text = formatted("%-6s %9s %9s %9s %7s\n", "view", "x", "y", "z", "score");
  report.json = {{"file", input.path},
                 {"up", numbersOf(selection.getUpAxis())},
                 {"best", toJson(views.good[0], input.shift())},
                 {"worst", toJson(views.worst, input.shift())},
                 {"good", nlohmann::json::array()}};
  const auto add = [&](const char* kind, const SelectedView& view) {
    const Eigen::Vector3d& d = view.direction;
    report.text += formatted("%-6s %9.6f %9.6f %9.6f %7.3f\n", kind, d.x(), d.y(), d.z(), view.score);
    report.rows.push_back({kind, d.x(), d.y(), d.z(), view.score});
  };
  for (const SelectedView& view : views.good) {
    add(report.rows.empty() ? "best" : "good", view);
    report.json["good"].push_back(toJson(view, input.shift()));
  }
  add("worst", views.worst);
  return report;
}

void draw(const FileJob& job, const ViewpointToolOptions& options, const InputShape& input,
          const ViewpointSelection& selection, const ChosenViews& views) {
  const SelectedView& best = views.good[0];
  if (options.icon_path)
    renderPicture({sceneOf(input, best, "")}, job.output(*options.icon_path), options.size, options.size);
  if (!options.png_path) return;
  const std::string picture = job.output(*options.png_path);
  Step drawing(job.console, "Drawing " + picture);
  renderPicture({scoreSphere(selection, best, views.worst), sceneOf(input, best, "best view"),
                 sceneOf(input, views.worst, "worst view")},
                picture, 3 * options.size, options.size, 3);
  drawing.done();
}

void analyze(const ViewpointToolOptions& options, FileJob& job) {
  const InputShape input = loadInput(job.console, job.path, options.common);
  ViewpointSelection selection;
  const double searching_ms = choose(selection, input, options, job);
  Step choosing(job.console, "Choosing views");
  const ChosenViews views{selection.getGoodViews(options.num_views), selection.getWorstView()};
  const double choosing_ms = choosing.done(counted(views.good.size(), "view"));
  FileReport report = reportOf(input, selection, views);
  report.json["timing_ms"] = {{"load", input.loading_ms}, {"planes", searching_ms}, {"views", choosing_ms}};
  job.report(std::move(report));
  draw(job, options, input, selection, views);
}

int run(int argc, char** argv) {
  ViewpointToolOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  line.goWith("-png or -icon", options.png_path || options.icon_path, {"size"});
  line.goWith("the decision, which -as_published leaves out", !options.as_published, {"viewpoint"});
  line.goWith("-views 2 or more", options.num_views > 1, {"separation"});
  return runOnFiles(options.batch, options.common, {"view", "x", "y", "z", "score"},
                    [&](FileJob& job) { analyze(options, job); });
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
