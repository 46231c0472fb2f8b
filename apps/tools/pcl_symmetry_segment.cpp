/// Parts of a cloud or mesh: labels of points or faces, the tree of parts, a picture.
#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem/path.hpp>

#include "command_line/run_on_files.h"
#include "io/answers.h"
#include "io/input_shape.h"
#include "io/mesh_output.h"
#include "io/shape_output.h"
#include "pcl_symmetry/symmetry_segmentation.h"
#include "pictures/scene_page.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

struct SegmentOptions {
  BatchOptions batch;
  std::string input;
  std::optional<std::string> output, png_path, html_path;
  std::optional<Eigen::Vector3d> up;
  std::string method = "merging", evidence = "all";
  SegmentationOptions segmentation;
  int size = 800;
  CommonOptions common;
};

CommandLine commandLine(SegmentOptions& o) {
  CommandLine line("pcl_symmetry_segment", "Cuts a cloud or mesh into parts by its symmetries.",
                   "pcl_symmetry_segment bull.off bull.seg -json tree.json -png parts.png");
  o.batch.outputs = {&o.output, &o.png_path, &o.html_path};
  line.positional("input", o.input, kOneOrManyInputs)
      .positional("output", o.output,
                  ".pcd or .ply: points with their segment in the field label; .ply of a mesh: with its faces colored; "
                  ".seg: the segment of each face, one a line")
      .text("png", "FILE.png", o.png_path, "picture: parts in colors")
      .text("html", "FILE.html", o.html_path,
            "page with the same in three dimensions, for any browser, without network")
      .direction("up", o.up, "direction that is up in the picture, input frame (0,0,1)")
      .number("size", o.size, Range::closed(16, 4096), "edge of the picture, pixels")
      .choice("method", o.method, {"merging", "splitting"},
              "merging: small patches grow to parts; splitting: as in the paper, by support for symmetry planes")
      .choice("evidence", o.evidence, {"all", "concavity"},
              "for merging: symmetry and concavity, for scans from one side, or thickness and line of sight too")
      .number("parts", o.segmentation.num_parts, Range::closed(0, 10'000),
              "number of parts, where the shape allows it; 0: as many as it has")
      .flag("as_published", o.segmentation.splitting.as_published,
            "for splitting: to the letter of Sections 4.4 and 5.3")
      .number("depth", o.segmentation.splitting.depth, Range::closed(0, 30),
              "for splitting: largest number of splits from the whole to a part")
      .number("concavity", o.segmentation.splitting.concavity_weight, Range::closed(0, 100),
              "for splitting: weight of concave edges, which attract the cut")
      .common(o.common, kJson | kSeed | kThreads | kQuiet);
  o.batch.addTo(line);
  return line;
}

void checkOutput(const SegmentOptions& o, const CommandLine& line) {
  line.goWith("-method splitting and -parts 0", o.method == "splitting" && o.segmentation.num_parts == 0, {"depth"});
  line.goWith("-method splitting", o.method == "splitting", {"concavity", "as_published"});
  line.goWith("-method merging", o.method == "merging", {"evidence"});
  line.goWith("-png", o.png_path.has_value(), {"size"});
  line.goWith("-png or -html", o.png_path || o.html_path, {"up"});
  if (!o.output) return;
  const std::string extension =
      boost::algorithm::to_lower_copy(boost::filesystem::path(*o.output).extension().string());
  if (extension != ".seg" && extension != ".pcd" && extension != ".ply")
    throw UsageError(*o.output + ": unknown extension, must be .pcd, .ply or, for a mesh, .seg");
}

nlohmann::json describe(const std::string& path, const Shape& shape, const std::vector<pcl::PointIndices>& segments,
                        const SymmetrySegmentation<pcl::PointXYZ>& segmentation, double ms) {
  const auto segmentJson = [](const pcl::PointIndices& segment) -> nlohmann::json {
    return {{"size", segment.indices.size()}};
  };
  const auto planeJson = [&](const PartPlane& plane) -> nlohmann::json {
    return {{"coefficients", numbersOf(plane.plane, shape.shift)}, {"share", plane.share}};
  };
  const auto nodeJson = [&](const SegmentNode& node) {
    nlohmann::json json{{"parent", node.parent}, {"planes", listOf(node.planes, planeJson)}};
    if (node.segment >= 0)
      json["segment"] = node.segment;
    else
      json["children"] = node.children;
    return json;
  };
  return {{"file", path},
          {"elements", shape.mesh ? "faces" : "points"},
          {"segments", listOf(segments, segmentJson)},
          {"tree", listOf(segmentation.getTree(), nodeJson)},
          {"images", segmentation.getImages()},
          {"timing_ms", {{"total", ms}}}};
}

PictureScene sceneOf(const SegmentOptions& o, const Shape& shape, const std::vector<int>& labels) {
  PicturePanel panel;
  panel.segments = labels;
  for (int part = 0; part <= *std::max_element(labels.begin(), labels.end()); ++part)
    panel.legend.emplace_back(part, std::to_string(part));
  PictureScene scene{shape.points, shape.mesh, {panel}};
  if (o.up) standUpright(scene, *o.up);
  return scene;
}

Shape load(const FileJob& job, const SegmentOptions& o) {
  Step loading(job.console, "Loading " + job.path);
  Shape shape = loadShape(job.path);
  if (o.output && boost::algorithm::iends_with(*o.output, ".seg") && !shape.mesh)
    throw InputError(job.path + ": has no faces, must have for " + *o.output);
  loading.done(shape.mesh ? counted(shape.mesh->polygons.size(), "face")
                          : counted(finitePoints(*shape.points).cols(), "point"));
  warnOfLeftOut(job.console, job.path, shape);
  return shape;
}

/// \return the parts, which the segmentation labels; \p ms is the time in milliseconds.
std::vector<pcl::PointIndices> cut(const FileJob& job, const SegmentOptions& o, const Shape& shape,
                                   SymmetrySegmentation<pcl::PointXYZ>& segmentation, double& ms) {
  Step cutting(job.console, "Cutting into parts");
  SegmentationOptions how = o.segmentation;
  how.method = o.method == "splitting" ? SegmentationMethod::Splitting : SegmentationMethod::Merging;
  how.evidence = o.evidence == "all" ? MergingEvidence::All : MergingEvidence::SymmetryAndConcavity;
  how.seed = job.common.seed;
  how.num_threads = job.common.threads;
  how.progress = [&](double share) { cutting.progress(share); };
  std::vector<pcl::PointIndices> segments;
  namingFile(job.path, [&] {
    segmentation.setOptions(how);
    if (shape.mesh)
      segmentation.setInputMesh(pcl::make_shared<pcl::PolygonMesh>(*shape.mesh));
    else
      segmentation.setInputCloud(shape.points);
    segmentation.segment(segments);
  });
  if (segments.empty()) throw InputError(job.path + ": " + segmentation.getReason());
  ms = cutting.done(counted(segments.size(), "part"));
  if (!segmentation.getReason().empty()) job.console.warn(job.path + ": " + segmentation.getReason());
  return segments;
}

void analyze(const SegmentOptions& options, FileJob& job) {
  const Shape shape = load(job, options);
  SymmetrySegmentation<pcl::PointXYZ> segmentation;
  double ms = 0.0;
  const std::vector<pcl::PointIndices> segments = cut(job, options, shape, segmentation, ms);
  const std::vector<int>& labels = segmentation.getLabels();
  Rows rows;
  for (std::size_t i = 0; i < segments.size(); ++i) rows.push_back({i, segments[i].indices.size()});
  const std::string least = segments.size() > 1 ? std::to_string(segments.back().indices.size()) + " to " : "",
                    text = counted(segments.size(), "part") + " of " + least +
                           counted(segments.front().indices.size(), shape.mesh ? "face" : "point") + "\n";
  nlohmann::json json = describe(job.path, shape, segments, segmentation, ms);
  if (!segmentation.getReason().empty()) json["reason"] = segmentation.getReason();
  job.report({text, json, rows});
  if (options.output) saveLabeled(job.output(*options.output), shape, labels);
  if (options.html_path) {
    PictureScene scene = sceneOf(options, shape, labels);
    scene.panels[0].label = counted(segments.size(), "part");
    constexpr int kMostPanels = 12;  // each has its own colors in the page
    for (int part = 0; part < std::min<int>(kMostPanels, segments.size()); ++part) {
      PicturePanel alone;
      for (const int label : labels) alone.segments.push_back(label == part ? part : -1);
      alone.label =
          formatted("part %d: ", part + 1) + counted(segments[part].indices.size(), shape.mesh ? "face" : "point");
      scene.panels.push_back(std::move(alone));
    }
    writePage(scene, {job.path, text}, job.output(*options.html_path));
  }
  if (!options.png_path) return;
  const std::string picture = job.output(*options.png_path);
  Step drawing(job.console, "Drawing " + picture);
  renderPicture({sceneOf(options, shape, labels)}, picture, options.size, options.size);
  drawing.done();
}

int run(int argc, char** argv) {
  SegmentOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  checkOutput(options, line);
  options.batch.inputs = {options.input};
  return runOnFiles(options.batch, options.common, {"part", "size"}, [&](FileJob& job) { analyze(options, job); });
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
