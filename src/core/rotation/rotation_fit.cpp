#include "core/rotation/rotation_fit.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/median.h"
#include "core/base/parallel.h"
#include "core/distance_transform/edt_correlation.h"
#include "core/evidence/plane_support.h"
#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Log odds that rotations are symmetries, each summand of unit 1.
///
/// fitted: logistic regression for planes on whole clouds of 500 to 10 000 points, with noise of 0 to 2 % of the
/// diagonal, of 200 models of the training half of the Princeton Shape Benchmark; the intercept was set by hand.
struct RotationConfidence {
  double intercept = 4.5, per_unexplained = -2.0, per_lost_score = -0.2;
  double unexplained_per_roughness = 0.03;  ///< what uncertain normals leave of a symmetry
  double unexplained_unit = 0.01, unexplained_unit_per_spacing = 0.3;
  double lost_unit = 0.003, lost_unit_per_sq_spacing = 2.0;  ///< noise of the distance transform
};
constexpr RotationConfidence kConfidence{};  // fitted: see above

// Points of overlap(). chosen: half lets chance hide axes, twice takes twice the time of the search.
constexpr int kOverlapSamples = 256;
// Points of rough fits, rough support and close fits. chosen: half makes the fits less exact and drops true axes by
// chance, twice takes twice the time.
constexpr int kFewSamples = 150, kSomeSamples = 1000, kManySamples = 3000;
// Spacings, width of the weights at the end. chosen: as for planes; half leaves too few pairs, twice is less exact.
constexpr double kFinalSigmaInSpacings = 3.0;
// Iterations of the two fits. chosen: half cuts fits short, twice changes little as settled fits end early.
constexpr int kRoughIterations = 8, kCloseIterations = 12;
// Share of the greatest eigenvalue below which a direction is free, as turns of a cylinder about its axis are. chosen:
// half lets sampling move free directions, twice freezes slender shapes.
constexpr double kLeastStiffness = 1e-3;
// Neighbours of four that have to be off the surface for a sample to belong to a feature. chosen: with 2 sampling alone
// makes features, with 4 small features vanish.
constexpr int kMostWitnesses = 3;
// Radians and radii together, longest step. chosen: half takes more iterations, twice may leave the basin.
constexpr double kLongestStep = 0.2;
// Sigmas, a shorter step halves the width of the weights. chosen: half waits longer, twice narrows before the set
// rests.
constexpr double kRest = 0.1;
// Radians and radii together, a shorter step ends the fit. chosen: a hundredth of the tolerance of 1 %; half takes an
// iteration more, twice ends earlier.
constexpr double kSettled = 1e-4;
// Rotations of a large group that are fitted, spread over it. chosen: half may leave an axis free, twice takes twice
// the time.
constexpr std::size_t kMostFitted = 6;
// Least overlap and support of a surface with itself. derived: guards the divisions for isolated points only.
constexpr double kLeastOwn = 1e-3;
// Radii, least spacing. derived: the rounding of float coordinates.
constexpr double kLeastSpacing = 1e-6;
// Sigmas, reach of the search for closest points. derived: beyond, weights exp(-9) are below 1.3e-4.
constexpr double kReach = 3.0;

