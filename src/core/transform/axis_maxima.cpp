#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/transform/axial_rotations.h"
#include "core/transform/line_sums.h"
#include "core/transform/transform_rules.h"
#include "pcl_symmetry/core/axial_transform.h"

namespace pcl_symmetry {

int bestFold(const std::vector<int>& folds, const std::vector<double>& values) {
  const double least = *std::max_element(values.begin(), values.end()) - kTransform.equal_orders;
  int best = -1;
  for (std::size_t i = 0; i < folds.size(); ++i)
    if (values[i] >= least && best != 0 && (folds[i] == 0 || folds[i] > best)) best = folds[i];
  return best;
}

namespace {

bool isSameAxis(const Line3d& a, const Line3d& b, const Eigen::Vector3d& center, double angle, double distance) {
  const double cosine = std::abs(a.direction().dot(b.direction()));
  return cosine > std::cos(angle) && (a.projection(center) - b.projection(center)).norm() < distance;
}

/// D of axes between the bins, by the same estimate as at the bins.
class AxisClimb {
public:
  AxisClimb(const GaussianEdt& edt, const AxisMap& map, const AxialTransformOptions& options)
      : edt_(edt),
        map_(map),
        rotations_(rotationsOf(map.folds, false)),
        samples_(
            centeredSamples(edt, kTransform.more_samples * options.num_samples, options.seed, options.num_threads)) {}

  std::vector<double> valuesAt(const Line3d& axis) const {
    std::vector<double> values(map_.folds.size(), 0.0);
    for (const AxialRotation& rotation : rotations_) {
      const double d = symmetryAt(axis, rotation.angle);
      for (std::size_t i = 0; i < values.size(); ++i) values[i] += rotation.weights[i] * d;
    }
    return values;
  }

  /// The axis moved to where D of its best fold is greatest, in steps of half a bin that are halved.
  AxisMaximum climbed(Line3d axis) const {
    const int fold = bestFold(map_.folds, valuesAt(axis));
    const std::size_t position = std::find(map_.folds.begin(), map_.folds.end(), fold) - map_.folds.begin();
    double angle = 0.25 * kPi / map_.grid.numTheta(), offset = 0.5 * map_.grid.offsetStep();
    double best = valueAt(axis, position);
    for (int halving = 0; halving < kTransform.halvings; angle *= 0.5, offset *= 0.5, ++halving)
      for (bool moved = true; moved;) {
        moved = false;
        for (int way = 0; way < 8; ++way) {
          const Line3d next = stepped(axis, way, way % 2 ? -1.0 : 1.0, angle, offset);
          const double value = valueAt(next, position);
          if (value <= best) continue;
          axis = next;
          best = value;
          moved = true;
        }
      }
    AxisMaximum maximum{axis, fold, 0.0, valuesAt(axis)};
    maximum.fold = bestFold(map_.folds, maximum.values);
    maximum.value = *std::max_element(maximum.values.begin(), maximum.values.end());
    return maximum;
  }

private:
  double symmetryAt(const Line3d& axis, double angle) const {
    const Eigen::Matrix3d rotation = Eigen::AngleAxisd(angle, axis.direction()).toRotationMatrix();
    const Eigen::Vector3d foot = toCells(edt_, axis.origin());
    const Eigen::Vector3d middle = Eigen::Vector3d::Constant(0.5 * (edt_.numCells() - 1));
    double sum = 0.0;
    for (Eigen::Index i = 0; i < samples_.cols(); ++i)
      sum += edt_.atCell(rotation * (samples_.col(i).cast<double>() - foot) + foot + middle);
    return edt_.sum() / edt_.sqNorm() * sum / static_cast<double>(samples_.cols());
  }

  double valueAt(const Line3d& axis, std::size_t fold) const {
    double value = 0.0;
    for (const AxialRotation& rotation : rotations_)
      if (rotation.weights[fold] > 0.0) value += rotation.weights[fold] * symmetryAt(axis, rotation.angle);
    return value;
  }

  Line3d stepped(const Line3d& axis, int way, double sign, double angle, double offset) const {
    const Eigen::Vector3d u = axis.direction().unitOrthogonal(), v = axis.direction().cross(u);
    const Eigen::Vector3d& along = way / 2 % 2 ? v : u;
    const Eigen::Vector3d foot = axis.projection(map_.grid.center());
    if (way >= 4) return {foot + sign * offset * along, axis.direction()};
    return {foot, (axis.direction() + sign * std::tan(angle) * along).normalized()};
  }

