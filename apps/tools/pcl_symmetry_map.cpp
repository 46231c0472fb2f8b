/// The transform mapped back to space: for each point of a cloud and each cell of a volume, the greatest symmetry of
/// any plane, axis or center there.
#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <cmath>

#include "command_line/run_on_files.h"
#include "io/answers.h"
#include "io/cloud_fields.h"
#include "io/input_shape.h"
#include "io/shape_output.h"
#include "pcl_symmetry/axial_symmetry_transform.h"
#include "pcl_symmetry/core/local_symmetry.h"
#include "pcl_symmetry/planar_symmetry_transform.h"
#include "pictures/picture.h"
#include "pictures/raster_image.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

struct SymmetryMeasure {
  std::size_t num_tried = 0;  ///< number of planes, axes or centers that were tried
  /// Gives the greatest symmetry of the planes, axes or centers through each of 3 x N points, with a number of threads.
  std::function<std::vector<float>(const Points&, int)> through;
  std::vector<std::string> lines = {};            ///< the best planes, axes or centers, as printed
  nlohmann::json best = nlohmann::json::array();  ///< the same as JSON
  std::vector<AxisLine> axes = {};                ///< the best axes, for pictures
};

struct MapOptions {
  BatchOptions batch;
  std::string input;
  std::optional<std::string> output, volume_path, slices_path, png_path;
  std::string of = "planes";       ///< "planes", "axes" or "centers"
  std::string measure = "D";       ///< "D" or "prst"
  std::optional<int> fold;         ///< order of the rotations about axes, 0 = any angle; none: 2 to 8 and any angle
  std::string method = "sampled";  ///< estimator for planes, one of kMethodNames
  bool as_published = false;
  std::optional<double> refined_share;  ///< for planes by method rotational
  /// Radius of the window around each point for planes, as a share of the shape's radius; 0 = the whole shape.
  double scale = 0.0;
  int cells = 96;
  std::optional<int> size;
  CommonOptions common;
};

constexpr int kMostListed = 5;
constexpr double kLeastListed = 0.6;  // D

template <typename Transform>
void setUp(Transform& transform, const InputShape& input, const CommonOptions& common) {
  if (common.sigma) transform.setSigma(*common.sigma);
  transform.setRandomSeed(common.seed);
  transform.setNumberOfThreads(common.threads);
  setInput(transform, input, common);
}

SymmetryMeasure ofPlanes(const InputShape& input, const CommonOptions& common, const MapOptions& options) {
  PlanarSymmetryTransform<pcl::PointXYZ> transform;
  transform.setGridSize(common.grid);
  PlanarTransformOptions estimator;
  estimator.method = methodNamed(options.method);
  if (options.as_published) estimator.voting.near_distance = 0.0;
  if (options.refined_share) estimator.rotational.refined_share = *options.refined_share;
  transform.setOptions(estimator);
  setUp(transform, input, common);
  const auto map = std::make_shared<const SymmetryMap>(checked(transform, input, transform.compute()));
  if (options.scale > 0.0) {
    LocalSymmetryOptions local;
    local.scale = options.scale * map->grid.radius();
    local.seed = common.seed;
    return {static_cast<std::size_t>(local.num_directions),
            [edt = transform.getDistanceTransform(), local](const Points& points, int threads) mutable {
              local.num_threads = threads;
              return localSymmetry(*edt, points, local);
            }};
  }
  return {map->values.size(),
          [map](const Points& points, int threads) { return pointSymmetry(*map, points, threads); }};
}

