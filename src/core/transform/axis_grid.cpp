#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "pcl_symmetry/core/axial_transform.h"

namespace pcl_symmetry {

AxisGrid::AxisGrid(int num_theta, int num_phi, int num_offset, const Eigen::Vector3d& center, double radius)
    : num_theta_(num_theta), num_phi_(num_phi), num_offset_(num_offset), center_(center), radius_(radius) {
  constexpr int most = 1024;                     // 0.1 degrees
  constexpr std::size_t most_bins = 1ull << 28;  // 1 GiB for each fold
  check(num_theta >= 1 && num_theta <= most, "num_theta", num_theta, "in [1, 1024]");
  check(num_phi >= 2 && num_phi <= most && num_phi % 2 == 0, "num_phi", num_phi, "even and in [2, 1024]");
  check(num_offset >= 1 && num_offset <= most, "num_offset", num_offset, "in [1, 1024]");
  check(size() <= most_bins, "number of bins", size(), "at most 268435456");
  check(center.allFinite(), "center", center.transpose(), "finite");
  check(std::isfinite(radius) && radius > 0.0, "radius", radius, "finite and > 0");
}

std::size_t AxisGrid::index(const Bin& bin) const {
  const std::size_t direction = static_cast<std::size_t>(bin.theta) * num_phi_ + bin.phi;
  return (direction * num_offset_ + bin.v) * num_offset_ + bin.u;
}

AxisGrid::Bin AxisGrid::bin(std::size_t index) const {
  const std::size_t row = index / num_offset_, direction = row / num_offset_;
  return {static_cast<int>(direction / num_phi_), static_cast<int>(direction % num_phi_),
          static_cast<int>(index % num_offset_), static_cast<int>(row % num_offset_)};
}

Eigen::Matrix3d AxisGrid::frame(std::size_t direction) const {
  const double theta = (direction / num_phi_ + 0.5) * 0.5 * kPi / num_theta_;
  const double phi = (direction % num_phi_ + 0.5) * 2.0 * kPi / num_phi_;
  Eigen::Matrix3d frame;
  frame.col(0) << std::cos(theta) * std::cos(phi), std::cos(theta) * std::sin(phi), -std::sin(theta);
  frame.col(1) << -std::sin(phi), std::cos(phi), 0.0;
  frame.col(2) << std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta);
  return frame;
}

Line3d AxisGrid::axis(const Bin& bin) const {
  const Eigen::Matrix3d axes = frame(static_cast<std::size_t>(bin.theta) * num_phi_ + bin.phi);
  return {center_ + offset(bin.u) * axes.col(0) + offset(bin.v) * axes.col(1), axes.col(2)};
}

std::optional<AxisGrid::Bin> AxisGrid::find(const Line3d& axis) const {
  Eigen::Vector3d n = axis.direction().normalized();
  if (n.z() < 0.0) n = -n;
  const double phi = std::atan2(n.y(), n.x());
  const int t =
      std::clamp(static_cast<int>(std::acos(std::min(1.0, n.z())) / (0.5 * kPi) * num_theta_), 0, num_theta_ - 1);
  const int p =
      std::clamp(static_cast<int>((phi < 0.0 ? phi + 2.0 * kPi : phi) / (2.0 * kPi) * num_phi_), 0, num_phi_ - 1);
  const Eigen::Matrix3d axes = frame(static_cast<std::size_t>(t) * num_phi_ + p);
  Eigen::Vector3d foot = axis.origin() - center_;
  foot -= n.dot(foot) * n;
  const double u = axes.col(0).dot(foot), v = axes.col(1).dot(foot);
  if (std::max(std::abs(u), std::abs(v)) > radius_) return std::nullopt;
  const auto bin_of = [&](double x) {
    return std::clamp(static_cast<int>((x + radius_) / offsetStep()), 0, num_offset_ - 1);
  };
  return Bin{t, p, bin_of(u), bin_of(v)};
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
