#include "core/rotation/rotation_fit.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "core/base/symmetric_solvers.h"
#include "core/evidence/surface_samples.h"
#include "core/geometry/point_samples.h"
#include "core/refinement/refinement_rules.h"

namespace pcl_symmetry {

double RotationLimits::excess(const OffShares& shares) const {
  const double far = std::max(kRotation.min_far, kRotation.far_of_feature * max_feature);
  const double by_off = max_feature > 0.0 ? shares.off / max_feature : (shares.off > 0.0 ? 2.0 : 0.0);
  return std::max(by_off, shares.far / far);
}

double RotationLimits::confidence(const OffShares& shares, std::size_t num_points) const {
  const double unit = kRotation.share_unit + kRotation.share_errors * std::sqrt(max_feature * (1.0 - max_feature) /
                                                                                static_cast<double>(num_points));
  const double margin = max_feature > 0.0 ? max_feature * (1.0 - kRotation.optimism * excess(shares)) : -shares.off;
  return logistic(margin / unit);
}

RotationFit::RotationFit(Points points, const GaussianEdt& edt, RotationLimits limits, double reach, std::uint64_t seed,
                         int num_threads, bool single)
    : edt_(edt), limits_(limits), own_share_(1.0), first_sigma_(0.0), last_sigma_(0.0), num_threads_(num_threads) {
  const auto surface = std::make_shared<Surface>();
  surface->points = std::move(points);
  const Points& p = surface->points;
  surface->search = makeFlannSearch(p);
  surface->geometry = localGeometry(p, *surface->search, num_threads);
  surface->single = single;
  const LocalGeometry& geometry = surface->geometry;
  surface->spacing = median(geometry.spacing);
  surface->roughness = median(geometry.roughness);
  constexpr double rounding = 1e-6;  // radii, of float coordinates
  first_sigma_ =
      std::max({rounding, kRotation.first_tolerances * limits.tolerance, kRotation.first_spacings * surface->spacing});
  last_sigma_ = std::max(
      {rounding, kRotation.last_tolerances * limits.tolerance, kRotation.last_roughnesses * surface->roughness});
  last_sigma_ = std::min(last_sigma_, first_sigma_);
  const double farthest = std::max(reach, first_sigma_);
  surface->discs =
      std::make_unique<SurfaceDiscs>(p, geometry, single ? 0.0f : kEvidence.disc_radius, static_cast<float>(farthest));
  surface->grid = std::make_unique<ClosestPointGrid>(p, 32);
  surface->leave_one_out_distances.resize(p.cols());
  parallelPoints(surface->leave_one_out_distances.size(), num_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      surface->leave_one_out_distances[i] =
          surface->discs->ownDistance(static_cast<int>(i), kEvidence.new_point_factor);
  });
  surface->order = shuffled(p.cols(), seed);
  surface->overlap_points = pointsAt(p, drawSamples(p.cols(), kRotation.num_overlap_points, seed + 2));
  // Under a symmetry, the closest sample of a rotated sample is as far away as the closest other sample of a sample.
  double sum = 0.0;
  std::vector<double> closest;
  for (Eigen::Index i = 0; i < p.cols(); ++i) {
    const double sq_distance = (p.col(i) - p.col(geometry.nearest[i][0])).squaredNorm();
    sum += std::exp(-sq_distance / (edt.sigma() * edt.sigma()));
    closest.push_back(std::sqrt(sq_distance));
  }
  surface->closest_distance = median(std::move(closest));
  surface->own_overlap = std::max(sum / static_cast<double>(p.cols()), 1e-3);
  surface_ = surface;
  own_share_ = ownShare();
}

RotationFit RotationFit::withLimits(RotationLimits limits) const {
  RotationFit other = *this;
  other.limits_ = limits;
  other.own_share_ = other.ownShare();
  return other;
}

double RotationFit::thickness(int num_neighbors) const {
  const Points& points = surface_->points;
  const int count = static_cast<int>(std::min<Eigen::Index>(num_neighbors, points.cols() / 4));
  if (count < 4) return 0.0;
  const Points some = pointsAt(points, drawSamples(points.cols(), kRotation.num_some_points, 1));
  std::vector<int> indices;
  std::vector<float> sq_distances;
  surface_->search->search(some, count, indices, sq_distances);
  std::vector<double> thickness;
  for (Eigen::Index i = 0; i < some.cols(); ++i) {
    const auto first = indices.begin() + i * count;
    Eigen::Matrix3Xd near = pointsAt(points, {first, first + count}).cast<double>();
    near.colwise() -= near.rowwise().mean().eval();
    const SymmetricEigen<Eigen::Matrix3d> solver(near * near.transpose());
    thickness.push_back(std::sqrt(std::max(0.0, solver.eigenvalues()[0]) / std::max(1e-30, solver.eigenvalues()[2])));
  }
  return median(std::move(thickness));
}