SymmetryMeasure ofAxes(const InputShape& input, const CommonOptions& common, std::optional<int> fold) {
  AxialSymmetryTransform<pcl::PointXYZ> transform;
  // A map of axes has one dimension more: half as many cells, a quarter of the angles theta.
  const int num_phi = std::max(2, common.grid / 2 * 2);
  transform.setNumCells(std::max(8, common.grid / 2));
  transform.setMapSize(std::max(1, common.grid / 4), num_phi, std::max(1, common.grid / 2));
  if (fold) transform.setOptions({{*fold}});
  setUp(transform, input, common);
  const auto map = std::make_shared<const AxisMap>(checked(transform, input, transform.compute()));
  SymmetryMeasure measure{map->greatest.size(), [map](const Points& points, int threads) {
                            return axialPointSymmetry(*map, points, threads);
                          }};
  for (const AxisMaximum& maximum : transform.getAxes(kMostListed, kLeastListed)) {
    const Eigen::Vector3d d = maximum.axis.direction();
    const Eigen::Vector3d local = maximum.axis.projection(map->grid.center());
    const Eigen::Vector3d p = shiftedBack(local, input.shift());
    const std::string angles = maximum.fold == 0 ? "any angle" : "fold " + std::to_string(maximum.fold);
    measure.lines.push_back(formatted("axis %9.6f %9.6f %9.6f through %.6g %.6g %.6g  %s  D %.3f", d.x(), d.y(), d.z(),
                                      p.x(), p.y(), p.z(), angles.c_str(), maximum.value));
    measure.best.push_back({{"point", {p.x(), p.y(), p.z()}},
                            {"direction", {d.x(), d.y(), d.z()}},
                            {"fold", maximum.fold},
                            {"symmetry", maximum.value},
                            {"folds", map->folds},
                            {"symmetry_of_folds", maximum.values}});
    measure.axes.push_back({local, d, distinctColor(measure.axes.size())});
  }
  return measure;
}

SymmetryMeasure ofCenters(const InputShape& input, const CommonOptions& common) {
  AxialSymmetryTransform<pcl::PointXYZ> transform;
  transform.setNumCells(common.grid);
  setUp(transform, input, common);
  const auto map = std::make_shared<const CenterMap>(
      checked(transform, input, transform.computeCenters(std::min(512, common.grid))));
  const auto through = [map](const Points& points, int) {
    std::vector<float> values;
    for (Eigen::Index i = 0; i < points.cols(); ++i)
      values.push_back(static_cast<float>((*map)(points.col(i).cast<double>())));
    return values;
  };
  SymmetryMeasure measure{map->values.size(), through};
  const Eigen::Vector3d p = shiftedBack(map->center(map->strongest()), input.shift());
  const double value = map->values[map->strongest()];
  measure.lines.push_back(formatted("center %.6g %.6g %.6g  D %.3f", p.x(), p.y(), p.z(), value));
  measure.best.push_back({{"point", {p.x(), p.y(), p.z()}}, {"symmetry", value}});
  return measure;
}

/// The measure of Equation 1, PRST = sqrt((1 + D) / 2), in place of D. Estimates of D are clamped to [0, 1], so that
/// values lie within [0.707, 1].
SymmetryMeasure byEquation1(SymmetryMeasure measure) {
  measure.through = [of_d = std::move(measure.through)](const Points& points, int threads) {
    std::vector<float> values = of_d(points, threads);
    for (float& value : values) value = std::sqrt(0.5f * (1.0f + std::clamp(value, 0.0f, 1.0f)));
    return values;
  };
  return measure;
}

SymmetryMeasure measureSymmetry(const InputShape& input, const CommonOptions& common, const MapOptions& options) {
  return namingFile(input.path, [&] {
    if (options.of == "axes") return ofAxes(input, common, options.fold);
    return options.of == "centers" ? ofCenters(input, common) : ofPlanes(input, common, options);
  });
}

// Vermilion, which color-blind readers distinguish from every gray.
const Eigen::Vector3d kSurfaceColor(0.84, 0.37, 0.0);

