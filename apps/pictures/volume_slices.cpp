#include "pictures/volume_slices.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "pictures/colors.h"

namespace pcl_symmetry::apps {

namespace {

const Eigen::Vector3d kBrighter(0.90, 0.62, 0.0), kDarker(0.0, 0.45, 0.70);  // color-blind readers distinguish them
const Eigen::Vector3d kLine(0.84, 0.37, 0.0);
constexpr double kFullColor = 0.3;  // difference of f at which the color is full

/// A volume that is sampled at points of the input frame.
class SlicedVolume {
public:
  SlicedVolume(const ScalarGrid& volume, const VolumeLevels& levels)
      : function_(volume, levels, std::size_t{1} << 23), T_index_input_(function_.f.T_input_index().inverse()) {
    const Points body = function_.bodyPoints(false);
    low_ = body.rowwise().minCoeff().cast<double>();
    high_ = body.rowwise().maxCoeff().cast<double>();
  }

  std::optional<double> at(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d p = T_index_input_ * x;
    return function_.f.contains(p) ? std::optional<double>(function_.f.at(p)) : std::nullopt;
  }
  Eigen::Vector3d middle() const { return 0.5 * (low_ + high_); }
  double extent() const { return 1.15 * (high_ - low_).maxCoeff(); }

private:
  VolumeFunction function_;
  Eigen::Affine3d T_index_input_;
  Eigen::Vector3d low_, high_;
};

RasterImage drawSlice(const SlicedVolume& volume, int axis, const std::optional<ReflectionPlane>& plane, bool compared,
                      int size) {
  const int across = axis == 0 ? 1 : 0, up = axis == 2 ? 1 : 2;
  const double step = volume.extent() / size;
  RasterImage image(size, size);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      Eigen::Vector3d at = volume.middle();
      at[across] += (x + 0.5 - 0.5 * size) * step;
      at[up] -= (y + 0.5 - 0.5 * size) * step;
      const double own = volume.at(at).value_or(0.0);
      Eigen::Vector3d color = Eigen::Vector3d::Constant(own);
      if (compared) {
        const std::optional<double> other = volume.at(plane->reflect(at));
        const double difference = other ? own - *other : 0.0, share = std::min(1.0, std::abs(difference) / kFullColor);
        color = (1.0 - share) * Eigen::Vector3d::Constant(1.0 - 0.35 * own) +
                share * (difference > 0.0 ? kBrighter : kDarker);
      }
      if (plane) {
        const double in_slice = std::hypot(plane->normal()[across], plane->normal()[up]);
        if (in_slice > 0.05 && std::abs(plane->signedDistance(at)) < 0.8 * step * in_slice) color = kLine;
      }
      image.set(x, y, color);
    }
  return image;
}

}  // namespace

RasterImage drawVolumeSlices(const ScalarGrid& volume, const VolumeLevels& levels,
                             const std::optional<ReflectionPlane>& plane, int size) {
  const SlicedVolume sliced(volume, levels);
  std::vector<RasterImage> slices;
  for (const bool compared : {false, true})
    for (const int axis : {2, 0, 1})
      if (plane || !compared) slices.push_back(drawSlice(sliced, axis, plane, compared, size));
  return sideBySide(slices, 3);
}

}  // namespace pcl_symmetry::apps