bool RotationFit::fillsBody() const {
  return thickness(kRotation.body_neighbors) > kRotation.body_thickness &&
         thickness(kRotation.close_neighbors) > kRotation.close_thickness;
}

Points RotationFit::borderPoints() const {
  const Points& points = surface_->points;
  const int count = std::min(kRotation.border_neighbors, static_cast<int>(points.cols()));
  std::vector<int> indices, border;
  std::vector<float> sq_distances;
  surface_->search->search(points, count, indices, sq_distances);
  for (int i = 0; i < static_cast<int>(points.cols()); ++i) {
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    for (int k = 0; k < count; ++k) mean += points.col(indices[i * count + k]) / static_cast<float>(count);
    const double farthest = std::sqrt(sq_distances[(i + 1) * count - 1]);
    if ((mean - points.col(i)).norm() > kRotation.border_offset * farthest) border.push_back(i);
  }
  return pointsAt(points, border);
}

double RotationFit::resolution() const {
  return quantile(surface_->leave_one_out_distances, kRotation.min_own_share);
}

double RotationFit::ownShare() const {
  return surface_->single ? 1.0 : std::max(1e-3, shareWithin(surface_->leave_one_out_distances, limits_.tolerance));
}

double RotationFit::overlap(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& center, int num_points) const {
  const Points& points = surface_->overlap_points;
  const Eigen::Index size = std::min<Eigen::Index>(points.cols(), num_points);
  const Eigen::Matrix3d to_cell = rotation / edt_.cellSize();
  const Eigen::Vector3d shift = (center - rotation * center - edt_.origin()) / edt_.cellSize();
  double sum = 0.0;
  for (Eigen::Index i = 0; i < size; ++i) sum += edt_.atCell(to_cell * points.col(i).cast<double>() + shift);
  return sum / (surface_->own_overlap * static_cast<double>(size));
}

double RotationFit::overlap(const RotationSet& set) const {
  double least = 1.0;
  for (const Eigen::Matrix3d& rotation : set.rotations) least = std::min(least, overlap(rotation, set.center));
  return least;
}

RotationSet RotationFit::fitRoughly(const RotationSet& set) const {
  const double sigma = edt_.sigma();
  return fitRotations(set, equalSteps(static_cast<Eigen::Index>(set.num_judged), kRotation.max_fitted),
                      kRotation.num_rough_points,
                      {sigma, std::max(std::min(sigma, first_sigma_), 0.5 * sigma), kRotation.rough_iterations, true});
}

RotationSet RotationFit::fitClosely(const RotationSet& set) const {
  return fitRotations(set, equalSteps(static_cast<Eigen::Index>(set.rotations.size()), kRotation.max_fitted),
                      kRotation.num_close_points, {first_sigma_, last_sigma_, kRotation.close_iterations, false});
}

/// The sample that the grid gives for the cell of a point, or a neighbor of that sample that is closer.
int RotationFit::closestSample(const Eigen::Vector3f& x) const {
  const Points& points = surface_->points;
  int closest = surface_->grid->closest(x);
  float least = (points.col(closest) - x).squaredNorm();
  for (int hop = 0; hop < 4; ++hop) {
    const int from = closest;
    for (const int j : surface_->geometry.nearest[from]) {
      const float sq_distance = (points.col(j) - x).squaredNorm();
      if (sq_distance >= least) continue;
      least = sq_distance;
      closest = j;
    }
    if (closest == from) break;
  }
  return closest;
}

/// x' = R (x - c) + c moves with R' = exp(omega) R exp(-omega) and c' = c + t
/// by ((1 - R) omega) x (x' - c) + (1 - R) t.
SmallMotionEquations RotationFit::equations(const RotationSet& set, std::size_t i, int num_samples,
                                            const Annealing& annealing) const {
  const Points& points = surface_->points;
  const LocalGeometry& geometry = surface_->geometry;
  const Eigen::Matrix3d& rotation = set.rotations[i];
  const Eigen::Matrix3d moves = (Eigen::Matrix3d::Identity() - rotation).transpose();
  const double sq_sigma = annealing.sigma * annealing.sigma;
  const std::size_t size = std::min(surface_->order.size(), static_cast<std::size_t>(num_samples));
  SmallMotionEquations sums;
  for (std::size_t k = 0; k < size; ++k) {
    const int sample = surface_->order[k];
    const Eigen::Vector3d x = set.image(i, points.col(sample).cast<double>());
    const Eigen::Vector3f image = x.cast<float>();
    SurfaceDiscs::Nearest nearest;
    if (annealing.rough) {
      nearest.disc = closestSample(image);
      nearest.distance = (points.col(nearest.disc) - image).norm();
    } else {
      nearest = surface_->discs->nearest(image);
    }
    if (nearest.disc < 0 || nearest.distance > kRefinement.reach_sigmas * annealing.sigma) continue;
    const Eigen::Vector3d y = points.col(nearest.disc).cast<double>();
    const Eigen::Vector3d normal = geometry.normals.col(nearest.disc).cast<double>();
    const Eigen::Vector3d rotated = rotation * geometry.normals.col(sample).cast<double>();
    const double cosine = rotated.dot(normal);
    const Eigen::Vector3d m = (normal + (cosine < 0.0 ? -rotated : rotated)).normalized();
    const double weight =
        cosine * cosine * std::exp(-static_cast<double>(nearest.distance) * nearest.distance / sq_sigma);
    Vector6d slope;
    slope << moves * (x - set.center).cross(m), moves * m;
    sums.h.selfadjointView<Eigen::Lower>().rankUpdate(slope, weight);
    sums.g += weight * m.dot(x - y) * slope;
  }
  return sums;
}

