#include "pcl_symmetry/core/revolution_profile.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "core/base/check.h"
#include "core/base/lists.h"
#include "core/base/statistics.h"
#include "core/base/symmetric_solvers.h"
#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

namespace {

// Lengths are shares of the extent of the points in (radius, height), unless stated otherwise.
struct ProfileRules {
  double first_width = 0.04;  // first width of the fit: noise of 1 % leaves the direction of the curve clear
  double min_width = 0.012, max_width = 0.05;
  double widths = 3.0;  // width of the fit afterwards, spreads
  int moves = 4;        // number of moves of each point onto the curve
  // Least distance between points of the curve, in steps between two of them; closer points are one.
  double apart = 0.5;
  double next = 4.0;  // greatest distance to the next point of a piece, in steps
  // Least density, points divided by radius, as a share of the median: fits beside the curve have less.
  double min_density = 0.1;
  int min_points = 6;  // least number of points of a parabola
};
constexpr ProfileRules kProfile;

/// The point near a position where the parabola through the points nearby passes.
struct FittedPosition {
  Eigen::Vector2d position;  // radius, height
  double spread;
  int count;
};

FittedPosition fittedPosition(const std::vector<Eigen::Vector2d>& points, Eigen::Vector2d position, double width) {
  FittedPosition result{position, 0.0, 0};
  for (int move = 0; move < kProfile.moves; ++move) {
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    double sum = 0.0;
    std::vector<std::pair<Eigen::Vector2d, double>> nearby;
    for (const Eigen::Vector2d& x : points) {
      const double share = (x - result.position).norm() / width, weight = (1.0 - share * share) * (1.0 - share * share);
      if (share >= 1.0) continue;
      nearby.emplace_back(x, weight);
      mean += weight * x;
      sum += weight;
    }
    if (static_cast<int>(nearby.size()) < kProfile.min_points || !(sum > 0.0)) return {position, 0.0, 0};
    mean /= sum;
    for (const auto& [x, weight] : nearby) spread += weight * (x - mean) * (x - mean).transpose();
    const SymmetricEigen<Eigen::Matrix2d> axes(spread);
    const Eigen::Vector2d along = axes.eigenvectors().col(1), across = axes.eigenvectors().col(0);
    Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    for (const auto& [x, weight] : nearby) {
      const double t = along.dot(x - result.position) / width;
      const Eigen::Vector3d powers(1.0, t, t * t);
      h += weight * powers * powers.transpose();
      g += weight * across.dot(x - result.position) * powers;
    }
    const Eigen::Vector3d parabola = solveSymmetric(h, g);
    if (!parabola.allFinite()) return {position, 0.0, 0};
    // The window is as wide across the curve as along it, so that the weights cut nothing off.
    double sq_sum = 0.0;
    result.count = 0;
    for (const Eigen::Vector2d& x : points) {
      const double t = along.dot(x - result.position) / width;
      const double off = across.dot(x - result.position) - parabola.dot(Eigen::Vector3d(1.0, t, t * t));
      if (std::abs(t) > 0.5 || std::abs(off) > width) continue;
      sq_sum += off * off;
      ++result.count;
    }
    result.spread = std::sqrt(sq_sum / std::max(1, result.count));
    result.position += parabola[0] * across;
  }
  return result;
}

/// One start a cell; the cells that the curve passes tell how long it is.
std::vector<Eigen::Vector2d> startsFor(const std::vector<Eigen::Vector2d>& positions, double cell) {
  std::map<std::pair<std::int64_t, std::int64_t>, std::pair<Eigen::Vector2d, int>> cells;
  for (const Eigen::Vector2d& position : positions) {
    auto& [sum, count] = cells[{static_cast<std::int64_t>(std::floor(position.x() / cell)),
                                static_cast<std::int64_t>(std::floor(position.y() / cell))}];
    if (count++ == 0) sum.setZero();
    sum += position;
  }
  std::vector<Eigen::Vector2d> starts;
  for (const auto& [key, entry] : cells) starts.emplace_back(entry.first / entry.second);
  return starts;
}

/// The width of the weights, by how far the points spread about the curve.
double chooseWidth(const std::vector<Eigen::Vector2d>& around, const std::vector<Eigen::Vector2d>& positions,
                   double extent) {
  const double width = kProfile.first_width * extent;
  std::vector<double> spreads;
  for (const Eigen::Vector2d& start : startsFor(positions, width))
    if (const FittedPosition fit = fittedPosition(around, start, width); fit.count > 0) spreads.push_back(fit.spread);
  if (spreads.empty()) return width;
  return std::min(kProfile.max_width * extent,
                  std::max(kProfile.min_width * extent, kProfile.widths * median(std::move(spreads))));
}

/// \param step between the starts.
std::vector<FittedPosition> fitCurve(const std::vector<Eigen::Vector2d>& around,
                                     const std::vector<Eigen::Vector2d>& positions, double step, double width) {
  std::vector<FittedPosition> curve;
  for (const Eigen::Vector2d& start : startsFor(positions, step)) {
    const FittedPosition fit = fittedPosition(around, start, width);
    // The parabola continues beyond the ends of the curve, and starts at outliers find parabolas of their own.
    if (fit.count == 0 || fit.position.x() < 0.0 || (fit.position - start).norm() > width) continue;
    const bool is_known = std::any_of(curve.begin(), curve.end(), [&](const FittedPosition& other) {
      return (other.position - fit.position).norm() < kProfile.apart * step;
    });
    if (!is_known) curve.push_back(fit);
  }
  if (curve.empty()) return curve;
  const auto density = [&](const FittedPosition& fit) { return fit.count / std::max(fit.position.x(), width); };
  std::vector<double> densities;
  for (const FittedPosition& fit : curve) densities.push_back(density(fit));
  const double min_density = kProfile.min_density * median(std::move(densities));
  eraseIf(curve, [&](const FittedPosition& fit) { return density(fit) < min_density; });
  return curve;
}

/// Lists the curve piece by piece, each from its lower end.
/// \param bottom of the points, on the axis.
/// \param step as in fitCurve().
std::vector<ProfilePoint> orderAlongCurve(const std::vector<FittedPosition>& curve, const Eigen::Vector2d& bottom,
                                          double step) {
  std::vector<ProfilePoint> profile;
  std::vector<char> is_listed(curve.size(), 0);
  const auto closestTo = [&](const Eigen::Vector2d& x) {
    std::size_t best = curve.size();
    for (std::size_t i = 0; i < curve.size(); ++i)
      if (!is_listed[i] && (best == curve.size() || (curve[i].position - x).norm() < (curve[best].position - x).norm()))
        best = i;
    return best;
  };
  const auto walk = [&](std::size_t start) {
    std::vector<std::size_t> order;
    for (std::size_t at = start; at < curve.size();) {
      order.push_back(at);
      is_listed[at] = 1;
      const std::size_t next = closestTo(curve[at].position);
      at = next < curve.size() && (curve[next].position - curve[at].position).norm() < kProfile.next * step
               ? next
               : curve.size();
    }
    return order;
  };
  while (profile.size() < curve.size()) {
    const std::size_t any = closestTo(bottom);
    const std::vector<char> before = is_listed;
    const std::size_t end = walk(any).back();
    is_listed = before;
    std::vector<std::size_t> order = walk(end);  // from one end of the piece to the other
    if (curve[order.front()].position.y() > curve[order.back()].position.y()) std::reverse(order.begin(), order.end());
    for (const std::size_t i : order)
      profile.push_back({curve[i].position.x(), curve[i].position.y(), curve[i].spread, curve[i].count});
  }
  return profile;
}

}  // namespace

