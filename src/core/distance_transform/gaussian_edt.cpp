#include "pcl_symmetry/core/distance_transform/gaussian_edt.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/base/simd.h"
#include "core/distance_transform/gaussian_width.h"

namespace pcl_symmetry {

namespace {

// points; chosen: larger clouds are dense enough for usual grids, and probing them takes long
constexpr Eigen::Index kNumDense = 200'000;
// points for each cell of a slice; chosen: fewer than that cost less than thinning
constexpr std::size_t kDensePerCell = 8;
// slots along a cell; chosen: thinning adds up to sqrt(3) / 4 cells to a distance; half adds twice as much, twice keeps
// eight times as many points
constexpr int kSlotsPerCell = 4;
constexpr double kOfInterpolation = 1.0 / 12.0;  // derived: a value between cells is a mean over a box of one cell
constexpr int kVectorWidth = 8;                  // derived: floats in an AVX2 register

/// A float clamped to [low, high], as an integer; rounded towards zero.
int clampedInt(float value, int low, int high) {
  return static_cast<int>(std::clamp(value, static_cast<float>(low), static_cast<float>(high)));
}

/// Lowers the squared distances of a slice's cells to those from one point, over a square that covers its reach. All
/// lengths are in cells.
PCL_SYMMETRY_MULTIVERSION
void lowerSlice(float* sq_distances, int num_cells, const Eigen::Vector3f& point, float z, float reach, int width) {
  const float x = point.x(), y = point.y(), dz = z - point.z(), sq_dz = dz * dz;
  const float sq_radius = reach * reach - sq_dz;
  if (sq_radius <= 0.0f) return;
  const float radius = std::sqrt(sq_radius);
  const int y_begin = clampedInt(std::ceil(y - radius), 0, num_cells);
  const int y_end = clampedInt(std::floor(y + radius) + 1.0f, 0, num_cells);
  const int x_begin = clampedInt(std::ceil(x - reach), 0, num_cells - width);
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

/// One row of GaussianEdt::sharpened(), without its ends.
PCL_SYMMETRY_MULTIVERSION
void sharpenRow(const float* f, std::ptrdiff_t num_cells, std::ptrdiff_t slice_size, float weight, float* sharpened) {
  for (std::ptrdiff_t x = 1; x + 1 < num_cells; ++x) {
    const float laplacian =
        f[x - 1] + f[x + 1] + f[x - num_cells] + f[x + num_cells] + f[x - slice_size] + f[x + slice_size] - 6.0f * f[x];
    sharpened[x] = std::max(0.0f, f[x] - weight * laplacian);
  }
}

/// Keeps the first point in each slot of 1/64 cell.
/// \param points in cells.
Points thin(const Points& points, int num_cells) {
  const int side = kSlotsPerCell * num_cells;
  std::vector<bool> taken(static_cast<std::size_t>(side) * side * side);
  Points kept(3, points.cols());
  Eigen::Index num_kept = 0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const auto at = [&](int axis) {
      return static_cast<std::size_t>(clampedInt(kSlotsPerCell * (points(axis, i) + 0.5f), 0, side - 1));
    };
    const std::size_t slot = (at(2) * side + at(1)) * side + at(0);
    if (taken[slot]) continue;
    taken[slot] = true;
    kept.col(num_kept++) = points.col(i);
  }
  kept.conservativeResize(3, num_kept);
  return kept;
}

/// Points sorted by the slice of cells that contains them, so that a slice is compared with the points near it only.
class PointsBySlice {
public:
  /// \param points in cells.
  PointsBySlice(const Points& points, int num_cells)
      : points_(points), num_cells_(num_cells), begin_(num_cells + 3, 0), order_(points.cols()) {
    for (Eigen::Index i = 0; i < points.cols(); ++i) ++begin_[slot(points(2, i)) + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    auto next = begin_;
    for (Eigen::Index i = 0; i < points.cols(); ++i) order_[next[slot(points(2, i))]++] = i;
  }

  /// Calls visit(point) for all points in the slices that contain z_low to z_high, and perhaps others.
  template <typename Visit>
  void visit(float z_low, float z_high, const Visit& visit) const {
    for (Eigen::Index o = begin_[slot(z_low)]; o < begin_[slot(z_high) + 1]; ++o) visit(points_.col(order_[o]));
  }

private:
  /// 0 and num_cells + 1 hold the points below and above the grid.
  int slot(float z) const { return clampedInt(std::floor(z), -1, num_cells_) + 1; }

  const Points& points_;
  int num_cells_;
  std::vector<Eigen::Index> begin_;  // first index of each slot in order_
  std::vector<Eigen::Index> order_;
};

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
  chooseWidth(points, options.sigma);
  origin_ = center_ - Eigen::Vector3d::Constant((0.5 * num_cells_ - 0.5) * cell_size_);
  computeValues(points, options.num_threads);
  interpolation_ = sharpened(kOfInterpolation, options.num_threads);
}

void GaussianEdt::chooseWidth(const PointsRef& points, double sigma) {
  const double half = 0.5 * num_cells_;
  const auto take = [&](double width) {
    sigma_ = width;
    cell_size_ = (radius_ + kMarginInSigmas * sigma_) / half;
  };
  if (sigma > 0.0) return take(sigma);
  cell_size_ = radius_ / std::max(half - kMarginInSigmas * kSigmaInCells, 0.5 * half);
  sigma_ = kSigmaInCells * cell_size_;
  const double spacing = points.cols() > kNumDense ? 0.0 : std::min(sampleSpacing(points), kMostSpacing * radius_);
  if (spacing > sigma_) take(spacing);
}

void GaussianEdt::computeValues(const PointsRef& points, int num_threads) {
  const int n = num_cells_;
  const std::size_t slice_size = static_cast<std::size_t>(n) * n;
  Points cells = normalizePoints(points, origin_, cell_size_);
  if (static_cast<std::size_t>(cells.cols()) > kDensePerCell * slice_size) cells = thin(cells, n);
  const PointsBySlice sorted(cells, n);
  const float reach = static_cast<float>(kReachInSigmas * sigma_ / cell_size_), sq_reach = reach * reach;
  // Whole vectors: a square of cells takes less time than a disk with loose ends.
  const int diameter = static_cast<int>(2.0f * reach) + 1;
  const int width = std::min(n, (diameter + kVectorWidth - 1) / kVectorWidth * kVectorWidth);
  // Section 4.1: f = exp(-dist^2 / sigma^2).
  const double scale = -1.0 / std::pow(sigma_ / cell_size_, 2);
  values_.assign(slice_size * n, sq_reach);
  std::vector<double> sums(n, 0.0), sq_sums(n, 0.0);
  parallelBlocks(n, num_threads, [&](std::size_t slice) {
    float* const values = values_.data() + slice * slice_size;
    const float z = static_cast<float>(slice);
    sorted.visit(z - reach, z + reach,
                 [&](const Eigen::Vector3f& point) { lowerSlice(values, n, point, z, reach, width); });
    double sum = 0.0, sq_sum = 0.0;
    for (std::size_t i = 0; i < slice_size; ++i) {
      if (values[i] >= sq_reach) {
        values[i] = 0.0f;
        continue;
      }
      const double value = std::exp(scale * values[i]);
      values[i] = static_cast<float>(value);
      sum += value;
      sq_sum += value * value;
    }
    sums[slice] = sum;
    sq_sums[slice] = sq_sum;
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
  if (c == kOfInterpolation && !interpolation_.empty()) return interpolation_;
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
