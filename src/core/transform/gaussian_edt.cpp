#include "pcl_symmetry/core/gaussian_edt.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/base/simd.h"
#include "core/base/statistics.h"
#include "core/geometry/point_samples.h"
#include "core/transform/transform_rules.h"

namespace pcl_symmetry {

namespace {

/// The ball that a grid of cells covers.
/// \param given used if its radius is > 0; otherwise the ball around the points, without stray ones, is used.
/// \throws std::invalid_argument without a point, for a value that is not finite, and for a ball without extent.
BoundingBall coveredBall(const PointsRef& points, const BoundingBall& given) {
  checkPoints(points);
  const BoundingBall ball = given.radius > 0.0 ? given : boundingBall(withoutStrayPoints(points));
  if (!(ball.radius > std::numeric_limits<float>::epsilon() * ball.center.norm()))
    throw std::invalid_argument("points: all at one position, must have an extent");
  return ball;
}

/// Typical distance between neighboring samples: twice the median distance to the nearest other point, over a fixed
/// number of probes. For random samples this is 0.94 / sqrt(density) on a surface, and the median gap on a curve.
/// \param points 3 x N, finite.
/// \return input units; 0 if all points coincide.
double sampleSpacing(const PointsRef& points) {
  // A standard error of 13 % for random samples of a surface; with half as many, 18 %, with twice as many, 9 %.
  constexpr Eigen::Index kNumProbes = 32;
  const Eigen::Index size = points.cols(), num_probes = std::min(kNumProbes, size);
  std::vector<double> nearest;
  for (Eigen::Index k = 0; k < num_probes; ++k) {
    float sq_nearest = std::numeric_limits<float>::max();
    for (Eigen::Index i = 0; i < size; ++i) {
      const float sq_distance = (points.col(i) - points.col(k * size / num_probes)).squaredNorm();
      if (sq_distance > 0.0f) sq_nearest = std::min(sq_nearest, sq_distance);
    }
    if (sq_nearest < std::numeric_limits<float>::max()) nearest.push_back(std::sqrt(static_cast<double>(sq_nearest)));
  }
  return nearest.empty() ? 0.0 : 2.0 * median(std::move(nearest));
}

/// A float clamped to [low, high], as an integer; rounded toward zero.
int clampedInt(float value, int low, int high) {
  return static_cast<int>(std::clamp(value, static_cast<float>(low), static_cast<float>(high)));
}

constexpr int kLanes = 8;  // floats in an AVX2 register: compilers split wider arrays into single floats

/// Cells [begin, end) along an axis.
struct CellSpan {
  int begin, end;
};

/// Lowers the squared distances of cells to their distances from a point.
/// \param stride stride of the rows of \p layer, whose first slice has the number \p first_slice. A few cells behind \p
/// x are lowered, too: a row ends with kLanes of them.
PCL_SYMMETRY_MULTIVERSION
void lowerAround(const float* point, CellSpan x, CellSpan y, CellSpan z, float sq_reach, std::ptrdiff_t stride,
                 std::ptrdiff_t num_rows, float* layer, int first_slice) {
  typedef float Lanes __attribute__((vector_size(kLanes * sizeof(float))));
  const float px = point[0], py = point[1], pz = point[2];
  Lanes first;
  for (int l = 0; l < kLanes; ++l) first[l] = static_cast<float>(x.begin + l) - px;
  for (int k = z.begin; k < z.end; ++k) {
    for (int j = y.begin; j < y.end; ++j) {
      const float dy = static_cast<float>(j) - py, dz = static_cast<float>(k) - pz, sq_across = dz * dz + dy * dy;
      if (sq_across >= sq_reach) continue;
      float* cells = layer + ((k - first_slice) * num_rows + j) * stride + x.begin;
      Lanes dx = first, low;
      for (int i = x.begin; i < x.end; i += kLanes, cells += kLanes, dx += static_cast<float>(kLanes)) {
        std::memcpy(&low, cells, sizeof low);
        const Lanes sq_distance = sq_across + dx * dx;
        low = sq_distance < low ? sq_distance : low;
        std::memcpy(cells, &low, sizeof low);
      }
    }
  }
}

/// Squared distances of the cells of a cube from the nearest of some points, exact up to a reach (Section 4.1).
/// \param points 3 x N, in cells from the center of cell (0, 0, 0).
/// \param reach distance beyond which distances do not matter, cells, > 0.
/// \return num_cells^3 values, x fastest: at most reach^2.
std::vector<float> sqCellDistances(const Points& points, int num_cells, float reach, int num_threads) {
  const auto n = static_cast<std::size_t>(num_cells), stride = n + kLanes;
  const auto span = [&](float at, int low, int high) {
    return CellSpan{clampedInt(std::ceil(at - reach), low, high), clampedInt(std::floor(at + reach) + 1.0f, low, high)};
  };
  std::vector<float> result(n * n * n);
  constexpr std::size_t num_slices = 8;  // slices of a layer, whose cells stay in the second-level cache
  parallelRanges(n, num_slices, num_threads, [&](std::size_t begin, std::size_t end) {
    const int first = static_cast<int>(begin);
    std::vector<float> layer((end - begin) * n * stride, reach * reach);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      const Eigen::Vector3f p = points.col(i);
      const CellSpan z = span(p.z(), first, static_cast<int>(end));
      if (z.begin == z.end) continue;
      lowerAround(p.data(), span(p.x(), 0, num_cells), span(p.y(), 0, num_cells), z, reach * reach, stride, n,
                  layer.data(), first);
    }
    for (std::size_t row = 0; row < (end - begin) * n; ++row)
      std::copy_n(&layer[row * stride], n, &result[(begin * n + row) * n]);
  });
  return result;
}

/// One row of GaussianEdt::sharpened(), without its ends.
PCL_SYMMETRY_MULTIVERSION
void sharpenRow(const float* f, std::ptrdiff_t num_cells, std::ptrdiff_t slice_size, float weight, float* sharpened) {
  for (std::ptrdiff_t x = 1; x + 1 < num_cells; ++x) {
    const float laplacian =
        f[x - 1] + f[x + 1] + f[x - num_cells] + f[x + num_cells] + f[x - slice_size] + f[x + slice_size] - 6.0f * f[x];
    sharpened[x] = std::max(0.0f, f[x] - weight * laplacian);
  }
}

/// Keeps the first point in each slot, 1/64 of a cell.
/// \param points in cells.
Points thin(const Points& points, int num_cells) {
  const int side = kTransform.slots_per_cell * num_cells;
  std::vector<bool> taken(static_cast<std::size_t>(side) * side * side);
  Points kept(3, points.cols());
  Eigen::Index num_kept = 0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const auto at = [&](int axis) {
      return static_cast<std::size_t>(clampedInt(kTransform.slots_per_cell * (points(axis, i) + 0.5f), 0, side - 1));
    };
    const std::size_t slot = (at(2) * side + at(1)) * side + at(0);
    if (taken[slot]) continue;
    taken[slot] = true;
    kept.col(num_kept++) = points.col(i);
  }
  kept.conservativeResize(3, num_kept);
  return kept;
}

}  // namespace

