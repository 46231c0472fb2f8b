#include "pcl_symmetry/core/transform_2d/gaussian_edt_2d.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/check.h"
#include "pcl_symmetry/core/geometry/point_set.h"

namespace pcl_symmetry {

namespace {

constexpr double kSigmaInCells = 2.0;
constexpr double kMarginInSigmas = 2.0;
constexpr double kReachInSigmas = 2.6;  // f < 1.2e-3 beyond

/// Distance between neighbouring points of a curve: twice the median distance to the nearest other point (exact for
/// points scattered on it), over a fixed number of probes.
double curveSpacing(const Points2D& points) {
  constexpr Eigen::Index kNumProbes = 32;
  const Eigen::Index num_probes = std::min(kNumProbes, points.cols());
  std::vector<double> nearest;
  for (Eigen::Index k = 0; k < num_probes; ++k) {
    const Eigen::Vector2f probe = points.col(k * points.cols() / num_probes);
    float sq_nearest = std::numeric_limits<float>::max();
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      const float sq_distance = (points.col(i) - probe).squaredNorm();
      if (sq_distance > 0.0f) sq_nearest = std::min(sq_nearest, sq_distance);
    }
    if (sq_nearest < std::numeric_limits<float>::max()) nearest.push_back(std::sqrt(static_cast<double>(sq_nearest)));
  }
  if (nearest.empty()) return 0.0;
  std::nth_element(nearest.begin(), nearest.begin() + nearest.size() / 2, nearest.end());
  return 2.0 * nearest[nearest.size() / 2];
}

BoundingBall boundingDisk(const Points2D& points) {
  Points embedded = Points::Zero(3, points.cols());
  embedded.topRows<2>() = points;
  return boundingBall(embedded);
}

}  // namespace

void GaussianEdt2DOptions::validate() const {
  check(num_cells >= 8 && num_cells <= 4096, "num_cells", num_cells, "in [8, 4096]");
  check(std::isfinite(sigma) && sigma >= 0.0, "sigma", sigma, "finite and >= 0");
  check(std::isfinite(radius) && radius >= 0.0, "radius", radius, "finite and >= 0");
  check(center.allFinite(), "center", center.transpose(), "finite");
}

GaussianEdt2D::GaussianEdt2D(const Points2D& points, const GaussianEdt2DOptions& options) {
  options.validate();
  if (points.cols() == 0) throw std::invalid_argument("points: 0 given, must be >= 1");
  if (!points.allFinite()) throw std::invalid_argument("points: a coordinate is not finite");
  num_cells_ = options.num_cells;
  center_ = options.center;
  radius_ = options.radius;
  if (radius_ == 0.0) {
    const BoundingBall disk = boundingDisk(points);
    center_ = disk.center.head<2>();
    radius_ = disk.radius;
  }
  if (!(radius_ > std::numeric_limits<float>::epsilon() * center_.norm()))
    throw std::invalid_argument("points: all at one place, must have an extent");

  const int n = num_cells_;
  const double half = 0.5 * n;
  sigma_ = options.sigma;
  if (sigma_ == 0.0) {
    const double cell_size = radius_ / std::max(half - kMarginInSigmas * kSigmaInCells, 0.5 * half);
    sigma_ = std::max(kSigmaInCells * cell_size, std::min(curveSpacing(points), 0.25 * radius_));
  }
  cell_size_ = (radius_ + kMarginInSigmas * sigma_) / half;
  origin_ = center_ - Eigen::Vector2d::Constant((half - 0.5) * cell_size_);

  const float reach = static_cast<float>(kReachInSigmas * sigma_ / cell_size_);
  values_.assign(static_cast<std::size_t>(n) * n, reach * reach);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector2f p = ((points.col(i).cast<double>() - origin_) / cell_size_).cast<float>();
    const auto first = [&](float at) { return std::clamp(static_cast<int>(std::ceil(at - reach)), 0, n); };
    const auto last = [&](float at) { return std::clamp(static_cast<int>(std::floor(at + reach)) + 1, 0, n); };
    for (int y = first(p.y()); y < last(p.y()); ++y) {
      const float dy = static_cast<float>(y) - p.y();
      float* const row = values_.data() + static_cast<std::size_t>(y) * n;
      for (int x = first(p.x()); x < last(p.x()); ++x) {
        const float dx = static_cast<float>(x) - p.x();
        row[x] = std::min(row[x], dx * dx + dy * dy);
      }
    }
  }
  const double scale = -std::pow(cell_size_ / sigma_, 2);
  for (float& value : values_) {
    value = value < reach * reach ? static_cast<float>(std::exp(scale * value)) : 0.0f;
    sq_norm_ += static_cast<double>(value) * value;
  }
}

}  // namespace pcl_symmetry
