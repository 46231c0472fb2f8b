#include "core/rotation/rotation_fit.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/median.h"
#include "core/base/parallel.h"
#include "core/evidence/surface_samples.h"
#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// Tolerances, beyond which a piece of surface sticks out. chosen: a tenth of the diameter at the default, as in the
// definition of symmetries by the BOP benchmark; at half, screws count as parts, at twice handles as features.
constexpr double kFar = 10.0;
// Share of the surface that may stick out, of that which may be off. chosen: at half, plugs break symmetries, at twice
// a thin handle of a large mug does not.
constexpr double kFarOfFeature = 0.125;
// Least share that may stick out. derived: single samples at sharp edges are far by chance; 2 of 1000.
constexpr double kLeastFar = 0.002;
// By how much the true excess is greater than that of a cloud, to which the rotation was fitted. chosen: 1.28 was
// measured on 98 groups of 354 models of PSB, fold 0, of which 24 are wrong: too few for a fit.
constexpr double kOptimism = 1.3;
// How uncertain a share is: at least, and in standard errors of a share near the limit. chosen: with the first, the
// confidences of these groups come true; the second matters for fewer points, half calls chance certain, twice calls
// everything uncertain.
constexpr double kShareUnit = 0.02, kStandardErrors = 0.5;

// Points of overlap(). chosen: half lets chance hide axes, twice takes twice the time of the search.
constexpr int kOverlapSamples = 256;
// Points of rough and close fits. chosen: half makes the fits less exact and drops true axes by chance, twice takes
// twice the time.
constexpr int kFewSamples = 200, kManySamples = 1000;
// Cells of the grid of closest samples. chosen: half misleads rough fits, twice takes eight times the time.
constexpr int kGridCells = 32;
// Steps from a sample to a closer neighbour. derived: a cell of the grid is a few spacings wide.
constexpr int kMaxHops = 4;
// Tolerances, and spacings, width of the weights of close fits at first; tolerances, and roughnesses, at last. chosen:
// at half of the first, fits stay where rough fits end; at twice of the last, features move the axis.
constexpr double kFirstTolerances = 2.0, kFirstSpacings = 1.0, kLastTolerances = 0.7, kLastRoughnesses = 3.0;
// Iterations of the two fits. chosen: half cuts fits short, twice changes little as settled fits end early.
constexpr int kRoughIterations = 8, kCloseIterations = 12;
// Share of the greatest eigenvalue below which a direction is free, as turns of a cylinder about its axis are. chosen:
// half lets sampling move free directions, twice freezes slender shapes.
constexpr double kLeastStiffness = 1e-3;
// Radians and radii together, longest step. chosen: half takes more iterations, twice may leave the basin.
constexpr double kLongestStep = 0.2;
// Sigmas, a shorter step halves the width of the weights. chosen: half waits longer, twice narrows before the set
// rests.
constexpr double kRest = 0.1;
// Radians and radii together, a shorter step ends the fit. chosen: a hundredth of the tolerance of 1 %; half takes an
// iteration more, twice ends earlier.
constexpr double kSettled = 2e-4;
// Rotations of a large group that are fitted, spread over it. chosen: half may leave an axis free, twice takes twice
// the time.
constexpr std::size_t kMostFitted = 6;
// Least overlap and share of a surface with itself. derived: guards the divisions for isolated points only.
constexpr double kLeastOwn = 1e-3;
// Radii, least tolerance and width. derived: the rounding of float coordinates.
constexpr double kLeastLength = 1e-6;
// Sigmas, reach of the weights. derived: beyond, weights exp(-9) are below 1.3e-4.
constexpr double kReach = 3.0;
// How much farther off a disc a new sample lies than a sample that the disc was fitted to. derived: as for planes, the
// root of (1 + l) / (1 - l) with l = 3 parameters / 9 points.
constexpr float kNewSampleFactor = 1.41421356f;

Eigen::Matrix3d turnBy(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (angle == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, rotation_vector / angle).toRotationMatrix();
}