void GaussianEdtOptions::validate() const {
  check(num_cells >= 8 && num_cells <= 512, "num_cells", num_cells, "in [8, 512]");
  check(std::isfinite(sigma) && sigma >= 0.0, "sigma", sigma, "finite and >= 0");
  check(std::isfinite(radius) && radius >= 0.0, "radius", radius, "finite and >= 0");
  check(center.allFinite(), "center", center.transpose(), "finite");
  checkNumThreads(num_threads);
}

GaussianEdt::GaussianEdt(const PointsRef& points, const GaussianEdtOptions& options) {
  options.validate();
  const BoundingBall ball = coveredBall(points, {options.center, options.radius});
  cover(ball, options.num_cells, options.sigma);
  const double max_spacing = kTransform.max_spacing * radius_;
  if (options.sigma == 0.0 && points.cols() <= kTransform.num_dense && sigma_ < max_spacing)
    if (const double spacing = std::min(sampleSpacing(points), max_spacing); spacing > sigma_)
      cover(ball, options.num_cells, spacing);
  computeValues(points, options.num_threads);
}

void GaussianEdt::cover(const BoundingBall& ball, int num_cells, double sigma) {
  num_cells_ = num_cells;
  center_ = ball.center;
  radius_ = ball.radius;
  const double half = 0.5 * num_cells_;
  cell_size_ = sigma > 0.0
                   ? (radius_ + kTransform.margin_in_sigmas * sigma) / half
                   : radius_ / std::max(half - kTransform.margin_in_sigmas * kTransform.sigma_in_cells, 0.5 * half);
  sigma_ = sigma > 0.0 ? sigma : kTransform.sigma_in_cells * cell_size_;
  origin_ = center_ - Eigen::Vector3d::Constant((half - 0.5) * cell_size_);
}

