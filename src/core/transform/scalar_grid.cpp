#include "pcl_symmetry/core/scalar_grid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "pcl_symmetry/core/gaussian_edt.h"

namespace pcl_symmetry {

namespace {

using Factors = std::array<int, 3>;

/// The numbers of voxels that are averaged along each axis, so that voxels become similar in size and few.
/// \param max_ratio greatest ratio of two spacings.
Factors factorsFor(const ScalarGrid& grid, std::size_t max_voxels, double max_ratio) {
  constexpr int kLeastSize = 16;  // voxels along an axis: fewer are not averaged
  const Eigen::Vector3d spacing = grid.spacing();
  Factors factors{1, 1, 1};
  for (double wanted = std::max(spacing.minCoeff(), spacing.maxCoeff() / max_ratio);; wanted *= 1.26) {
    std::size_t num_voxels = 1;
    bool can_grow = false;
    for (int a = 0; a < 3; ++a) {
      const int most = std::max(1, grid.size()[a] / kLeastSize);
      factors[a] = std::clamp(static_cast<int>(std::lround(wanted / spacing[a])), 1, most);
      can_grow |= factors[a] < most;
      num_voxels *= grid.size()[a] / factors[a];
    }
    if (num_voxels <= max_voxels || !can_grow) return factors;
  }
}

/// Averages over groups of voxels; the remainder at the end of an axis is not used.
/// \param map maps a value to the one that is averaged.
template <typename Map>
ScalarGrid averaged(const ScalarGrid& grid, const Factors& factors, int num_threads, const Map& map) {
  const ScalarGrid::Size& from = grid.size();
  const ScalarGrid::Size size{from[0] / factors[0], from[1] / factors[1], from[2] / factors[2]};
  std::vector<float> values(static_cast<std::size_t>(size[0]) * size[1] * size[2], 0.0f);
  const float scale = 1.0f / static_cast<float>(factors[0] * factors[1] * factors[2]);
  parallelBlocks(size[2], num_threads, [&](std::size_t z) {
    for (int y = 0; y < size[1]; ++y) {
      float* const row = values.data() + (z * size[1] + y) * size[0];
      for (int k = 0; k < factors[2]; ++k)
        for (int j = 0; j < factors[1]; ++j) {
          const float* in = grid.values().data() +
                            ((z * factors[2] + k) * from[1] + static_cast<std::size_t>(y) * factors[1] + j) * from[0];
          for (int x = 0; x < size[0]; ++x)
            for (int i = 0; i < factors[0]; ++i) row[x] += map(*in++);
        }
      for (int x = 0; x < size[0]; ++x) row[x] *= scale;
    }
  });
  const Eigen::Vector3d group(factors[0], factors[1], factors[2]);
  Eigen::Affine3d T_index_group = Eigen::Affine3d::Identity();
  T_index_group.linear() = group.asDiagonal();
  T_index_group.translation() = 0.5 * (group.array() - 1.0);
  return ScalarGrid(size, grid.T_input_index() * T_index_group, std::move(values));
}

/// One pass of the weights 1/4, 1/2, 1/4 along an axis: a variance of half a voxel.
void smoothAlong(int axis, const ScalarGrid::Size& size, std::vector<float>& values, int num_threads) {
  const std::array<std::size_t, 3> steps{1, static_cast<std::size_t>(size[0]),
                                         static_cast<std::size_t>(size[0]) * size[1]};
  const int inner = axis == 0 ? 1 : 0, outer = axis == 2 ? 1 : 2;
  const std::size_t step = steps[axis];
  parallelBlocks(size[outer], num_threads, [&](std::size_t k) {
    for (int line = 0; line < size[inner]; ++line) {
      float* value = values.data() + k * steps[outer] + line * steps[inner];
      float before = *value;
      for (int i = 0; i < size[axis]; ++i, value += step) {
        const float here = *value, next = i + 1 < size[axis] ? value[step] : here;
        *value = 0.25f * (before + next) + 0.5f * here;
        before = here;
      }
    }
  });
}

/// A Gaussian filter, along axes whose voxels are small enough.
/// \param variance in units of the smallest spacing.
void smooth(const ScalarGrid::Size& size, const Eigen::Vector3d& spacing, double variance, std::vector<float>& values,
            int num_threads) {
  for (int a = 0; a < 3; ++a) {
    const double sq_width = variance * std::pow(spacing.minCoeff() / spacing[a], 2);
    for (int pass = 0; pass < static_cast<int>(std::lround(2.0 * sq_width)); ++pass)
      smoothAlong(a, size, values, num_threads);
  }
}

/// The threshold between two classes of values that differ most (Otsu 1979), and the mean below it.
struct TwoClasses {
  double threshold, low_mean;

