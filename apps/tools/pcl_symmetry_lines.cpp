/// Lines of symmetry of planar shapes, contours or pictures: a table, JSON, and the transform mapped back to the plane.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command_line/command_line.h"
#include "command_line/console.h"
#include "command_line/tool_errors.h"
#include "io/answers.h"
#include "io/shape_output.h"
#include "pcl_symmetry/core/symmetry_map.h"
#include "pcl_symmetry/planar_symmetry_transform_2d.h"
#include "pictures/raster_image.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

const Eigen::Vector3d kContourColor(0.84, 0.37, 0.0);  // vermilion: apart from every gray, for all eyes

struct LinesOptions {
  std::vector<std::string> inputs;
  std::optional<std::string> png_path;
  bool filled = false;
  int grid = 128, max_lines = 10, size = 256, columns = 8;
  CommonOptions common;
};

CommandLine commandLine(LinesOptions& options) {
  CommandLine line("pcl_symmetry_lines", "Finds the lines of symmetry of shapes in a plane.",
                   "pcl_symmetry_lines leaf.png -png leaf_symmetry.png");
  line.positionals("input", options.inputs,
                   "pictures of two tones (.png, .pgm), or points in a plane (.pcd, .ply, .xyz, ...)")
      .picture("png", options.png_path, "picture: the darker a point, the more symmetric the best line through it")
      .flag("filled", options.filled, "take all pixels of the shape in a picture, not its outline only")
      .number("max_lines", options.max_lines, Range::closed(1, 1000), "largest number of lines reported")
      .number("grid", options.grid, Range::closed(8, 1024),
              "cells along an edge of the distance field; bins of the map")
      .number("size", options.size, Range::closed(16, 4096), "edge of each shape's picture, pixels")
      .number("columns", options.columns, Range::closed(1, 1000), "shapes side by side in the picture")
      .common(options.common, kSigma | kThreads | kJson | kQuiet);
  return line;
}

/// The map over the sheet (Figure 2), the contour on top.
RasterImage draw(const PlanarSymmetryTransform2D<pcl::PointXYZ>& transform, const LineMap& map, int size, int threads) {
  constexpr double kMargin = 1.12;  // in radii of the shape
  const double half = kMargin * map.grid.radius(), step = 2.0 * half / size;
  Points2D places(2, size * size);
  for (int i = 0; i < size * size; ++i) {
    const Eigen::Vector2d offset((i % size + 0.5) * step - half, half - (i / size + 0.5) * step);
    places.col(i) = (map.grid.center() + offset).cast<float>();
  }
  const std::vector<float> symmetry = pointSymmetry(map, places, threads);
  RasterImage image(size, size);
  for (int i = 0; i < size * size; ++i)
    image.set(i % size, i / size, Eigen::Vector3d::Constant(1.0 - std::clamp<double>(symmetry[i], 0.0, 1.0)));
  const Points2D& contour = transform.getSheetPoints();
  for (Eigen::Index i = 0; i < contour.cols(); ++i) {
    const Eigen::Vector2d offset = contour.col(i).cast<double>() - map.grid.center();
    image.drawDisk({(offset.x() + half) / step - 0.5, (half - offset.y()) / step - 0.5}, size / 220.0, kContourColor);
  }
  return image;
}

nlohmann::json toJson(const PlanarSymmetryTransform2D<pcl::PointXYZ>& transform,
                      const std::vector<LineMaximum>& lines) {
  nlohmann::json list = nlohmann::json::array();
  for (const LineMaximum& maximum : lines) {
    const ReflectionLine& line = maximum.line;
    const Eigen::Vector4d plane = transform.getPlane(line).coefficients();
    list.push_back({{"coefficients", {line.normal().x(), line.normal().y(), -line.offset()}},
                    {"plane", {plane[0], plane[1], plane[2], plane[3]}},
                    {"theta", line.theta()},
                    {"score", maximum.value}});
  }
  return list;
}

