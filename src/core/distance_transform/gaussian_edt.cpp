#include "pcl_symmetry/core/distance_transform/gaussian_edt.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/base/simd.h"

namespace pcl_symmetry {

namespace {

constexpr double kSigmaInCells = 2.0;
constexpr double kMarginInSigmas = 2.0;  // f < 2 % outside the grid
constexpr double kReachInSigmas = 2.6;   // f < 1.2e-3 beyond, less than 3e-4 of its integral

/// Lowers the squared distances of a slice's cells to those from one point, over a square that covers its reach; all
/// lengths in cells.
PCL_SYMMETRY_MULTIVERSION
void lowerSlice(float* sq_distances, int num_cells, float x, float y, float sq_dz, float reach, int width) {
  const float sq_radius = reach * reach - sq_dz;
  if (sq_radius <= 0.0f) return;
  const float radius = std::sqrt(sq_radius);
  const int y_begin = std::max(0, static_cast<int>(std::ceil(y - radius)));
  const int y_end = std::min(num_cells, static_cast<int>(std::floor(y + radius)) + 1);
  const int x_begin = std::clamp(static_cast<int>(std::ceil(x - reach)), 0, num_cells - width);
  const float dx = static_cast<float>(x_begin) - x;
  for (int row = y_begin; row < y_end; ++row) {
    const float dy = static_cast<float>(row) - y;
    const float sq_row_distance = sq_dz + dy * dy;
    float* const cells = sq_distances + static_cast<std::ptrdiff_t>(row) * num_cells + x_begin;
    for (int i = 0; i < width; ++i) {
      const float d = dx + static_cast<float>(i);
      const float sq_distance = d * d + sq_row_distance;
      cells[i] = sq_distance < cells[i] ? sq_distance : cells[i];
    }
  }
}

/// One row of GaussianEdt::sharpened, without its ends.
PCL_SYMMETRY_MULTIVERSION
void sharpenRow(const float* f, std::ptrdiff_t num_cells, std::ptrdiff_t slice_size, float weight, float* sharpened) {
  for (std::ptrdiff_t x = 1; x + 1 < num_cells; ++x) {
    const float laplacian =
        f[x - 1] + f[x + 1] + f[x - num_cells] + f[x + num_cells] + f[x - slice_size] + f[x + slice_size] - 6.0f * f[x];
    sharpened[x] = std::max(0.0f, f[x] - weight * laplacian);
  }
}

/// Typical distance between neighbouring samples of a surface, 1 / sqrt(density): twice the mean distance to the
/// nearest other point, over a fixed number of probes; 0 for clouds too large to be sparse.
double sampleSpacing(const PointsRef& points) {
  constexpr Eigen::Index kNumProbes = 32, kNumDense = 200'000;
  const Eigen::Index size = points.cols();
  if (size < 2 || size > kNumDense) return 0.0;
  const Eigen::Index num_probes = std::min(kNumProbes, size);
  std::vector<double> nearest;
  for (Eigen::Index k = 0; k < num_probes; ++k) {
    const Eigen::Vector3f probe = points.col(k * size / num_probes);
    float sq_nearest = std::numeric_limits<float>::max();
    for (Eigen::Index i = 0; i < size; ++i) {
      const float sq_distance = (points.col(i) - probe).squaredNorm();
      if (sq_distance > 0.0f && sq_distance < sq_nearest) sq_nearest = sq_distance;
    }
    if (sq_nearest < std::numeric_limits<float>::max()) nearest.push_back(std::sqrt(static_cast<double>(sq_nearest)));
  }
  if (nearest.empty()) return 0.0;
  std::nth_element(nearest.begin(), nearest.begin() + nearest.size() / 2, nearest.end());
  return 2.0 * nearest[nearest.size() / 2];
}

/// One point per 1/64 cell, the first of each; positions in cells.
Points thin(const Points& points, int num_cells) {
  const int side = 4 * num_cells;
  std::vector<bool> taken(static_cast<std::size_t>(side) * side * side);
  Points kept(3, points.cols());
  Eigen::Index num_kept = 0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const auto at = [&](int axis) {
      return static_cast<std::size_t>(std::clamp(static_cast<int>(4.0f * (points(axis, i) + 0.5f)), 0, side - 1));
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
  if (points.cols() == 0) throw std::invalid_argument("points: 0 given, must be >= 1");
  if (!points.allFinite()) throw std::invalid_argument("points: a coordinate is not finite");
  num_cells_ = options.num_cells;
  center_ = options.center;
  radius_ = options.radius;
  if (radius_ == 0.0) {
    const BoundingBall ball = boundingBall(points);
    center_ = ball.center;
    radius_ = ball.radius;
  }
  if (!(radius_ > std::numeric_limits<float>::epsilon() * center_.norm()))
    throw std::invalid_argument("points: all at one place, must have an extent");

  const double half = 0.5 * num_cells_;
  if (options.sigma > 0.0) {
    sigma_ = options.sigma;
    cell_size_ = (radius_ + kMarginInSigmas * sigma_) / half;
  } else {
    cell_size_ = radius_ / std::max(half - kMarginInSigmas * kSigmaInCells, 0.5 * half);
    sigma_ = kSigmaInCells * cell_size_;
    const double spacing = std::min(sampleSpacing(points), 0.25 * radius_);
    if (spacing > sigma_) {
      sigma_ = spacing;
      cell_size_ = (radius_ + kMarginInSigmas * sigma_) / half;
    }
  }
  origin_ = center_ - Eigen::Vector3d::Constant((half - 0.5) * cell_size_);
  computeDistances(points, options.num_threads);
  interpolation_ = sharpened(1.0 / 12.0, options.num_threads);
}

void GaussianEdt::computeDistances(const PointsRef& points, int num_threads) {
  const int n = num_cells_;
  const std::size_t slice_size = static_cast<std::size_t>(n) * n;
  Points cells = normalizePoints(points, origin_, cell_size_);
  if (static_cast<std::size_t>(cells.cols()) > 8 * slice_size) cells = thin(cells, n);

  // Points in the order of their slice, so that a block of slices meets only its own.
  const float reach = static_cast<float>(kReachInSigmas * sigma_ / cell_size_);
  const auto slice = [&](Eigen::Index i) { return std::clamp(static_cast<int>(std::floor(cells(2, i))), -1, n) + 1; };
  std::vector<Eigen::Index> begin(n + 3, 0), order(cells.cols());
  for (Eigen::Index i = 0; i < cells.cols(); ++i) ++begin[slice(i) + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  auto next = begin;
  for (Eigen::Index i = 0; i < cells.cols(); ++i) order[next[slice(i)]++] = i;

  // Whole vectors: a square run of cells costs less than a round one with loose ends.
  const int width = std::min(n, (static_cast<int>(2.0f * reach) + 1 + 7) / 8 * 8);
  values_.assign(slice_size * n, reach * reach);
  const double scale = -1.0 / std::pow(sigma_ / cell_size_, 2);
  std::vector<double> sums(n, 0.0), sq_sums(n, 0.0);
  parallelBlocks(n, num_threads, [&](std::size_t z) {
    float* const values = values_.data() + z * slice_size;
    const int first = std::clamp(static_cast<int>(std::floor(z - reach)), -1, n) + 1;
    const int last = std::clamp(static_cast<int>(std::floor(z + reach)), -1, n) + 1;
    for (Eigen::Index o = begin[first]; o < begin[last + 1]; ++o) {
      const Eigen::Vector3f point = cells.col(order[o]);
      const float dz = static_cast<float>(z) - point.z();
      lowerSlice(values, n, point.x(), point.y(), dz * dz, reach, width);
    }
    double sum = 0.0, sq_sum = 0.0;
    for (std::size_t i = 0; i < slice_size; ++i) {
      if (values[i] >= reach * reach) {
        values[i] = 0.0f;
        continue;
      }
      const double value = std::exp(scale * values[i]);
      values[i] = static_cast<float>(value);
      sum += value;
      sq_sum += value * value;
    }
    sums[z] = sum;
    sq_sums[z] = sq_sum;
  });
  sum_ = std::accumulate(sums.begin(), sums.end(), 0.0);
  sq_norm_ = std::accumulate(sq_sums.begin(), sq_sums.end(), 0.0);
  if (sq_norm_ == 0.0) throw std::invalid_argument("points: none near the ball given by center and radius");
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
