#include "tools/symmetry_measure.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "command_line/tool_errors.h"
#include "io/exact_coordinates.h"
#include "io/formatted.h"
#include "io/json_values.h"
#include "pcl_symmetry/axial_symmetry_transform.h"
#include "pcl_symmetry/core/local_symmetry.h"
#include "pcl_symmetry/planar_symmetry_transform.h"

namespace pcl_symmetry::apps {

namespace {

constexpr int kMostListed = 5;        // chosen: a screen holds them; half hides axes of a box, twice shows chance
constexpr double kLeastListed = 0.6;  // D; chosen: half lists axes of any shape, at 1 noise hides true ones

/// Gives a transform what all of them take.
template <typename Transform>
void setUp(Transform& transform, const InputShape& input, const CommonOptions& common) {
  if (common.sigma) transform.setSigma(*common.sigma);
  transform.setRandomSeed(common.librarySeed());
  transform.setNumberOfThreads(common.threads);
  transform.setViewpoint(shifted(common.viewpoint, input.shift()));
  if (input.volume)
    transform.setInputVolume(input.volume, input.levels);
  else
    transform.setInputCloud(input.points);
}

template <typename Transform>
void checkAnswer(const Transform& transform, const InputShape& input) {
  if (!transform.getReason().empty()) throw InputError(input.path + ": " + transform.getReason());
}

SymmetryMeasure ofPlanes(const InputShape& input, const CommonOptions& common, const MeasureOptions& options) {
  PlanarSymmetryTransform<pcl::PointXYZ> transform;
  transform.setGridSize(common.grid);
  transform.setMethod(methodNamed(options.method));
  setUp(transform, input, common);
  const auto map = std::make_shared<const SymmetryMap>(transform.compute());
  checkAnswer(transform, input);
  if (options.scale > 0.0) {
    LocalSymmetryOptions local;
    local.scale = options.scale * map->grid.radius();
    local.seed = common.librarySeed();
    return {"planes", static_cast<std::size_t>(local.num_directions),
            [edt = transform.getDistanceTransform(), local](const Points& points, int threads) mutable {
              local.num_threads = threads;
              return localSymmetry(*edt, points, local);
            }};
  }
  return {"planes", map->values.size(),
          [map](const Points& points, int threads) { return pointSymmetry(*map, points, threads); }};
}

SymmetryMeasure ofAxes(const InputShape& input, const CommonOptions& common, int fold) {
  AxialSymmetryTransform<pcl::PointXYZ> transform;
  // A map of axes has one dimension more: half the cells, a quarter of the angles theta.
  const int num_phi = std::max(2, common.grid / 2 * 2);
  transform.setNumCells(std::max(8, common.grid / 2));
  transform.setMapSize(std::max(1, common.grid / 4), num_phi, std::max(1, common.grid / 2));
  if (fold >= 0) transform.setFolds({fold});
  setUp(transform, input, common);
  const auto map = std::make_shared<const AxisMap>(transform.compute());
  checkAnswer(transform, input);
  SymmetryMeasure measure{"axes", map->greatest.size(), [map](const Points& points, int threads) {
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
    AxisLine line;
    line.point = local;
    line.direction = d;
    line.color = distinctColor(measure.axes.size());
    measure.axes.push_back(line);
  }
  return measure;
}

SymmetryMeasure ofCenters(const InputShape& input, const CommonOptions& common) {
  AxialSymmetryTransform<pcl::PointXYZ> transform;
  transform.setNumCells(common.grid);
  setUp(transform, input, common);
  const auto map = std::make_shared<const CenterMap>(transform.computeCenters(std::min(512, common.grid)));
  checkAnswer(transform, input);
  const auto through = [map](const Points& points, int) {
    std::vector<float> values;
    for (Eigen::Index i = 0; i < points.cols(); ++i)
      values.push_back(static_cast<float>((*map)(points.col(i).cast<double>())));
    return values;
  };
  SymmetryMeasure measure{"centers", map->values.size(), through};
  const Eigen::Vector3d p = shiftedBack(map->center(map->strongest()), input.shift());
  const double value = map->values[map->strongest()];
  measure.lines.push_back(formatted("center %.6g %.6g %.6g  D %.3f", p.x(), p.y(), p.z(), value));
  measure.best.push_back({{"point", {p.x(), p.y(), p.z()}}, {"symmetry", value}});
  return measure;
}

}  // namespace

SymmetryMeasure byEquation1(SymmetryMeasure measure) {
  measure.through = [of_d = std::move(measure.through)](const Points& points, int threads) {
    std::vector<float> values = of_d(points, threads);
    for (float& value : values) value = std::sqrt(0.5f * (1.0f + std::clamp(value, 0.0f, 1.0f)));
    return values;
  };
  return measure;
}

SymmetryMeasure measureSymmetry(const InputShape& input, const CommonOptions& common, const MeasureOptions& options) {
  return namingFile(input.path, [&] {
    if (options.of == "axes") return ofAxes(input, common, options.fold);
    return options.of == "centers" ? ofCenters(input, common) : ofPlanes(input, common, options);
  });
}

}  // namespace pcl_symmetry::apps