std::vector<ProfilePoint> revolutionProfile(const PointsRef& points, const SymmetryAxis& axis, int num_points) {
  check(num_points >= 2, "num_points", num_points, ">= 2");
  const Eigen::Vector3d direction = axis.direction.normalized();
  std::vector<Eigen::Vector2d> positions;
  Eigen::AlignedBox2d box;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (!points.col(i).allFinite()) continue;
    const Eigen::Vector3d x = points.col(i).cast<double>() - axis.point;
    const double height = direction.dot(x);
    positions.emplace_back((x - height * direction).norm(), height);
    box.extend(positions.back());
  }
  check(positions.size() >= kMinDistinctPoints, "number of points", positions.size(), ">= 20");
  const double extent = box.diagonal().norm();
  check(extent > 0.0, "extent of the points", extent, "> 0");

  // Points near the axis again with a negative radius: the curve continues beyond it.
  std::vector<Eigen::Vector2d> around = positions;
  for (const Eigen::Vector2d& position : positions)
    if (position.x() < kProfile.max_width * extent) around.emplace_back(-position.x(), position.y());
  const double step = 2.0 * extent / num_points;  // a vase is about twice as long as it is high
  const std::vector<FittedPosition> curve = fitCurve(around, positions, step, chooseWidth(around, positions, extent));
  return orderAlongCurve(curve, {0.0, box.min().y()}, step);
}

}  // namespace pcl_symmetry