CommandLine commandLine(MapOptions& options) {
  CommandLine line("pcl_symmetry_map", "Writes the greatest symmetry of any plane, axis or center at each point.",
                   "pcl_symmetry_map bull.off bull_symmetry.pcd -volume bull.vti -slices bull_slices.png");
  options.batch.outputs = {&options.output, &options.volume_path, &options.slices_path, &options.png_path};
  line.positional("input", options.input, kOneOrManyInputs + std::string("; or a volume (") + kVolumeFiles + ")")
      .positional("output", options.output, ".pcd or .ply: the points with one more field, intensity, about 0 to 1")
      .choice("of", options.of, {"planes", "axes", "centers"},
              "what is symmetric: reflections, rotations about axes, or point symmetry")
      .choice("measure", options.measure, {"D", "prst"},
              "what is written: D of equation 2, or PRST = sqrt((1 + D) / 2) of equation 1, within 0.707 and 1")
      .number(
          "fold", options.fold, Range::closed(0, 60),
          "with -of axes: order of the rotations, 0 = by any angle, not 1; default: the best of 2 to 8 and any angle")
      .choice("method", options.method, kMethodNames, "estimator of planes (Sections 4.2 and 4.3)")
      .flag("as_published", options.as_published, "with -method voting: near pairs of points vote like all others")
      .number(
          "refined_share", options.refined_share, Range::closed(0, 1),
          "with -method rotational, multiresolution: this share of the planes, those of the greatest D, is computed "
          "finely, the others coarsely; default 1")
      .number("scale", options.scale, Range::closed(0, 1),
              "local symmetry of planes: within this share of the shape's radius around each point; 0 = of the whole")
      .text("volume", "FILE", options.volume_path, "VTK image (.vti) of the space around, for ParaView")
      .text("slices", "FILE.png", options.slices_path,
            "picture: three slices through the middle, the darker the greater, the shape on top")
      .text("png", "FILE.png", options.png_path, "picture: the points in the colors of their symmetry")
      .number("cells", options.cells, Range::closed(8, 512), "cells of the volume along its longest edge")
      .number("size", options.size, Range::closed(16, 4096), "edge of each picture, pixels (-png 800, -slices 300)")
      .common(options.common, kShapeFlags | kSigma | kVolumes);
  options.batch.addTo(line);
  return line;
}

/// The cloud with a field intensity; an existing field of that name is renamed.
pcl::PCLPointCloud2 withIntensity(pcl::PCLPointCloud2 cloud, const std::vector<float>& intensity) {
  for (pcl::PCLPointField& field : cloud.fields)
    if (field.name == "intensity") field.name = "input_intensity";
  return withFields(cloud, {"intensity"}, {intensity});
}

/// A box of cells around the shape.
struct CellBox {
  Eigen::Vector3d origin;  ///< center of cell (0, 0, 0), input frame
  double cell_size;
  Eigen::Array3i size;

  CellBox(const Points& points, int num_cells) {
    constexpr double kMargin = 0.1;  // share of the longest edge, on each side
    const Eigen::Vector3d low = points.rowwise().minCoeff().cast<double>(),
                          high = points.rowwise().maxCoeff().cast<double>();
    const double edge = (high - low).maxCoeff();
    cell_size = (1.0 + 2.0 * kMargin) * edge / num_cells;
    size = (((high - low).array() + 2.0 * kMargin * edge) / cell_size).ceil().cast<int>().max(1);
    origin = 0.5 * (low + high) - 0.5 * cell_size * (size.cast<double>() - 1.0).matrix();
  }

  Eigen::Vector3d center(int x, int y, int z) const { return origin + cell_size * Eigen::Vector3d(x, y, z); }
};

void writeSymmetry(const SymmetryMeasure& map, const CellBox& volume, const Eigen::Vector3d& shift, int threads,
                   const std::string& path) {
  Points centers(3, static_cast<Eigen::Index>(volume.size.cast<std::int64_t>().prod()));
  Eigen::Index i = 0;
  for (int z = 0; z < volume.size.z(); ++z)
    for (int y = 0; y < volume.size.y(); ++y)
      for (int x = 0; x < volume.size.x(); ++x) centers.col(i++) = volume.center(x, y, z).cast<float>();
  const std::vector<float> values = map.through(centers, threads);
  writeVolume({"symmetry", volume.size, shiftedBack(volume.origin, shift), volume.cell_size, values}, path);
}

