/// Virtual range scanner: a mesh seen from one side, or from the eight corners of a cube (Section 5.1).
#include <pcl/conversions.h>

#include <boost/filesystem/path.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "console.h"
#include "options.h"
#include "shape_input.h"
#include "shape_output.h"
#include "virtual_scanner.h"

namespace {

using namespace pcl_symmetry::apps;

struct ScanOptions {
  std::string input, output;
  std::optional<Eigen::Vector3d> direction;
  std::optional<int> corner;
  bool all = false;
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
      .vector("direction", options.direction, "from the object's centre towards the scanner (as -corner 7)")
      .number("corner", options.corner, Range::closed(0, 7),
              "corner of a cube around the object; bit 0, 1, 2 set: positive x, y, z")
      .flag("all", options.all, "scan from all eight corners")
      .number("points", options.scanner.num_points, Range::closed(1, 20000000), "wanted number of points")
      .number("fov", options.scanner.field_of_view, Range::open(0, 3.14159), "field of view, radians")
      .number("distance", options.scanner.distance, Range::above(0.5), "from the centre, in bounding-box diagonals")
      .number("noise", options.scanner.noise, Range::closed(0, 1), "deviation of the depth, in diagonals")
      .flag("random_pose", options.scanner.random_pose, "turn and move the model at random first")
      .choice("format", options.format, {"ascii", "binary", "binary_compressed"}, "encoding of PCD files")
      .common(options.common, kSeed | kThreads | kJson | kQuiet);
  return line;
}

void checkCombination(const ScanOptions& options) {
  if (int(options.direction.has_value()) + int(options.corner.has_value()) + int(options.all) > 1) {
    throw UsageError("only one of -direction, -corner and -all may be given");
  }
  if (options.direction && !(options.direction->norm() > 0)) throw UsageError("-direction = 0,0,0, must not be zero");
  checkCloudExtension(options.output);
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

nlohmann::json rowMajor(const Eigen::Isometry3d& transform) {
  nlohmann::json numbers = nlohmann::json::array();
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) numbers.push_back(transform.matrix()(row, column));
  }
  return numbers;
}

nlohmann::json describe(const VirtualScan& scan, const std::string& path) {
  const Eigen::Vector3d viewpoint = scan.T_scan_sensor.translation();
  return {{"file", path},
          {"num_points", scan.num_points},
          {"width", scan.cloud->width},
          {"height", scan.cloud->height},
          {"viewpoint", {viewpoint.x(), viewpoint.y(), viewpoint.z()}},
          {"transform", rowMajor(scan.T_scan_model)},
          {"sensor_pose", rowMajor(scan.T_scan_sensor)},
          {"cropped", scan.cropped}};
}

int run(int argc, char** argv) {
  ScanOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  checkCombination(options);
  options.scanner.seed = options.common.seed;
  options.scanner.num_threads = options.common.threads;
  const Console console(options.common.quiet);

  Step loading(console, "Loading " + options.input);
  const Shape shape = loadShape(options.input);
  if (!shape.mesh) throw InputError(options.input + ": has no faces, the scanner needs a mesh");
  const double loading_ms = loading.done(std::to_string(shape.mesh->polygons.size()) + " faces");

  Step scanning(console, "Scanning from " + std::string(options.all ? "eight corners" : "one side"));
  const VirtualScanner scanner(*shape.mesh);
  const std::vector<View> views = viewsOf(options);
  std::vector<VirtualScan> scans;
  int num_points = 0;
  for (const View& view : views) {
    options.scanner.noise_stream = scans.size();
    scans.push_back(scanner.scan(view.direction, options.scanner));
    num_points += scans.back().num_points;
    scanning.progress(double(scans.size()) / double(views.size()));
  }
  const double scanning_ms = scanning.done(std::to_string(num_points) + " points");
  for (const VirtualScan& scan : scans) {
    if (scan.cropped) {
      console.warn(options.input + ": reaches beyond the picture; a larger -fov or -distance shows all of it");
      break;
    }
  }

  nlohmann::json report;
  Step saving(console, "Saving " + (options.all ? std::to_string(views.size()) + " files" : options.output));
  for (std::size_t i = 0; i < views.size(); ++i) {
    pcl::PCLPointCloud2 cloud;
    pcl::toPCLPointCloud2(*scans[i].cloud, cloud);
    saveCloud(views[i].path, cloud, scans[i].cloud->sensor_origin_, scans[i].cloud->sensor_orientation_,
              encodingOf(options.format));
    report["scans"].push_back(describe(scans[i], views[i].path));
  }
  const double saving_ms = saving.done();
  report["timing_ms"] = {{"load", loading_ms}, {"scan", scanning_ms}, {"save", saving_ms}};
  if (options.common.json_path) writeText(*options.common.json_path, report.dump(2) + "\n");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
