#include "core/registration/pose_scoring.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/median.h"
#include "core/base/random.h"
#include "core/neighbours/surface_normals.h"

namespace pcl_symmetry {

namespace {

constexpr float kNormalShare = 0.7f;   // of a point's support that hangs on its normal
constexpr double kPointShare = 0.1;    // of a residual that is not across the surface: keeps poses from sliding away
constexpr double kLeastJudged = 0.05;  // of the model's points: fewer that the scan can judge say little
constexpr double kRoughShare = 0.15;   // of the spacing: rougher surfaces take normals from more neighbours
constexpr int kNumRoughNeighbours = 32;
constexpr double kSilhouetteShare = 0.5;  // of a pull towards the scan on points in free space

std::vector<int> randomOrder(int size, std::uint64_t seed) {
  std::vector<int> order(size);
  std::iota(order.begin(), order.end(), 0);
  RandomStream random(seed);
  for (int i = size - 1; i > 0; --i) std::swap(order[i], order[random.below(static_cast<std::uint64_t>(i) + 1)]);
  return order;
}

/// The first points of a surface in another frame, each with the closest point of another surface.
struct Matches {
  Points places, normals;
  std::vector<int> closest;
};

Matches match(const PosedSurface& from, const PosedSurface& to, const Eigen::Isometry3d& T_to_from,
              const PoseScorer::Detail& detail) {
  const auto size = std::min<Eigen::Index>(detail.num_points, from.points.cols());
  const Eigen::Matrix3f rotation = T_to_from.linear().cast<float>();
  const Eigen::Vector3f translation = T_to_from.translation().cast<float>();
  Matches matches{Points(3, size), Points(3, size), std::vector<int>(size)};
  for (Eigen::Index i = 0; i < size; ++i) {
    matches.places.col(i) = rotation * from.points.col(from.order[i]) + translation;
    matches.normals.col(i) = rotation * from.normals.col(from.order[i]);
  }
  if (detail.exact) {
    std::vector<float> sq_distances;
    to.search->search(matches.places, 1, matches.closest, sq_distances);
  } else {
    for (Eigen::Index i = 0; i < size; ++i) matches.closest[i] = to.grid.closest(matches.places.col(i));
  }
  return matches;
}

/// Sums of a least-squares problem in a small motion (rotation vector, translation).
struct NormalEquations {
  Eigen::Matrix<double, 6, 6> hessian = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();

  /// w (n . (x + rotation x x + translation) - n . y)^2.
  void add(const Eigen::Vector3d& x, const Eigen::Vector3d& y, const Eigen::Vector3d& n, double weight) {
    Eigen::Matrix<double, 6, 1> row;
    row << x.cross(n), n;
    hessian.selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
    gradient += weight * n.dot(y - x) * row;
  }