/// Indices of at most \p most of \p size items, evenly spread.
std::vector<std::size_t> spreadOver(std::size_t size, std::size_t most) {
  std::vector<std::size_t> chosen(std::min(size, most));
  for (std::size_t i = 0; i < chosen.size(); ++i) chosen[i] = i * size / chosen.size();
  return chosen;
}

}  // namespace

double RotationLimits::excess(const OffShares& shares) const {
  const double far = std::max(kLeastFar, kFarOfFeature * max_feature);
  const double by_off = max_feature > 0.0 ? shares.off / max_feature : (shares.off > 0.0 ? 2.0 : 0.0);
  return std::max(by_off, shares.far / far);
}

double RotationLimits::confidence(const OffShares& shares, std::size_t num_points) const {
  const double unit =
      kShareUnit + kStandardErrors * std::sqrt(max_feature * (1.0 - max_feature) / static_cast<double>(num_points));
  const double margin = max_feature > 0.0 ? max_feature * (1.0 - kOptimism * excess(shares)) : -shares.off;
  return 1.0 / (1.0 + std::exp(-margin / unit));
}

/// Least squares of the distances m . (x' - y) in small turns omega of all axes and moves t of the center: unknowns
/// (omega, t).
struct RotationFit::NormalEquations {
  Matrix6d h = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();

  void add(const NormalEquations& other) {
    h += other.h;
    g += other.g;
  }

  /// The Gauss-Newton step, at most kLongestStep long. Directions that the surface does not fix stay as they are.
  Vector6d step() const {
    const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(h);
    Vector6d result = Vector6d::Zero();
    for (int i = 0; i < 6; ++i) {
      const double stiffness = solver.eigenvalues()[i];
      if (!(stiffness > kLeastStiffness * solver.eigenvalues()[5])) continue;
      result -= solver.eigenvectors().col(i) * (solver.eigenvectors().col(i).dot(g) / stiffness);
    }
    const double length = result.norm();
    return length > kLongestStep ? Vector6d(result * (kLongestStep / length)) : result;
  }
};

RotationFit::RotationFit(Points points, const GaussianEdt& edt, RotationLimits limits, double reach, std::uint64_t seed,
                         int num_threads)
    : edt_(edt), limits_(limits), own_share_(1.0), first_sigma_(0.0), last_sigma_(0.0), num_threads_(num_threads) {
  const auto surface = std::make_shared<Surface>();
  surface->points = std::move(points);
  const Points& p = surface->points;
  const auto search = makeFlannSearch(p);
  surface->geometry = localGeometry(p, *search, kNumSupportNeighbours, num_threads);
  const LocalGeometry& geometry = surface->geometry;
  surface->spacing = median(geometry.spacing);
  surface->roughness = median(geometry.roughness);
  first_sigma_ = std::max({kLeastLength, kFirstTolerances * limits.tolerance, kFirstSpacings * surface->spacing});
  last_sigma_ = std::max({kLeastLength, kLastTolerances * limits.tolerance, kLastRoughnesses * surface->roughness});
  last_sigma_ = std::min(last_sigma_, first_sigma_);
  const double farthest = std::max(reach, first_sigma_);
  surface->discs = std::make_unique<SurfaceDiscs>(p, geometry, evidence_rules.disc_radius, static_cast<float>(farthest));
  surface->grid = std::make_unique<ClosestPointGrid>(p, kGridCells);
  surface->own_distances.resize(static_cast<std::size_t>(p.cols()));
  constexpr std::size_t kBlockSize = 512;  // points; chosen: smaller blocks cost more calls, larger ones idle threads
  parallelRanges(surface->own_distances.size(), kBlockSize, num_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      surface->own_distances[i] = surface->discs->ownDistance(static_cast<int>(i), kNewSampleFactor);
  });
  surface->order = drawSamples(p.cols(), static_cast<int>(p.cols()) - 1, seed);
  surface->overlap_points = pointsAt(p, drawSamples(p.cols(), kOverlapSamples, seed + 2));
  // Under a symmetry the closest sample of a rotated sample is as far away as the closest other sample of a sample.
  double sum = 0.0;
  for (Eigen::Index i = 0; i < p.cols(); ++i) {
    const double sq_distance = (p.col(i) - p.col(geometry.nearest[i][0])).squaredNorm();
    sum += std::exp(-sq_distance / (edt.sigma() * edt.sigma()));
  }
  surface->own_overlap = std::max(sum / static_cast<double>(p.cols()), kLeastOwn);
  surface_ = surface;
  own_share_ = ownShare();
}