RotationSet RotationFit::fitRotations(RotationSet set, const std::vector<int>& used, int num_samples,
                                      Annealing annealing) const {
  std::vector<SmallMotionEquations> parts(used.size());
  for (int iteration = 0; iteration < annealing.max_iterations; ++iteration) {
    parallelBlocks(used.size(), num_threads_,
                   [&](std::size_t k) { parts[k] = equations(set, used[k], num_samples, annealing); });
    SmallMotionEquations sums;
    for (const SmallMotionEquations& part : parts) {
      sums.h += part.h;
      sums.g += part.g;
    }
    const Vector6d step = smallMotion(sums, kRefinement.min_stiffness, kRefinement.longest_step);
    if (!step.allFinite()) break;
    const Eigen::Matrix3d change = rotationBy(step.head<3>());
    for (Eigen::Matrix3d& rotation : set.rotations) rotation = change * rotation * change.transpose();
    set.center += step.tail<3>();
    const double length = step.norm();
    if (annealing.sigma == annealing.final_sigma && length <= kRotation.settled_step) break;
    if (length <= kRefinement.rest_sigmas * annealing.sigma)
      annealing.sigma = std::max(annealing.final_sigma, 0.5 * annealing.sigma);
  }
  return set;
}

OffShares RotationFit::offShares(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& center,
                                 int num_samples) const {
  const Points& points = surface_->points;
  const std::size_t size = std::min(surface_->order.size(), static_cast<std::size_t>(num_samples));
  const Eigen::Matrix3f R = rotation.cast<float>();
  const Eigen::Vector3f shift = (center - rotation * center).cast<float>();
  const auto tolerance = static_cast<float>(limits_.tolerance);
  // The closest sample lies beside the closest point of the surface.
  const auto far = static_cast<float>(
      std::hypot(kRotation.far_tolerances * limits_.tolerance, kEvidence.disc_radius * surface_->spacing));
  std::size_t num_off = 0, num_far = 0;
  for (std::size_t k = 0; k < size; ++k) {
    const Eigen::Vector3f x = R * points.col(surface_->order[k]) + shift;
    if (surface_->discs->isWithin(x, tolerance)) continue;
    ++num_off;
    num_far += (points.col(closestSample(x)) - x).squaredNorm() > far * far ? 1 : 0;
  }
  const double share_off = static_cast<double>(num_off) / static_cast<double>(size);
  return {std::max(0.0, 1.0 - (1.0 - share_off) / own_share_),
          static_cast<double>(num_far) / static_cast<double>(size)};
}

OffShares RotationFit::worstShares(const RotationSet& set, int num_samples, double max_excess) const {
  const std::size_t at_a_time = 4;  // rotations, for the threads
  OffShares worst;
  for (std::size_t begin = 0; begin < set.num_judged; begin += at_a_time) {
    std::vector<OffShares> shares(std::min(at_a_time, set.num_judged - begin));
    parallelBlocks(shares.size(), num_threads_,
                   [&](std::size_t i) { shares[i] = offShares(set.rotations[begin + i], set.center, num_samples); });
    for (const OffShares& other : shares) worst = {std::max(worst.off, other.off), std::max(worst.far, other.far)};
    if (limits_.excess(worst) > max_excess) break;
  }
  return worst;
}

double RotationFit::confidence(const OffShares& shares) const {
  return limits_.confidence(shares, surface_->order.size());
}

Eigen::Vector3d RotationFit::whereOff(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& center) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (Eigen::Index i = 0; i < points().cols(); ++i) {
    const Eigen::Vector3d x = points().col(i).cast<double>();
    const Eigen::Vector3d image = center + rotation * (x - center);
    if (surface_->discs->isWithin(image.cast<float>(), static_cast<float>(limits_.tolerance))) continue;
    sum += x;
    ++count;
  }
  return count > 0 ? Eigen::Vector3d(sum / count) : center;
}

}  // namespace pcl_symmetry