  void addPoint(const Eigen::Vector3d& x, const Eigen::Vector3d& y, double weight) {
    for (int k = 0; k < 3; ++k) add(x, y, Eigen::Vector3d::Unit(k), weight);
  }
};

}  // namespace

PosedSurface::PosedSurface(const PointsRef& input, std::optional<Visibility> seen_space, std::uint64_t seed,
                           int num_threads)
    : points(input),
      order(randomOrder(static_cast<int>(input.cols()), seed)),
      seen(std::move(seen_space)),
      grid(input),
      search(makeFlannSearch(input)) {
  LocalGeometry geometry = localGeometry(points, *search, kNumSupportNeighbours, num_threads);
  const double spacing = median(geometry.spacing);
  if (median(geometry.roughness) > kRoughShare * spacing)
    geometry = localGeometry(points, *search, kNumRoughNeighbours, num_threads);
  normals = std::move(geometry.normals);
  accuracy = spacing + 2.0 * median(std::move(geometry.roughness));
}

PoseScore PoseScorer::score(const Eigen::Isometry3d& T_model_scan, const Detail& detail) const {
  const float factor = static_cast<float>(-1.0 / (detail.width * detail.width));
  PoseScore score;
  const Matches on_model = match(scan_, model_, T_model_scan, detail);
  double unexplained = 0.0;
  for (Eigen::Index i = 0; i < on_model.places.cols(); ++i) {
    const int j = on_model.closest[i];
    const float near = std::exp(factor * (model_.points.col(j) - on_model.places.col(i)).squaredNorm());
    const float cosine = on_model.normals.col(i).dot(model_.normals.col(j));
    const float support = near * (1.0f - kNormalShare + kNormalShare * cosine * cosine);
    score.support += support;
    if (model_.seen && model_.seen->depthBehind(on_model.places.col(i).cast<double>()) < 0.0) unexplained += 1.0 - near;
  }
  score.support /= static_cast<double>(on_model.places.cols());
  score.conflict = unexplained / static_cast<double>(on_model.places.cols());
  if (!scan_.seen) return score;
  const Matches on_scan = match(model_, scan_, T_model_scan.inverse(), detail);
  double conflict = 0.0, judged = kLeastJudged * static_cast<double>(on_scan.places.cols());
  for (Eigen::Index i = 0; i < on_scan.places.cols(); ++i) {
    const float near = std::exp(factor * (scan_.points.col(on_scan.closest[i]) - on_scan.places.col(i)).squaredNorm());
    const bool in_front = scan_.seen->depthBehind(on_scan.places.col(i).cast<double>()) < 0.0;
    conflict += in_front ? 1.0f - near : 0.0f;
    judged += in_front ? 1.0f : near;
  }
  score.conflict += conflict / judged;
  return score;
}

Eigen::Isometry3d PoseScorer::step(const Eigen::Isometry3d& T_model_scan, const Detail& detail) const {
  const float factor = static_cast<float>(-1.0 / (detail.width * detail.width));
  NormalEquations equations;
  const Matches on_model = match(scan_, model_, T_model_scan, detail);
  for (Eigen::Index i = 0; i < on_model.places.cols(); ++i) {
    const int j = on_model.closest[i];
    const float cosine = on_model.normals.col(i).dot(model_.normals.col(j));
    const double weight = std::exp(factor * (model_.points.col(j) - on_model.places.col(i)).squaredNorm()) *
                          (1.0f - kNormalShare + kNormalShare * cosine * cosine);
    const Eigen::Vector3d x = on_model.places.col(i).cast<double>(), y = model_.points.col(j).cast<double>();
    equations.add(x, y, model_.normals.col(j).cast<double>(), (1.0 - kPointShare) * weight);
    equations.addPoint(x, y, kPointShare * weight);
  }
  if (scan_.seen) {
    const Matches on_scan = match(model_, scan_, T_model_scan.inverse(), detail);
    const double share = kSilhouetteShare * static_cast<double>(on_model.places.cols()) / on_scan.places.cols();
    for (Eigen::Index i = 0; i < on_scan.places.cols(); ++i) {
      if (!(scan_.seen->depthBehind(on_scan.places.col(i).cast<double>()) < 0.0)) continue;
      const Eigen::Vector3f target = scan_.points.col(on_scan.closest[i]);
      const double weight = std::exp(factor * (target - on_scan.places.col(i)).squaredNorm());
      const Eigen::Vector3d moving = T_model_scan * target.cast<double>();
      equations.addPoint(moving, model_.points.col(model_.order[i]).cast<double>(), share * weight);
    }
  }
  // A little inertia keeps what nothing fixes where it is.
  equations.hessian.diagonal().array() += 1e-6 + 1e-4 * equations.hessian.diagonal().maxCoeff();
  const Eigen::Matrix<double, 6, 1> motion =
      equations.hessian.selfadjointView<Eigen::Lower>().ldlt().solve(equations.gradient);
  if (!motion.allFinite()) return T_model_scan;
  const double angle = motion.head<3>().norm();
  Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
  if (angle > 0.0) moved.linear() = Eigen::AngleAxisd(angle, motion.head<3>() / angle).toRotationMatrix();
  moved.translation() = motion.tail<3>();
  return moved * T_model_scan;
}

}  // namespace pcl_symmetry