/// Largest distance of points from their plane, root mean square over that from their middle within the plane.
constexpr double kMaxUnevenness = 0.05;

/// \throws InputError where the points do not lie in a plane.
void checkFlat(const pcl::PointCloud<pcl::PointXYZ>& points, const Eigen::Isometry3d& T_input_sheet,
               const std::string& input) {
  const Eigen::Isometry3d T_sheet_input = T_input_sheet.inverse();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), sq_sum = Eigen::Vector3d::Zero();
  double num_points = 0.0;
  for (const pcl::PointXYZ& point : points) {
    if (!point.getVector3fMap().allFinite()) continue;
    const Eigen::Vector3d x = T_sheet_input * point.getVector3fMap().cast<double>();
    sum += x;
    sq_sum += x.cwiseAbs2();
    num_points += 1.0;
  }
  const Eigen::Vector3d variance = sq_sum / num_points - (sum / num_points).cwiseAbs2();
  const double unevenness = std::sqrt(std::max(0.0, variance.z()) / (variance.x() + variance.y()));
  if (unevenness <= kMaxUnevenness) return;
  throw InputError(input + formatted(": its points lie %.0f %% of their extent off a plane, must be <= %.0f %%",
                                     100.0 * unevenness, 100.0 * kMaxUnevenness));
}

/// Reads, transforms and prints one shape.
/// \param is_first prints the head of the table, too.
/// \return its entry of the JSON; its picture where one is wanted.
std::pair<nlohmann::json, std::optional<RasterImage>> analyze(const std::string& input, const LinesOptions& options,
                                                              const Console& console, bool is_first) {
  Step loading(console, "Loading " + input);
  const pcl::PointCloud<pcl::PointXYZ>::Ptr contour = loadContour(input, options.filled);
  loading.done(std::to_string(contour->size()) + " points");

  Step searching(console, "Searching lines");
  PlanarSymmetryTransform2D<pcl::PointXYZ> transform;
  const LineMap map = namingFile(input, [&] {
    transform.setGridSize(options.grid);
    if (options.common.sigma) transform.setSigma(*options.common.sigma);
    transform.setNumberOfThreads(options.common.threads);
    transform.setInputCloud(contour);
    return transform.compute();
  });
  if (!transform.getReason().empty()) throw InputError(input + ": " + transform.getReason());
  checkFlat(*contour, transform.getSheetPose(), input);
  std::vector<LineMaximum> lines = transform.getLines();
  if (static_cast<int>(lines.size()) > options.max_lines) lines.resize(options.max_lines);
  const double ms = searching.done(counted(lines.size(), "line"));

  if (is_first) std::printf("%5s %10s %10s %12s %7s  %s\n", "line", "a", "b", "c", "score", "shape");
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const ReflectionLine& found = lines[i].line;
    std::printf("%5zu %10.6f %10.6f %12.6g %7.3f  %s\n", i + 1, found.normal().x(), found.normal().y(), -found.offset(),
                lines[i].value, input.c_str());
  }
  const nlohmann::json json{{"file", input},
                            {"num_points", transform.getSheetPoints().cols()},
                            {"lines", toJson(transform, lines)},
                            {"timing_ms", {{"total", ms}}}};
  if (!options.png_path) return {json, std::nullopt};
  return {json, draw(transform, map, options.size, options.common.threads)};
}

int run(int argc, char** argv) {
  LinesOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  const Console console(options.common.quiet);
  nlohmann::json shapes = nlohmann::json::array();
  std::vector<RasterImage> panels;
  for (const std::string& input : options.inputs) {
    auto [json, panel] = analyze(input, options, console, shapes.empty());
    shapes.push_back(std::move(json));
    if (panel) panels.push_back(std::move(*panel));
  }
  if (options.common.json_path)
    writeText(*options.common.json_path, jsonText(nlohmann::json{{"shapes", shapes}}) + "\n");
  if (options.png_path) writeImage(sideBySide(panels, options.columns), *options.png_path);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
