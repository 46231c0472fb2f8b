#include "core/rotation/rotation_fit.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/median.h"
#include "core/base/parallel.h"
#include "core/distance_transform/edt_correlation.h"
#include "core/evidence/plane_confidence.h"
#include "core/evidence/plane_support.h"
#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr int kOverlapSamples = 256, kFewSamples = 150, kSomeSamples = 1000, kManySamples = 3000;
constexpr double kFinalSigmaInSpacings = 3.0;  // as of planes
constexpr int kRoughIterations = 8, kCloseIterations = 12;
constexpr double kLeastStiffness = 1e-3;  // of the greatest: what is softer is free, as turns of a cylinder are
constexpr int kMostWitnesses = 3;         // of four neighbours
constexpr double kLongestStep = 0.2;      // radians and radii together
constexpr double kRest = 0.1;             // sigmas: steps that count as rest
constexpr double kSettled = 1e-4;         // radians and radii together
constexpr std::size_t kMostFitted = 6;    // of a large group, spread over it

double mean(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

Eigen::Matrix3d turnBy(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (angle == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, rotation_vector / angle).toRotationMatrix();
}

/// Indices of at most \p most of \p size things, evenly spread.
std::vector<std::size_t> spreadOver(std::size_t size, std::size_t most) {
  std::vector<std::size_t> chosen(std::min(size, most));
  for (std::size_t i = 0; i < chosen.size(); ++i) chosen[i] = i * size / chosen.size();
  return chosen;
}

}  // namespace

/// Sums of the squared distances m . (x' - y) for small turns omega of the axes and moves t of the center.
struct RotationFit::NormalEquations {
  Matrix6d h = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();

  void add(const NormalEquations& other) {
    h += other.h;
    g += other.g;
  }

  /// Directions that the surface says nothing about are left alone.
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
      roughness_(median(geometry_.roughness) / std::max(spacing_, 1e-6)),
      baseline_(std::max(mean(ownSupport(points_, geometry_)), 1e-3)),
      sigma_(edt.sigma()),
      final_sigma_(std::min(sigma_, std::max(1e-6, kFinalSigmaInSpacings * spacing_))),
      few_(drawSamples(points_.cols(), kFewSamples, seed)),
      some_(drawSamples(points_.cols(), kSomeSamples, seed + 1)),
      many_(drawSamples(points_.cols(), kManySamples, seed + 3)),
      all_(allOf(points_.cols())),
      scattered_(pointsAt(points_, drawSamples(points_.cols(), kOverlapSamples, seed + 2))),
      own_overlap_(1.0),
      own_feature_(featureShare(ownSupport(points_, geometry_))) {
  // A rotated sample finds another one as far away as the closest other one of a sample is.
  double sum = 0.0;
  for (Eigen::Index i = 0; i < points_.cols(); ++i) {
    const double sq_distance = (points_.col(i) - points_.col(geometry_.nearest[i][0])).squaredNorm();
    sum += std::exp(-sq_distance / (sigma_ * sigma_));
  }
  own_overlap_ = std::max(sum / static_cast<double>(points_.cols()), 1e-3);
}

double RotationFit::overlap(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& center) const {
  const Eigen::Matrix3d turn = rotation / edt_.cellSize();
  const Eigen::Vector3d shift = (center - rotation * center - edt_.origin()) / edt_.cellSize();
  double sum = 0.0;
  for (Eigen::Index i = 0; i < scattered_.cols(); ++i)
    sum += edt_.atCell(turn * scattered_.col(i).cast<double>() + shift);
  return sum / (own_overlap_ * static_cast<double>(scattered_.cols()));
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

/// With R' = exp(omega) R exp(-omega) and c' = c + t, x' = R (x - c) + c moves by ((1 - R) omega) x (x' - c) + (1 - R)
/// t.
RotationFit::NormalEquations RotationFit::equations(const RotationSet& set, std::size_t i,
                                                    const std::vector<int>& samples, double sigma) const {
  constexpr double kReach = 3.0;  // sigmas: beyond, weights are below 1.3e-4
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
                                Weights weights) const {
  std::vector<NormalEquations> parts(used.size());
  for (int iteration = 0; iteration < weights.max_iterations; ++iteration) {
    parallelBlocks(used.size(), num_threads_,
                   [&](std::size_t k) { parts[k] = equations(set, used[k], samples, weights.sigma); });
    NormalEquations sums;
    for (const NormalEquations& part : parts) sums.add(part);
    const Vector6d step = sums.step();
    if (!step.allFinite()) break;
    const Eigen::Matrix3d turn = turnBy(step.head<3>());
    for (Eigen::Matrix3d& rotation : set.rotations) rotation = turn * rotation * turn.transpose();
    set.center += step.tail<3>();
    const double length = step.norm();
    if (weights.sigma == weights.final_sigma && length <= kSettled) break;
    if (length <= kRest * weights.sigma) weights.sigma = std::max(weights.final_sigma, 0.5 * weights.sigma);
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
  search_->searchWithin(rotated, static_cast<float>(9.0 * final_sigma_ * final_sigma_), closest, sq_distances);
  return pointEvidence(rotated, normals, closest, points_, geometry_, nullptr).support;
}

/// Sampling leaves single points off the surface; a feature that the rotation does not keep leaves most neighbours off.
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
  const PlaneEvidence together{support, 1.0 - support, mean_of(scores), baseline_, spacing_, roughness_, false, false};
  return {seenSupport(together), *std::max_element(features.begin(), features.end()), planeConfidence(together)};
}

}  // namespace pcl_symmetry