/// A slice through the middle of the volume, perpendicular to one axis and seen along it.
struct Slice {
  int across, up, axis, size;  // axes to the right, upwards and along the view; edge in pixels
  Eigen::Vector3d middle;
  double step;  ///< edge of a pixel, input units

  Slice(const CellBox& volume, int axis_seen_along, int num_pixels)
      : across((axis_seen_along + 1) % 3), up((axis_seen_along + 2) % 3), axis(axis_seen_along), size(num_pixels) {
    const Eigen::Vector3d extent = volume.cell_size * volume.size.cast<double>();
    middle = volume.origin + 0.5 * (extent.array() - volume.cell_size).matrix();
    step = std::max(extent[across], extent[up]) / size;
  }

  Points positions() const {
    Points result(3, size * size);
    for (int i = 0; i < size * size; ++i) {
      Eigen::Vector3d position = middle;
      position[across] += (i % size + 0.5 - 0.5 * size) * step;
      position[up] -= (i / size + 0.5 - 0.5 * size) * step;
      result.col(i) = position.cast<float>();
    }
    return result;
  }

  /// White for the least value of all slices, black for the greatest; the shape is drawn where it meets the slice.
  RasterImage draw(const std::vector<float>& symmetry, float least, float greatest, const Points& points,
                   double thickness) const {
    RasterImage image(size, size);
    const double range = std::max(1e-9f, greatest - least);
    for (int i = 0; i < size * size; ++i)
      image.set(i % size, i / size, Eigen::Vector3d::Constant((greatest - symmetry[i]) / range));
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      const Eigen::Vector3d offset = points.col(i).cast<double>() - middle;
      if (std::abs(offset[axis]) > thickness) continue;
      image.drawDisk({offset[across] / step + 0.5 * size - 0.5, 0.5 * size - offset[up] / step - 0.5}, size / 250.0,
                     kSurfaceColor);
    }
    return image;
  }
};

RasterImage drawSlices(const SymmetryMeasure& map, const CellBox& volume, const Points& points, int size, int threads) {
  std::vector<Slice> slices;
  std::vector<std::vector<float>> symmetry;
  float least = std::numeric_limits<float>::max(), greatest = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    slices.emplace_back(volume, axis, size);
    symmetry.push_back(map.through(slices[axis].positions(), threads));
    least = std::min(least, *std::min_element(symmetry[axis].begin(), symmetry[axis].end()));
    greatest = std::max(greatest, *std::max_element(symmetry[axis].begin(), symmetry[axis].end()));
  }
  std::vector<RasterImage> images;
  for (int axis = 0; axis < 3; ++axis)
    images.push_back(slices[axis].draw(symmetry[axis], least, greatest, points, volume.cell_size));
  return sideBySide(images);
}

struct MappedCloud {
  Cloud::ConstPtr cloud;
  std::vector<std::size_t> indices;  ///< indices of the finite points
  Points points;
  std::vector<float> symmetry;
  float least, greatest;

  MappedCloud(const Cloud::ConstPtr& input, const SymmetryMeasure& map, int threads, Step& step)
      : cloud(input), points(finitePoints(*input, &indices)) {
    constexpr Eigen::Index kAtATime = 100'000;
    for (Eigen::Index i = 0; i < points.cols(); i += kAtATime) {
      const auto values = map.through(points.middleCols(i, std::min(kAtATime, points.cols() - i)), threads);
      symmetry.insert(symmetry.end(), values.begin(), values.end());
      step.progress(static_cast<double>(symmetry.size()) / static_cast<double>(points.cols()));
    }
    const auto [low, high] = std::minmax_element(symmetry.begin(), symmetry.end());
    least = *low;
    greatest = *high;
  }
};

void savePoints(const InputShape& input, const MappedCloud& mapped, const std::string& path) {
  std::vector<float> intensity(mapped.cloud->size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < mapped.symmetry.size(); ++i) intensity[mapped.indices[i]] = mapped.symmetry[i];
  saveCloud(path, withIntensity(input.fields(), intensity), input.shape.sensor_origin, input.shape.sensor_orientation);
}

