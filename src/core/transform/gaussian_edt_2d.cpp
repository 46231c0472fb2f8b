#include "pcl_symmetry/core/gaussian_edt_2d.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/geometry/principal_axes.h"
#include "core/transform/gaussian_width.h"

namespace pcl_symmetry {

void GaussianEdt2DOptions::validate() const {
  check(num_cells >= 8 && num_cells <= 4096, "num_cells", num_cells, "in [8, 4096]");
  check(std::isfinite(sigma) && sigma >= 0.0, "sigma", sigma, "finite and >= 0");
  check(std::isfinite(radius) && radius >= 0.0, "radius", radius, "finite and >= 0");
  check(center.allFinite(), "center", center.transpose(), "finite");
}

GaussianEdt2D::GaussianEdt2D(const Points2D& points, const GaussianEdt2DOptions& options) {
  options.validate();
  num_cells_ = options.num_cells;
  Points embedded = Points::Zero(3, points.cols());
  embedded.topRows<2>() = points;
  const BoundingBall disk = coveredBall(embedded, {{options.center.x(), options.center.y(), 0.0}, options.radius});
  center_ = disk.center.head<2>();
  radius_ = disk.radius;

  const double half = 0.5 * num_cells_;
  sigma_ = options.sigma;
  if (sigma_ == 0.0) {
    const double cell_size = radius_ / std::max(half - kMarginInSigmas * kSigmaInCells, 0.5 * half);
    sigma_ = std::max(kSigmaInCells * cell_size, std::min(sampleSpacing(points), kMostSpacing * radius_));
  }
  cell_size_ = (radius_ + kMarginInSigmas * sigma_) / half;
  origin_ = center_ - Eigen::Vector2d::Constant((half - 0.5) * cell_size_);
  computeValues(points);
}

void GaussianEdt2D::computeValues(const Points2D& points) {
  const int n = num_cells_;
  const float reach = static_cast<float>(kReachInSigmas * sigma_ / cell_size_), end = static_cast<float>(n);
  values_.assign(static_cast<std::size_t>(n) * n, reach * reach);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector2f p = ((points.col(i).cast<double>() - origin_) / cell_size_).cast<float>();
    const auto first = [&](float at) { return static_cast<int>(std::clamp(std::ceil(at - reach), 0.0f, end)); };
    const auto last = [&](float at) { return static_cast<int>(std::clamp(std::floor(at + reach) + 1.0f, 0.0f, end)); };
    for (int y = first(p.y()); y < last(p.y()); ++y) {
      const float dy = static_cast<float>(y) - p.y();
      float* const row = values_.data() + static_cast<std::size_t>(y) * n;
      for (int x = first(p.x()); x < last(p.x()); ++x) {
        const float dx = static_cast<float>(x) - p.x();
        row[x] = std::min(row[x], dx * dx + dy * dy);
      }
    }
  }
  // Section 4.1: f = exp(-dist^2 / sigma^2).
  const double scale = -std::pow(cell_size_ / sigma_, 2);
  for (float& value : values_) {
    value = value < reach * reach ? static_cast<float>(std::exp(scale * value)) : 0.0f;
    sq_norm_ += static_cast<double>(value) * value;
  }
}

Sheet flattened(const PointsRef& points) {
  Sheet sheet;
  sheet.T_input_sheet = sheetPose(points);
  sheet.points = (sheet.T_input_sheet.inverse() * points.cast<double>()).topRows<2>().cast<float>();
  return sheet;
}

}  // namespace pcl_symmetry
