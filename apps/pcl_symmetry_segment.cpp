/// Parts of a cloud or mesh: labels of points or faces, the tree of parts, a picture.
#include <pcl/common/io.h>
#include <pcl/conversions.h>

#include <boost/algorithm/string.hpp>
#include <boost/filesystem/path.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "console.h"
#include "face_labels.h"
#include "labelled_shape.h"
#include "options.h"
#include "pcl_symmetry/symmetry_segmentation.h"
#include "picture.h"
#include "shape_input.h"
#include "shape_output.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

struct SegmentOptions {
  std::string input;
  std::optional<std::string> output, png_path;
  std::optional<Eigen::Vector3d> up;
  std::string method = "merging", evidence = "all";
  int depth = SplittingOptions().depth, num_parts = 0, size = 800;
  double concavity = 0.0;
  CommonOptions common;
};

CommandLine commandLine(SegmentOptions& o) {
  CommandLine line("pcl_symmetry_segment", "Cuts a cloud or mesh into parts by its symmetries.",
                   "pcl_symmetry_segment bull.off bull.seg -json tree.json -png parts.png");
  line.positional("input", o.input, ".pcd, .ply, .obj, .stl or .off")
      .positional(
          "output", o.output,
          ".pcd or .ply: points with their segment in the field label; .ply of a mesh: with its faces coloured; "
          ".seg: the segment of each face, one a line")
      .text("png", "FILE", o.png_path, "picture: parts in colours")
      .vector("up", o.up, "where up is in the picture, input frame (0,0,1)")
      .number("size", o.size, Range::closed(16, 4096), "edge of the picture, pixels")
      .choice("method", o.method, {"merging", "splitting"},
              "merging: small patches grow to parts; splitting: as in the paper, by support for symmetry planes")
      .choice("evidence", o.evidence, {"all", "concavity", "symmetry"},
              "for merging: symmetry alone, with concavity, or with thickness and line of sight too")
      .number("parts", o.num_parts, Range::closed(0, 10'000), "so many parts; 0: as many as the shape has")
      .number("depth", o.depth, Range::closed(0, 30), "for splitting: splits in a row at most")
      .number("concavity", o.concavity, Range::closed(0, 100), "for splitting: how much concave edges draw the cut")
      .common(o.common, kJson | kSeed | kThreads | kQuiet);
  return line;
}

SegmentationOptions segmentationOptions(const SegmentOptions& o) {
  SegmentationOptions options;
  options.method = o.method == "splitting" ? SegmentationMethod::Splitting : SegmentationMethod::Merging;
  options.merging.evidence = o.evidence == "symmetry"    ? MergingEvidence::Symmetry
                             : o.evidence == "concavity" ? MergingEvidence::SymmetryAndConcavity
                                                         : MergingEvidence::All;
  options.splitting.depth = o.depth;
  options.splitting.concavity_weight = o.concavity;
  options.num_parts = o.num_parts;
  options.seed = o.common.seed + 1;
  options.num_threads = o.common.threads;
  return options;
}

void checkOutput(const SegmentOptions& o, const CommandLine& line) {
  if (o.method == "merging" && (line.given("depth") || line.given("concavity")))
    throw UsageError("-depth and -concavity need -method splitting");
  if (o.method == "splitting" && line.given("evidence")) throw UsageError("-evidence needs -method merging");
  if (o.up && o.up->norm() == 0.0) throw UsageError("-up = 0,0,0, must not be zero");
  if (!o.output) return;
  const std::string extension =
      boost::algorithm::to_lower_copy(boost::filesystem::path(*o.output).extension().string());
  if (extension != ".seg") checkCloudExtension(*o.output);
}

nlohmann::json describe(const SegmentOptions& o, const Shape& shape, const std::vector<pcl::PointIndices>& segments,
                        const std::vector<SegmentNode>& tree, const std::vector<std::vector<int>>& images, double ms) {
  nlohmann::json json{{"file", o.input},
                      {"elements", shape.mesh ? "faces" : "points"},
                      {"segments", nlohmann::json::array()},
                      {"tree", nlohmann::json::array()},
                      {"timing_ms", {{"total", ms}}}};
  for (const pcl::PointIndices& segment : segments) json["segments"].push_back({{"size", segment.indices.size()}});
  for (const SegmentNode& node : tree) {
    nlohmann::json entry{{"parent", node.parent}, {"planes", nlohmann::json::array()}};
    if (node.segment >= 0)
      entry["segment"] = node.segment;
    else
      entry["children"] = node.children;
    for (const PartPlane& plane : node.planes) {
      const Eigen::Vector4d c = plane.plane.coefficients();
      entry["planes"].push_back({{"coefficients", {c[0], c[1], c[2], c[3]}}, {"share", plane.share}});
    }
    json["tree"].push_back(entry);
  }
  json["images"] = images;
  return json;
}

void drawParts(const SegmentOptions& o, const Shape& shape, const std::vector<int>& labels) {
  PictureScene scene;
  scene.points = shape.points;
  scene.mesh = shape.mesh;
  PicturePanel panel;
  panel.segments = labels;
  scene.panels = {panel};
  if (o.up) standUpright(scene, *o.up);
  renderPicture(scene, *o.png_path, o.size, o.size);
}

int run(int argc, char** argv) {
  SegmentOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  checkOutput(options, line);
  const Console console(options.common.quiet);

  Step loading(console, "Loading " + options.input);
  const Shape shape = loadShape(options.input);
  if (options.output && boost::algorithm::iends_with(*options.output, ".seg") && !shape.mesh)
    throw InputError(options.input + ": has no faces, must have for " + *options.output);
  loading.done(shape.mesh ? std::to_string(shape.mesh->polygons.size()) + " faces"
                          : std::to_string(shape.points->size()) + " points");

  Step cutting(console, "Cutting into parts");
  SymmetrySegmentation<pcl::PointXYZ> segmentation;
  SegmentationOptions how = segmentationOptions(options);
  how.progress = [&](double share) { cutting.progress(share); };
  segmentation.setOptions(how);
  if (shape.mesh)
    segmentation.setInputMesh(pcl::make_shared<pcl::PolygonMesh>(*shape.mesh));
  else
    segmentation.setInputCloud(shape.points);
  std::vector<pcl::PointIndices> segments;
  segmentation.segment(segments);
  if (segments.empty()) throw InputError(options.input + ": has no surface to cut");
  const double ms = cutting.done(std::to_string(segments.size()) + (segments.size() == 1 ? " part" : " parts"));

  const std::vector<int>& labels = segmentation.getLabels();
  if (options.output) saveLabelled(*options.output, shape, labels);
  if (options.common.json_path)
    writeText(*options.common.json_path,
              describe(options, shape, segments, segmentation.getTree(), segmentation.getImages(), ms).dump(2) + "\n");
  if (options.png_path) {
    Step drawing(console, "Drawing " + *options.png_path);
    drawParts(options, shape, labels);
    drawing.done();
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