void drawPoints(const MapOptions& options, const SymmetryMeasure& map, const MappedCloud& mapped,
                const std::string& path) {
  PicturePanel panel{"greatest symmetry of the " + options.of + " through each point"};
  panel.axes = map.axes;
  panel.support.assign(mapped.cloud->size(), 0.0);
  const double range = std::max(1e-9f, mapped.greatest - mapped.least);
  for (std::size_t i = 0; i < mapped.symmetry.size(); ++i)
    panel.support[mapped.indices[i]] = (mapped.symmetry[i] - mapped.least) / range;
  PictureScene scene{mapped.cloud, std::nullopt, {panel}};
  scene.show_color_bar = false;
  const int size = options.size.value_or(800);
  renderPicture({scene}, path, size, size);
}

void writeSpace(const MapOptions& options, const FileJob& job, const InputShape& input, const SymmetryMeasure& map,
                const Points& points) {
  const CellBox volume(points, options.cells);
  if (options.volume_path) {
    const std::string path = job.output(*options.volume_path);
    Step writing(job.console, "Writing " + path);
    writeSymmetry(map, volume, input.shift(), job.common.threads, path);
    writing.done(std::to_string(volume.size.prod()) + " cells");
  }
  if (options.slices_path)
    writeImage(drawSlices(map, volume, points, options.size.value_or(300), job.common.threads),
               job.output(*options.slices_path));
}

void analyze(const MapOptions& options, FileJob& job) {
  const InputShape input = loadInput(job.console, job.path, options.common);
  Step transforming(job.console, "Transforming");
  SymmetryMeasure map = measureSymmetry(input, job.common, options);
  if (options.measure == "prst") map = byEquation1(std::move(map));
  const double transforming_ms = transforming.done(std::to_string(map.num_tried) + " " + options.of);

  Step mapping(job.console, "Mapping back to points");
  const MappedCloud mapped(input.points, map, job.common.threads, mapping);
  const double mapping_ms = mapping.done(counted(mapped.symmetry.size(), "point"));

  std::string text;
  for (const std::string& line_of_best : map.lines) text += line_of_best + "\n";
  text += formatted("symmetry of the %s through the points: %.3f to %.3f\n", options.of.c_str(), mapped.least,
                    mapped.greatest);
  nlohmann::json json{{"file", job.path},
                      {"num_points", mapped.symmetry.size()},
                      {"least", mapped.least},
                      {"greatest", mapped.greatest},
                      {"timing_ms", {{"transform", transforming_ms}, {"points", mapping_ms}}}};
  if (!map.best.empty()) json[options.of] = map.best;
  job.report({text, json, {{mapped.symmetry.size(), mapped.least, mapped.greatest}}});
  if (options.output) savePoints(input, mapped, job.output(*options.output));
  writeSpace(options, job, input, map, mapped.points);
  if (options.png_path) drawPoints(options, map, mapped, job.output(*options.png_path));
}

int run(int argc, char** argv) {
  MapOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  if (options.output) checkCloudExtension(*options.output);
  if (options.volume_path && !boost::algorithm::iends_with(*options.volume_path, ".vti"))
    rejectValue("-volume", *options.volume_path, "must end in .vti");
  line.goWith("-of planes", options.of == "planes", {"scale", "method", "refined_share", "as_published"});
  line.goWith("the whole shape, without -scale", options.scale == 0.0, {"method", "refined_share", "as_published"});
  line.goWith("-method rotational", options.method == "rotational", {"refined_share"});
  line.goWith("-method voting", options.method == "voting", {"as_published"});
  line.goWith("-of axes", options.of == "axes", {"fold"});
  line.goWith("-volume", options.volume_path.has_value(), {"cells"});
  line.goWith("-png or -slices", options.png_path || options.slices_path, {"size"});
  if (options.fold == 1) rejectValue("-fold", "1", "must be 0 or >= 2: a rotation of order 1 changes nothing");
  options.batch.inputs = {options.input};
  return runOnFiles(options.batch, options.common, {"points", "least", "greatest"},
                    [&](FileJob& job) { analyze(options, job); });
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