  const GaussianEdt& edt_;
  const AxisMap& map_;
  std::vector<AxialRotation> rotations_;
  Eigen::Matrix3Xf samples_;
};

/// Bins with great values, none near a stronger one.
std::vector<Line3d> startsOf(const AxisMap& map, std::size_t count, double least) {
  std::vector<std::size_t> bins;
  for (std::size_t i = 0; i < map.greatest.size(); ++i)
    if (map.greatest[i] >= least) bins.push_back(i);
  const std::size_t kept = std::min(bins.size(), kTransform.max_axis_bins);
  std::partial_sort(bins.begin(), bins.begin() + kept, bins.end(), [&](std::size_t a, std::size_t b) {
    return std::make_pair(-map.greatest[a], a) < std::make_pair(-map.greatest[b], b);
  });
  bins.resize(kept);
  std::vector<Line3d> starts;
  for (const std::size_t bin : bins) {
    if (starts.size() == count) break;
    const Line3d axis = map.grid.axis(map.grid.bin(bin));
    if (std::none_of(starts.begin(), starts.end(), [&](const Line3d& other) {
          return isSameAxis(axis, other, map.grid.center(), kTransform.same_start, kTransform.same_offset * map.sigma);
        }))
      starts.push_back(axis);
  }
  return starts;
}

}  // namespace

std::vector<AxisMaximum> axisMaxima(const AxisMap& map, const GaussianEdt& edt, int count, double min_value,
                                    const AxialTransformOptions& options) {
  options.validate();
  check(count >= 1, "count", count, ">= 1");
  check(min_value >= 0.0 && min_value <= 1.0, "min_value", min_value, "in [0, 1]");
  if (map.empty()) return {};
  const std::vector<Line3d> starts =
      startsOf(map, static_cast<std::size_t>(count) * kTransform.starts_per_maximum, kTransform.min_of_bin * min_value);
  const AxisClimb climb(edt, map, options);
  std::vector<AxisMaximum> climbed(starts.size());
  parallelBlocks(starts.size(), options.num_threads, [&](std::size_t i) { climbed[i] = climb.climbed(starts[i]); });
  std::stable_sort(climbed.begin(), climbed.end(),
                   [](const AxisMaximum& a, const AxisMaximum& b) { return a.value > b.value; });
  std::vector<AxisMaximum> maxima;
  for (const AxisMaximum& maximum : climbed) {
    if (maximum.value < min_value || static_cast<int>(maxima.size()) == count) break;
    if (std::none_of(maxima.begin(), maxima.end(), [&](const AxisMaximum& other) {
          return isSameAxis(maximum.axis, other.axis, map.grid.center(), kTransform.same_maximum,
                            kTransform.same_offset * map.sigma);
        }))
      maxima.push_back(maximum);
  }
  return maxima;
}

namespace {

constexpr std::size_t points_at_a_time = 1024;  // their values stay in the first cache

/// Values of one direction, bilinear between their bins and 0 beyond.
class DirectionValues {
public:
  DirectionValues(const AxisMap& map, std::size_t direction)
      : num_(map.grid.numOffset()),
        values_(map.greatest.data() + direction * num_ * num_),
        per_unit_(static_cast<float>(1.0 / map.grid.offsetStep())),
        // moves offset(0) to 0
        shift_(0.5f * static_cast<float>(num_) - 0.5f) {}

  float operator()(float u, float v) const {
    // A point in the outer half of a bin at the border has the value of that bin.
    const float most = static_cast<float>(num_) - 1.0f;
    const float x = u * per_unit_ + shift_, y = v * per_unit_ + shift_;
    if (!(x >= -0.5f && y >= -0.5f && x <= most + 0.5f && y <= most + 0.5f)) return 0.0f;
    const float in_x = std::clamp(x, 0.0f, most), in_y = std::clamp(y, 0.0f, most);
    const int i = std::min(static_cast<int>(in_x), std::max(0, num_ - 2));
    const int j = std::min(static_cast<int>(in_y), std::max(0, num_ - 2));
    const int right = num_ > 1, up = num_ > 1 ? num_ : 0;
    const float s = in_x - static_cast<float>(i), t = in_y - static_cast<float>(j);
    const float* at = values_ + static_cast<std::size_t>(j) * num_ + i;
    return (1.0f - t) * ((1.0f - s) * at[0] + s * at[right]) + t * ((1.0f - s) * at[up] + s * at[up + right]);
  }

private:
  int num_;
  const float* values_;
  float per_unit_, shift_;
};

}  // namespace

std::vector<float> axialPointSymmetry(const AxisMap& map, const PointsRef& points, int num_threads) {
  std::vector<float> greatest(points.cols(), 0.0f);
  if (map.empty()) return greatest;
  const Points centered = normalizePoints(points, map.grid.center(), 1.0);
  parallelRanges(greatest.size(), points_at_a_time, num_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t direction = 0; direction < map.grid.numDirections(); ++direction) {
      const DirectionValues values(map, direction);
      const Eigen::Matrix3f frame = map.grid.frame(direction).cast<float>();
      for (std::size_t i = begin; i < end; ++i) {
        const auto x = centered.col(i);
        greatest[i] = std::max(greatest[i], values(frame.col(0).dot(x), frame.col(1).dot(x)));
      }
    }
  });
  return greatest;
}

}  // namespace pcl_symmetry
