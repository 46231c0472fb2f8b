/// A virtual range scanner: a mesh seen from one side, or from the eight corners of a cube (Section 5.1).
#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <boost/filesystem/path.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "command_line/command_line.h"
#include "command_line/console.h"
#include "command_line/tool_errors.h"
#include "core/base/constants.h"
#include "io/answers.h"
#include "io/exact_coordinates.h"
#include "io/input_shape.h"
#include "io/shape_output.h"
#include "scanner/virtual_scanner.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

struct ScanOptions {
  std::string input, output;
  std::optional<Eigen::Vector3d> direction;
  std::optional<int> corner;
  bool all = false;
  std::optional<double> field_of_view;  ///< degrees; not set: wide enough
  std::string format = "binary_compressed";
  VirtualScannerOptions scanner;
  CommonOptions common;
};

struct View {
  Eigen::Vector3d direction;
  std::string path;
};

CommandLine commandLine(ScanOptions& options) {
  CommandLine line("pcl_symmetry_scan",
                   "Scans a mesh from one side, as a range scanner would, into an organized cloud.",
                   "pcl_symmetry_scan bull.off bull.pcd -direction 1,-1,0.5 -noise 0.001");
  line.positional("mesh", options.input, ".off, .obj, .stl or .ply with faces")
      .positional("output", options.output, ".pcd or .ply; with -all eight files, NAME_0.pcd to NAME_7.pcd")
      .direction("direction", options.direction, "from the object's center toward the scanner (1,1,1)")
      .number("corner", options.corner, Range::closed(0, 7),
              "corner of a cube around the object; bit 0, 1, 2 set: positive x, y, z")
      .flag("all", options.all, "scan from all eight corners")
      .number("points", options.scanner.num_points, Range::closed(1, 20000000), "wanted number of points")
      .number("fov", options.field_of_view, Range::open(0, 180),
              "field of view, degrees (22.9183, or more where the mesh needs it)")
      .number("distance", options.scanner.distance, Range::above(0.5), "from the center, in bounding-box diagonals")
      .number("noise", options.scanner.noise, Range::closed(0, 1), "deviation of the depth, in diagonals")
      .flag("random_pose", options.scanner.random_pose, "turn and move the model at random first")
      .choice("format", options.format, {"ascii", "binary", "binary_compressed"}, "encoding of PCD files")
      .common(options.common, kSeed | kThreads | kJson | kQuiet);
  return line;
}

std::vector<View> viewsOf(const ScanOptions& options) {
  const auto corners = cubeCorners();
  if (options.direction) return {{*options.direction, options.output}};
  if (!options.all) return {{corners[static_cast<std::size_t>(options.corner.value_or(7))], options.output}};
  std::vector<View> views;
  const boost::filesystem::path path(options.output);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::string name = path.stem().string() + "_" + std::to_string(i) + path.extension().string();
    views.push_back({corners[i], (path.parent_path() / name).string()});
  }
  return views;
}

PCDEncoding encodingOf(const std::string& format) {
  if (format == "ascii") return PCDEncoding::Ascii;
  return format == "binary" ? PCDEncoding::Binary : PCDEncoding::BinaryCompressed;
}

nlohmann::json describe(const VirtualScan& scan, const std::string& path, const Eigen::Vector3d& mesh_shift,
                        const Eigen::Vector3d& scan_shift) {
  const Eigen::Isometry3d sensor_pose = shiftedBack(scan.T_scan_sensor, Eigen::Vector3d::Zero(), scan_shift);
  const Eigen::Vector3d viewpoint = sensor_pose.translation();
  return {{"file", path},
          {"num_points", scan.num_points},
          {"width", scan.cloud->width},
          {"height", scan.cloud->height},
          {"viewpoint", {viewpoint.x(), viewpoint.y(), viewpoint.z()}},
          {"transform", rowMajor(shiftedBack(scan.T_scan_model, mesh_shift, scan_shift))},
          {"sensor_pose", rowMajor(sensor_pose)},
          {"cropped", scan.cropped}};
}

std::vector<VirtualScan> scanAll(const Console& console, const Shape& shape, const std::vector<View>& views,
                                 VirtualScannerOptions options, double& scanning_ms) {
  Step scanning(console, "Scanning from " + std::string(views.size() > 1 ? "eight corners" : "one side"));
  const VirtualScanner scanner(*shape.mesh);
  std::vector<VirtualScan> scans;
  int num_points = 0;
  for (const View& view : views) {
    options.noise_stream = scans.size();
    scans.push_back(scanner.scan(view.direction, options));
    num_points += scans.back().num_points;
    scanning.progress(double(scans.size()) / double(views.size()));
  }
  scanning_ms = scanning.done(counted(num_points, "point"));
  return scans;
}

void save(const VirtualScan& scan, const std::string& path, const Eigen::Vector3d& shift, PCDEncoding encoding) {
  Eigen::Vector4f origin = scan.cloud->sensor_origin_;
  if (!shift.isZero(0.0)) origin.head<3>() = (scan.T_scan_sensor.translation() + shift).cast<float>();
  saveCloud(path, toFields(*scan.cloud, shift), origin, scan.cloud->sensor_orientation_, encoding);
}

int run(int argc, char** argv) {
  ScanOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  if (int(options.direction.has_value()) + int(options.corner.has_value()) + int(options.all) > 1)
    throw UsageError("only one of -direction, -corner and -all may be given");
  checkCloudExtension(options.output);
  line.goWith("an output of PCD", !boost::algorithm::iends_with(options.output, ".ply"), {"format"});
  line.goWith("-noise or -random_pose", options.scanner.noise > 0.0 || options.scanner.random_pose, {"seed"});
  const std::vector<View> views = viewsOf(options);
  for (const View& view : views) checkTarget(view.path);
  isStandardOutputFree({options.output, options.common.json_path});
  options.scanner.seed = options.common.seed;
  options.scanner.num_threads = options.common.threads;
  if (options.field_of_view) options.scanner.field_of_view = *options.field_of_view * kDegree;
  const Console console(options.common.quiet);

  Step loading(console, "Loading " + options.input);
  const Shape shape = loadShape(options.input);
  if (!shape.mesh) throw InputError(options.input + ": has no faces, the scanner needs a mesh");
  const double loading_ms = loading.done(counted(shape.mesh->polygons.size(), "face"));
  warnOfLeftOut(console, options.input, shape);

  double scanning_ms = 0.0;
  const std::vector<VirtualScan> scans =
      namingFile(options.input, [&] { return scanAll(console, shape, views, options.scanner, scanning_ms); });
  if (std::any_of(scans.begin(), scans.end(), [](const VirtualScan& scan) { return scan.cropped; }))
    console.warn(options.input + ": reaches beyond the picture; a larger -fov or -distance shows all of it");

  nlohmann::json report;
  // A scan without a random pose is at the position of its mesh, shifted; one with a random pose is near the origin.
  const Eigen::Vector3d shift = options.scanner.random_pose ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : shape.shift;
  Step saving(console, "Saving " + (options.all ? std::to_string(views.size()) + " files" : options.output));
  for (std::size_t i = 0; i < views.size(); ++i) {
    save(scans[i], views[i].path, shift, encodingOf(options.format));
    report["scans"].push_back(describe(scans[i], views[i].path, shape.shift, shift));
  }
  const double saving_ms = saving.done();
  report["timing_ms"] = {{"load", loading_ms}, {"scan", scanning_ms}, {"save", saving_ms}};
  if (options.common.json_path) writeText(*options.common.json_path, jsonText(report) + "\n");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
