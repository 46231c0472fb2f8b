#include "io/input_shape.h"

#include <boost/algorithm/string.hpp>
#include <cmath>

#include "core/scan/range_image.h"
#include "io/answers.h"
#include "io/cloud_fields.h"
#include "io/file_text.h"
#include "io/load_module.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/mesh_sampling.h"
#include "pictures/drawing.h"

namespace pcl_symmetry::apps {

pcl::PCLPointCloud2 InputShape::fields() const {
  return shape.mesh ? toFields(*points, shape.shift) : shape.cloud;
}

InputShape loadInput(const std::string& path, int mesh_points, std::uint64_t seed) {
  InputShape input;
  input.path = path;
  input.shape = loadShape(path);
  input.points = input.shape.points;
  if (input.shape.mesh) {
    input.points = namingFile(path, [&] { return sampleMesh(*input.shape.mesh, mesh_points, seed); });
    if (input.points->empty()) throw InputError(path + ": no polygon has an area");
  }
  return input;
}

void warnOfLeftOut(const Console& console, const std::string& path, const Shape& shape) {
  for (const std::string& what : shape.left_out) console.warn(path + ": " + what + " left out");
  if (shape.shift.isZero(0.0) || VectorField(shape.cloud).isDouble()) return;
  const int digits = digitsOfFloat(*shape.points, shape.shift);
  if (digits < 4) console.warn(path + ": float coordinates leave " + counted(digits, "digit") + " of the extent");
}

namespace {

/// A volume, or a surface in it.
/// \param[out] summary the levels of a volume, in words.
InputShape loadVolumeInput(const std::string& path, const CommonOptions& common, std::string& summary) {
  const Volume volume = loadVolume(path);
  InputShape input;
  input.path = path;
  if (common.surface) {
    input.shape = surfaceOf(path, *volume.grid, *common.surface);
    input.points = namingFile(path, [&] { return sampleMesh(*input.shape.mesh, common.mesh_points, common.seed); });
  } else {
    if (!common.levels.empty()) input.levels = {common.levels[0], common.levels[1]};
    input.volume = volume.grid;
    constexpr std::size_t kMostVoxels = 64 * 64 * 64;
    input.points = std::make_shared<Cloud>();
    const Points border = namingFile(path, [&] {
      const VolumeFunction function(*volume.grid, input.levels, kMostVoxels, common.threads);
      summary = formatted(", levels %g to %g", function.levels.low, function.levels.high);
      return function.bodyPoints(true);
    });
    for (Eigen::Index i = 0; i < border.cols(); ++i)
      input.points->emplace_back(border(0, i), border(1, i), border(2, i));
    input.shape.points = input.points;
    input.shape.cloud = toFields(*input.points, Eigen::Vector3d::Zero());
  }
  input.shape.left_out = volume.left_out;
  return input;
}

/// Warns if the file itself, or its points, show that the scanner stood elsewhere.
void checkViewpoint(const Console& console, const InputShape& input, const Viewpoint& given) {
  const Cloud& cloud = *input.points;
  if (given.mode != Viewpoint::Mode::Given) return;
  if (const Points points = finitePoints(cloud); points.cols() > 0)
    if (const std::string why = whyNotSeenFrom(points, given.position - input.shift()); !why.empty())
      console.warn(input.path + ": " + why);
  if (!cloud.isOrganized() && detail::hasDefaultSensor(cloud)) return;
  const SeenSpace seen(cloud);
  if (seen.source() != ViewpointSource::Rays && seen.source() != ViewpointSource::Stored) return;
  constexpr double kOneSide = 0.2;  // angle between directions from which a scanner sees about the same, radians
  const Eigen::Vector3d center = finitePoints(cloud).rowwise().mean().cast<double>(),
                        known = seen.visibility()->viewpoint(), told = given.position - input.shift();
  if (std::atan2((known - center).cross(told - center).norm(), (known - center).dot(told - center)) < kOneSide) return;
  console.warn(input.path + ": was seen from " + spelled(shiftedBack(known, input.shift()), 3) + " by its " +
               (seen.source() == ViewpointSource::Rays ? "rows and columns" : "stored viewpoint") +
               ", -viewpoint says otherwise");
}

}  // namespace

Viewpoint InputShape::viewpoint(const CommonOptions& common) const {
  if (shape.mesh && common.viewpoint.mode == Viewpoint::Mode::Auto) return {Viewpoint::Mode::None, {}};
  return shifted(common.viewpoint, shift());
}

InputShape loadInput(const Console& console, const std::string& path, const CommonOptions& common) {
  Step loading(console, "Loading " + path);
  const bool is_volume = common.takes_volumes && isVolumePath(path);
  if (!is_volume && (common.surface || !common.levels.empty()))
    throw InputError(path + (common.surface ? ": -surface" : ": -levels") + " is of volumes, " + kVolumeFiles);
  std::string summary;
  InputShape input =
      is_volume ? loadVolumeInput(path, common, summary) : loadInput(path, common.mesh_points, common.seed);
  const std::size_t num_points = input.points->size(), num_finite = finitePoints(*input.points).cols();
  const std::string all = num_finite < num_points ? " of " + std::to_string(num_points) : "";
  input.loading_ms = loading.done(counted(num_finite, "point") + all + summary);
  warnOfLeftOut(console, path, input.shape);
  if (!is_volume && !input.shape.mesh && common.mesh_points != CommonOptions().mesh_points)
    console.warn(path + ": -points is of meshes, a cloud keeps its own");
  checkViewpoint(console, input, common.viewpoint);
  return input;
}

}  // namespace pcl_symmetry::apps