  /// \param sorted ascending.
  explicit TwoClasses(const std::vector<float>& sorted) : threshold(sorted.front()), low_mean(sorted.front()) {
    double total = 0.0, below = 0.0, most = -1.0;
    for (const float value : sorted) total += value;
    const double n = static_cast<double>(sorted.size());
    for (std::size_t i = 0; i + 1 < sorted.size(); ++i) {
      below += sorted[i];
      if (sorted[i + 1] == sorted[i]) continue;
      const double k = static_cast<double>(i + 1), gap = below / k - (total - below) / (n - k);
      if (k * (n - k) * gap * gap <= most) continue;
      most = k * (n - k) * gap * gap;
      threshold = 0.5 * (sorted[i] + sorted[i + 1]);
      low_mean = below / k;
    }
  }
};

/// Finite values of a volume, one from each of equal runs, ascending.
std::vector<float> someValues(const std::vector<float>& values) {
  constexpr std::size_t kMostValues = 200'000;  // an error of 0.1 % of a quantile
  std::vector<float> some;
  const std::size_t step = values.size() / kMostValues + 1;
  // A step that has no factor in common with a row.
  for (std::size_t i = 0, k = 0; i < values.size(); i += step + (++k % 3 == 0))
    if (std::isfinite(values[i])) some.push_back(values[i]);
  std::sort(some.begin(), some.end());
  return some;
}

VolumeLevels levelsOf(const ScalarGrid& volume, const VolumeLevels& given) {
  given.validate();
  for (const int n : volume.size())
    if (n < 4) throw VolumeWithoutAnswer("volume: slices along an axis = " + std::to_string(n) + ", must be >= 4");
  const std::vector<float> values = someValues(volume.values());
  if (values.empty()) throw VolumeWithoutAnswer("volume: no finite value");
  if (given.low < given.high) return given;
  const double highest = values[0.995 * static_cast<double>(values.size() - 1)];
  VolumeLevels levels{TwoClasses(values).low_mean, highest};
  if (!(levels.low < levels.high)) levels.high = values.back();  // for a body of less than half a percent of the voxels
  if (!(levels.low < levels.high)) throw VolumeWithoutAnswer("volume: all values are equal");
  return levels;
}

double bodyThreshold(const std::vector<float>& f) {
  const std::vector<float> values = someValues(f);
  if (values.front() == values.back()) throw VolumeWithoutAnswer("volume: all values are equal between the levels");
  return TwoClasses(values).threshold;
}

}  // namespace

ScalarGrid::ScalarGrid(const Size& size, const Eigen::Affine3d& T_input_index, std::vector<float> values)
    : size_(size), T_input_index_(T_input_index), values_(std::move(values)) {
  std::size_t num_voxels = 1;
  for (const int n : size) {
    check(n >= 1, "size of the volume", n, ">= 1");
    num_voxels *= static_cast<std::size_t>(n);
  }
  check(values_.size() == num_voxels, "number of values", values_.size(), "one for each voxel");
  const double volume = std::abs(T_input_index.linear().determinant()), product = spacing().prod();
  if (!T_input_index.matrix().allFinite() || !(volume > 1e-6 * product))
    throw std::invalid_argument("T_input_index: not finite or not invertible, must place the voxels in space");
  last_ = Eigen::Vector3d(size[0], size[1], size[2]).array() - 1.0;
  step_ = {1, static_cast<std::size_t>(size[0]), static_cast<std::size_t>(size[0]) * size[1]};
  for (int a = 0; a < 3; ++a)
    if (size[a] == 1) step_[a] = 0;
}

Eigen::Affine3d ScalarGrid::placed(const Eigen::Vector3d& spacing, const Eigen::Vector3d& origin,
                                   const Eigen::Matrix3d& direction) {
  check(spacing.allFinite() && (spacing.array() > 0.0).all(), "spacing", spacing.transpose(), "finite and > 0");
  Eigen::Affine3d T_input_index = Eigen::Affine3d::Identity();
  T_input_index.linear() = direction * spacing.asDiagonal();
  T_input_index.translation() = origin;
  return T_input_index;
}

double ScalarGrid::at(const Eigen::Vector3d& p) const {
  const Eigen::Vector3i c = p.cast<int>().cwiseMin((last_.array() - 1.0).max(0.0).matrix().cast<int>());
  const Eigen::Vector3d t = p - c.cast<double>();
  const float* const v = values_.data() + (static_cast<std::size_t>(c.z()) * size_[1] + c.y()) * size_[0] + c.x();
  const auto [dx, dy, dz] = step_;
  const auto between = [](double a, double b, double s) { return a + s * (b - a); };
  const double x00 = between(v[0], v[dx], t.x()), x10 = between(v[dy], v[dy + dx], t.x());
  const double x01 = between(v[dz], v[dz + dx], t.x()), x11 = between(v[dz + dy], v[dz + dy + dx], t.x());
  return between(between(x00, x10, t.y()), between(x01, x11, t.y()), t.z());
}

void VolumeLevels::validate() const {
  check(std::isfinite(low) && std::isfinite(high), "levels", high, "finite");
  check(low < high || (low == 0.0 && high == 0.0), "levels: high", high, "more than low");
}

VolumeFunction::VolumeFunction(const ScalarGrid& volume, const VolumeLevels& given, std::size_t max_voxels,
                               int num_threads)
    : f({1, 1, 1}, Eigen::Affine3d::Identity(), {0.0f}), levels(levelsOf(volume, given)) {
  // Noise of the background is kept until it is averaged: cut off at 0, it would turn the box of the volume into a
  // body.
  const float low = static_cast<float>(levels.low), scale = static_cast<float>(1.0 / (levels.high - levels.low));
  const float least = given.low < given.high ? 0.0f : -1.0f;
  f = averaged(volume, factorsFor(volume, max_voxels, 8.0), num_threads,
               [&](float value) { return value > -1e30f ? std::clamp((value - low) * scale, least, 1.0f) : 0.0f; });
  smooth(f.size(), f.spacing(), 0.5, f.values_, num_threads);
  for (float& value : f.values_) value = std::max(0.0f, value);
  body = bodyThreshold(f.values());
}

VolumeFunction::VolumeFunction(const VolumeFunction& finer, std::size_t max_voxels, int num_threads)
    : f(averaged(finer.f, factorsFor(finer.f, max_voxels, 2.0), num_threads, [](float value) { return value; })),
      levels(finer.levels) {
  smooth(f.size(), f.spacing(), 1.0, f.values_, num_threads);
  body = bodyThreshold(f.values());
}

Points VolumeFunction::bodyPoints(bool surface) const {
  std::vector<Eigen::Vector3f> points;
  const auto [nx, ny, nz] = f.size();
  std::size_t i = 0;
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x, ++i) {
        const float* const v = f.values().data() + i;
        const auto outside = [&](std::ptrdiff_t step) { return v[step] <= body; };
        const std::ptrdiff_t row = nx, slice = row * ny;
        const bool is_inner = x > 0 && y > 0 && z > 0 && x + 1 < nx && y + 1 < ny && z + 1 < nz;
        if (*v <= body || (surface && (!is_inner || !(outside(-1) || outside(1) || outside(-row) || outside(row) ||
                                                      outside(-slice) || outside(slice)))))
          continue;
        points.push_back((f.T_input_index() * Eigen::Vector3d(x, y, z)).cast<float>());
      }
  Points result(3, points.size());
  for (std::size_t k = 0; k < points.size(); ++k) result.col(k) = points[k];
  return result;
}

GaussianEdt::GaussianEdt(const VolumeFunction& volume, const GaussianEdtOptions& options) {
  options.validate();
  cover(options.radius > 0.0 ? BoundingBall{options.center, options.radius} : boundingBall(volume.bodyPoints(false)),
        options.num_cells, 0.0);
  const int n = num_cells_;
  values_.assign(static_cast<std::size_t>(n) * n * n, 0.0f);
  const Eigen::Affine3d T_index_input = volume.f.T_input_index().inverse();
  parallelRanges(values_.size(), static_cast<std::size_t>(n) * n, options.num_threads,
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t i = begin; i < end; ++i) {
                     const Eigen::Vector3d p = T_index_input * cellCenter(i);
                     if (volume.f.contains(p)) values_[i] = static_cast<float>(volume.f.at(p));
                   }
                 });
  finish(options.num_threads);
  if (sq_norm_ == 0.0) throw VolumeWithoutAnswer("volume: nothing in the ball given by center and radius");
}

}  // namespace pcl_symmetry