double mean(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

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

RotationFit::RotationFit(Points points, const GaussianEdt& edt, std::uint64_t seed, int num_threads)
    : points_(std::move(points)),
      edt_(edt),
      num_threads_(num_threads),
      search_(makeFlannSearch(points_)),
      geometry_(localGeometry(points_, *search_, kNumSupportNeighbours, num_threads)),
      spacing_(median(geometry_.spacing)),
      roughness_(median(geometry_.roughness) / std::max(spacing_, kLeastSpacing)),
      baseline_(std::max(mean(ownSupport(points_, geometry_)), kLeastOwn)),
      sigma_(edt.sigma()),
      final_sigma_(std::min(sigma_, std::max(kLeastSpacing, kFinalSigmaInSpacings * spacing_))),
      few_(drawSamples(points_.cols(), kFewSamples, seed)),
      some_(drawSamples(points_.cols(), kSomeSamples, seed + 1)),
      many_(drawSamples(points_.cols(), kManySamples, seed + 3)),
      all_(allOf(points_.cols())),
      overlap_points_(pointsAt(points_, drawSamples(points_.cols(), kOverlapSamples, seed + 2))),
      own_overlap_(1.0),
      own_feature_(featureShare(ownSupport(points_, geometry_))) {
  // Under a symmetry the closest sample of a rotated sample is as far away as the closest other sample of a sample.
  double sum = 0.0;
  for (Eigen::Index i = 0; i < points_.cols(); ++i) {
    const double sq_distance = (points_.col(i) - points_.col(geometry_.nearest[i][0])).squaredNorm();
    sum += std::exp(-sq_distance / (sigma_ * sigma_));
  }
  own_overlap_ = std::max(sum / static_cast<double>(points_.cols()), kLeastOwn);
}

double RotationFit::overlap(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& center) const {
  const Eigen::Matrix3d turn = rotation / edt_.cellSize();
  const Eigen::Vector3d shift = (center - rotation * center - edt_.origin()) / edt_.cellSize();
  double sum = 0.0;
  for (Eigen::Index i = 0; i < overlap_points_.cols(); ++i)
    sum += edt_.atCell(turn * overlap_points_.col(i).cast<double>() + shift);
  return sum / (own_overlap_ * static_cast<double>(overlap_points_.cols()));
}

double RotationFit::overlap(const RotationSet& set) const {
  double least = 1.0;
  for (const Eigen::Matrix3d& rotation : set.rotations) least = std::min(least, overlap(rotation, set.center));
  return least;
}

RotationSet RotationFit::roughlyFitted(const RotationSet& set) const {
  return fitted(set, spreadOver(set.num_judged, kMostFitted), few_,
                {sigma_, std::max(final_sigma_, 0.5 * sigma_), kRoughIterations});
}

RotationSet RotationFit::closelyFitted(const RotationSet& set) const {
  const std::vector<std::size_t> used = spreadOver(set.rotations.size(), kMostFitted);
  return fitted(set, used, many_, {final_sigma_, final_sigma_, kCloseIterations});
}

/// x' = R (x - c) + c moves with R' = exp(omega) R exp(-omega) and c' = c + t
/// by ((1 - R) omega) x (x' - c) + (1 - R) t.
RotationFit::NormalEquations RotationFit::equations(const RotationSet& set, std::size_t i,
                                                    const std::vector<int>& samples, double sigma) const {
  const Eigen::Matrix3d& rotation = set.rotations[i];
  const Eigen::Matrix3d moves = (Eigen::Matrix3d::Identity() - rotation).transpose();
  const auto size = static_cast<Eigen::Index>(samples.size());
  Points rotated(3, size);
  for (Eigen::Index k = 0; k < size; ++k)
    rotated.col(k) = set.image(i, points_.col(samples[k]).cast<double>()).cast<float>();
  std::vector<int> closest(samples.size(), -1);
  std::vector<float> sq_distances;
  search_->searchWithin(rotated, static_cast<float>(kReach * kReach * sigma * sigma), closest, sq_distances);
  NormalEquations sums;
  for (Eigen::Index k = 0; k < size; ++k) {
    if (closest[k] < 0) continue;
    const Eigen::Vector3d x = rotated.col(k).cast<double>(), y = points_.col(closest[k]).cast<double>();
    const Eigen::Vector3d normal = geometry_.normals.col(closest[k]).cast<double>();
    const Eigen::Vector3d turned = rotation * geometry_.normals.col(samples[k]).cast<double>();
    const double cosine = turned.dot(normal);
    const Eigen::Vector3d m = (normal + (cosine < 0.0 ? -turned : turned)).normalized();
    const double weight = cosine * cosine * std::exp(-sq_distances[k] / (sigma * sigma));
    Vector6d slope;
    slope << moves * (x - set.center).cross(m), moves * m;
    sums.h.selfadjointView<Eigen::Lower>().rankUpdate(slope, weight);
    sums.g += weight * m.dot(x - y) * slope;
  }
  return sums;
}

RotationSet RotationFit::fitted(RotationSet set, const std::vector<std::size_t>& used, const std::vector<int>& samples,
                                Annealing annealing) const {
  std::vector<NormalEquations> parts(used.size());
  for (int iteration = 0; iteration < annealing.max_iterations; ++iteration) {
    parallelBlocks(used.size(), num_threads_,
                   [&](std::size_t k) { parts[k] = equations(set, used[k], samples, annealing.sigma); });
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

std::vector<float> RotationFit::support(const RotationSet& set, std::size_t i, const std::vector<int>& samples) const {
  const auto size = static_cast<Eigen::Index>(samples.size());
  Points rotated(3, size), normals(3, size);
  for (Eigen::Index k = 0; k < size; ++k) {
    rotated.col(k) = set.image(i, points_.col(samples[k]).cast<double>()).cast<float>();
    normals.col(k) = (set.rotations[i] * geometry_.normals.col(samples[k]).cast<double>()).cast<float>();
  }
  std::vector<int> closest(samples.size(), -1);
  std::vector<float> sq_distances;
  search_->searchWithin(rotated, static_cast<float>(kReach * kReach * final_sigma_ * final_sigma_), closest,
                        sq_distances);
  return pointEvidence(rotated, normals, closest, points_, geometry_, nullptr).support;
}

/// The share of samples that are off the surface together with most of their neighbours: the pieces of all features
/// together. Sampling leaves single samples off the surface.
double RotationFit::featureShare(const std::vector<float>& support) const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < support.size(); ++i) {
    if (support[i] > 0.5f) continue;
    int off = 0;
    for (const int j : geometry_.nearest[i]) off += support[j] <= 0.5f ? 1 : 0;
    count += off >= kMostWitnesses ? 1 : 0;
  }
  return static_cast<double>(count) / static_cast<double>(support.size());
}

double RotationFit::score(const RotationSet& set, std::size_t i) const {
  const Eigen::Matrix3d& rotation = set.rotations[i];
  const Eigen::Vector3d shift = (set.image(i, edt_.origin()) - edt_.origin()) / edt_.cellSize();
  return correlation(
      edt_, [&](const Eigen::Vector3d& x) -> Eigen::Vector3d { return rotation * x + shift; }, rotation.col(0));
}

double RotationFit::roughSupport(const RotationSet& set) const {
  std::vector<double> supports(set.num_judged);
  parallelBlocks(supports.size(), num_threads_, [&](std::size_t i) { supports[i] = mean(support(set, i, some_)); });
  return *std::min_element(supports.begin(), supports.end()) / baseline_;
}

double RotationFit::confidence(double support, double score) const {
  const RotationConfidence& fit = kConfidence;
  const double unexplained = (1.0 - support - fit.unexplained_per_roughness * roughness_) /
                             (fit.unexplained_unit + fit.unexplained_unit_per_spacing * spacing_);
  const double lost = (1.0 - score) / (fit.lost_unit + fit.lost_unit_per_sq_spacing * spacing_ * spacing_);
  return 1.0 / (1.0 + std::exp(-(fit.intercept + fit.per_unexplained * unexplained + fit.per_lost_score * lost)));
}

RotationEvidence RotationFit::evidence(const RotationSet& set) const {
  std::vector<double> supports(set.num_judged), features(set.num_judged), scores(set.num_judged);
  parallelBlocks(set.num_judged, num_threads_, [&](std::size_t i) {
    const std::vector<float> point_support = support(set, i, all_);
    supports[i] = mean(point_support);
    features[i] = std::max(0.0, featureShare(point_support) - own_feature_);
    scores[i] = score(set, i);
  });
  const auto mean_of = [](const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  };
  const double support = mean_of(supports);
  const double relative = std::min(1.0, support / baseline_);
  return {relative, *std::max_element(features.begin(), features.end()), confidence(relative, mean_of(scores))};
}

}  // namespace pcl_symmetry