void GaussianEdt::computeValues(const PointsRef& points, int num_threads) {
  const int n = num_cells_;
  const std::size_t slice_size = static_cast<std::size_t>(n) * n;
  Points cells = normalizePoints(points, origin_, cell_size_);
  if (static_cast<std::size_t>(cells.cols()) > kTransform.dense_per_cell * slice_size) {
    cells = thin(cells, n);
    thinning_ = std::sqrt(3.0) / kTransform.slots_per_cell;
  }
  const float reach = static_cast<float>(kTransform.reach_in_sigmas * sigma_ / cell_size_), sq_reach = reach * reach;
  values_ = sqCellDistances(cells, n, reach, num_threads);
  // Section 4.1: f = exp(-dist^2 / sigma^2).
  const double scale = -1.0 / std::pow(sigma_ / cell_size_, 2);
  parallelRanges(values_.size(), slice_size, num_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      values_[i] = values_[i] >= sq_reach ? 0.0f : static_cast<float>(std::exp(scale * values_[i]));
  });
  finish(num_threads);
  if (sq_norm_ == 0.0) throw std::invalid_argument("points: none near the ball given by center and radius");
}

void GaussianEdt::finish(int num_threads) {
  const int n = num_cells_;
  filled_.assign(static_cast<std::size_t>(n) * n, {0, 0});
  std::vector<double> sums(n, 0.0), sq_sums(n, 0.0);
  parallelBlocks(n, num_threads, [&](std::size_t slice) {
    for (std::size_t row = slice * n; row < (slice + 1) * n; ++row) {
      Range& filled = filled_[row];
      for (int x = 0; x < n; ++x) {
        const double value = values_[row * n + x];
        if (value <= 0.0) continue;
        sums[slice] += value;
        sq_sums[slice] += value * value;
        filled = {filled.end == 0 ? x : filled.begin, x + 1};
      }
    }
  });
  sum_ = std::accumulate(sums.begin(), sums.end(), 0.0);
  sq_norm_ = std::accumulate(sq_sums.begin(), sq_sums.end(), 0.0);
  interpolation_ = sharpened(kTransform.of_interpolation, num_threads);
}

Eigen::Vector3d GaussianEdt::cellCenter(std::size_t index) const {
  const std::size_t n = num_cells_;
  return origin_ + cell_size_ * Eigen::Vector3d(static_cast<double>(index % n), static_cast<double>(index / n % n),
                                                static_cast<double>(index / n / n));
}

std::vector<float> GaussianEdt::sharpened(double c, int num_threads) const {
  const int n = num_cells_;
  const std::size_t slice_size = static_cast<std::size_t>(n) * n;
  std::vector<float> result(values_);
  parallelBlocks(n - 2, num_threads, [&](std::size_t slice) {
    for (int y = 1; y + 1 < n; ++y) {
      const std::size_t row = (slice + 1) * slice_size + static_cast<std::size_t>(y) * n;
      sharpenRow(values_.data() + row, n, slice_size, static_cast<float>(c), result.data() + row);
    }
  });
  return result;
}

}  // namespace pcl_symmetry