RotationFit RotationFit::withLimits(RotationLimits limits) const {
  RotationFit other = *this;
  other.limits_ = limits;
  other.own_share_ = other.ownShare();
  return other;
}

double RotationFit::ownShare() const {
  const std::vector<float>& distances = surface_->own_distances;
  const auto within =
      std::count_if(distances.begin(), distances.end(), [&](float distance) { return distance <= limits_.tolerance; });
  return std::max(kLeastOwn, static_cast<double>(within) / static_cast<double>(distances.size()));
}

double RotationFit::overlap(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& center, int num_points) const {
  const Points& points = surface_->overlap_points;
  const Eigen::Index size = std::min<Eigen::Index>(points.cols(), num_points);
  const Eigen::Matrix3d turn = rotation / edt_.cellSize();
  const Eigen::Vector3d shift = (center - rotation * center - edt_.origin()) / edt_.cellSize();
  double sum = 0.0;
  for (Eigen::Index i = 0; i < size; ++i) sum += edt_.atCell(turn * points.col(i).cast<double>() + shift);
  return sum / (surface_->own_overlap * static_cast<double>(size));
}

double RotationFit::overlap(const RotationSet& set) const {
  double least = 1.0;
  for (const Eigen::Matrix3d& rotation : set.rotations) least = std::min(least, overlap(rotation, set.center));
  return least;
}

RotationSet RotationFit::roughlyFitted(const RotationSet& set) const {
  const double sigma = edt_.sigma();
  return fitted(set, spreadOver(set.num_judged, kMostFitted), kFewSamples,
                {sigma, std::max(std::min(sigma, first_sigma_), 0.5 * sigma), kRoughIterations, true});
}

RotationSet RotationFit::closelyFitted(const RotationSet& set) const {
  return fitted(set, spreadOver(set.rotations.size(), kMostFitted), kManySamples,
                {first_sigma_, last_sigma_, kCloseIterations, false});
}

/// The sample that the grid names for the cell of a point, or a neighbour that is closer.
int RotationFit::closestSample(const Eigen::Vector3f& x) const {
  const Points& points = surface_->points;
  int closest = surface_->grid->closest(x);
  float least = (points.col(closest) - x).squaredNorm();
  for (int hop = 0; hop < kMaxHops; ++hop) {
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
RotationFit::NormalEquations RotationFit::equations(const RotationSet& set, std::size_t i, int num_samples,
                                                    const Annealing& annealing) const {
  const Points& points = surface_->points;
  const LocalGeometry& geometry = surface_->geometry;
  const Eigen::Matrix3d& rotation = set.rotations[i];
  const Eigen::Matrix3d moves = (Eigen::Matrix3d::Identity() - rotation).transpose();
  const double sq_sigma = annealing.sigma * annealing.sigma;
  const std::size_t size = std::min(surface_->order.size(), static_cast<std::size_t>(num_samples));
  NormalEquations sums;
  for (std::size_t k = 0; k < size; ++k) {
    const int sample = surface_->order[k];
    const Eigen::Vector3d x = set.image(i, points.col(sample).cast<double>());
    const Eigen::Vector3f place = x.cast<float>();
    SurfaceDiscs::Nearest nearest;
    if (annealing.rough) {
      nearest.disc = closestSample(place);
      nearest.distance = (points.col(nearest.disc) - place).norm();
    } else {
      nearest = surface_->discs->nearest(place);
    }
    if (nearest.disc < 0 || nearest.distance > kReach * annealing.sigma) continue;
    const Eigen::Vector3d y = points.col(nearest.disc).cast<double>();
    const Eigen::Vector3d normal = geometry.normals.col(nearest.disc).cast<double>();
    const Eigen::Vector3d turned = rotation * geometry.normals.col(sample).cast<double>();
    const double cosine = turned.dot(normal);
    const Eigen::Vector3d m = (normal + (cosine < 0.0 ? -turned : turned)).normalized();
    const double weight =
        cosine * cosine * std::exp(-static_cast<double>(nearest.distance) * nearest.distance / sq_sigma);
    Vector6d slope;
    slope << moves * (x - set.center).cross(m), moves * m;
    sums.h.selfadjointView<Eigen::Lower>().rankUpdate(slope, weight);
    sums.g += weight * m.dot(x - y) * slope;
  }
  return sums;
}

RotationSet RotationFit::fitted(RotationSet set, const std::vector<std::size_t>& used, int num_samples,
                                Annealing annealing) const {
  std::vector<NormalEquations> parts(used.size());
  for (int iteration = 0; iteration < annealing.max_iterations; ++iteration) {
    parallelBlocks(used.size(), num_threads_,
                   [&](std::size_t k) { parts[k] = equations(set, used[k], num_samples, annealing); });
    NormalEquations sums;
    for (const NormalEquations& part : parts) sums.add(part);
    const Vector6d step = sums.step();
    if (!step.allFinite()) break;
    const Eigen::Matrix3d turn = turnBy(step.head<3>());
    for (Eigen::Matrix3d& rotation : set.rotations) rotation = turn * rotation * turn.transpose();
    set.center += step.tail<3>();
    const double length = step.norm();
    if (annealing.sigma == annealing.final_sigma && length <= kSettled) break;
    if (length <= kRest * annealing.sigma) annealing.sigma = std::max(annealing.final_sigma, 0.5 * annealing.sigma);
  }
  return set;
}

OffShares RotationFit::offShares(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& center,
                                 int num_samples) const {
  const Points& points = surface_->points;
  const std::size_t size = std::min(surface_->order.size(), static_cast<std::size_t>(num_samples));
  const Eigen::Matrix3f turn = rotation.cast<float>();
  const Eigen::Vector3f shift = (center - rotation * center).cast<float>();
  const auto tolerance = static_cast<float>(limits_.tolerance);
  // The closest sample lies beside the closest place of the surface.
  const auto far = static_cast<float>(std::hypot(kFar * limits_.tolerance, evidence_rules.disc_radius * surface_->spacing));
  std::size_t num_off = 0, num_far = 0;
  for (std::size_t k = 0; k < size; ++k) {
    const Eigen::Vector3f x = turn * points.col(surface_->order[k]) + shift;
    if (surface_->discs->isWithin(x, tolerance)) continue;
    ++num_off;
    num_far += (points.col(closestSample(x)) - x).squaredNorm() > far * far ? 1 : 0;
  }
  const double share_off = static_cast<double>(num_off) / static_cast<double>(size);
  return {std::max(0.0, 1.0 - (1.0 - share_off) / own_share_),
          static_cast<double>(num_far) / static_cast<double>(size)};
}

OffShares RotationFit::worstShares(const RotationSet& set, int num_samples, double most) const {
  constexpr std::size_t kAtATime = 4;  // derived: as many as threads are likely; the result does not depend on it
  OffShares worst;
  for (std::size_t begin = 0; begin < set.num_judged; begin += kAtATime) {
    std::vector<OffShares> shares(std::min(kAtATime, set.num_judged - begin));
    parallelBlocks(shares.size(), num_threads_,
                   [&](std::size_t i) { shares[i] = offShares(set.rotations[begin + i], set.center, num_samples); });
    for (const OffShares& other : shares) worst = {std::max(worst.off, other.off), std::max(worst.far, other.far)};
    if (limits_.excess(worst) > most) break;
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
