#include "core/transform/transform_rules.h"
#include "pcl_symmetry/core/planar_transform.h"

#include <algorithm>
#include <boost/random/discrete_distribution.hpp>
#include <cmath>
#include <numeric>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/base/random.h"

namespace pcl_symmetry {

namespace {

/// Draws points of the EDT with probability f: a cell, then a uniform position in it; f is sharpened to compensate for
/// this blur.
class PointSampler {
public:
  PointSampler(const GaussianEdt& edt, int num_threads) : edt_(edt) {
    std::vector<double> shares;
    const std::vector<float> f = edt.sharpened(0.5 * kTransform.of_interpolation, num_threads);
    for (std::size_t i = 0; i < f.size(); ++i) {
      if (f[i] <= 0.0f) continue;
      cells_.push_back(edt.cellCenter(i).cast<float>());
      shares.push_back(f[i]);
    }
    sum_ = std::accumulate(shares.begin(), shares.end(), 0.0);
    draw_cell_ = boost::random::discrete_distribution<std::size_t>(shares);
  }

  Eigen::Vector3d draw(RandomStream& random) const {
    const std::size_t cell = draw_cell_(random);
    const double z = random.uniform() - 0.5, y = random.uniform() - 0.5, x = random.uniform() - 0.5;
    return cells_[cell].cast<double>() + edt_.cellSize() * Eigen::Vector3d(x, y, z);
  }

  double sum() const { return sum_; }  ///< S, the sum of f over the cells

private:
  const GaussianEdt& edt_;
  std::vector<Eigen::Vector3f> cells_;
  double sum_;
  boost::random::discrete_distribution<std::size_t> draw_cell_;
};

/// The votes of Section 4.3, and votes for planes between close points.
class Votes {
public:
  Votes(const GaussianEdt& edt, const PlaneGrid& grid, const VotingTransformOptions& options)
      : edt_(edt), grid_(grid), sampler_(edt, options.num_threads), near_(options.near_distance * edt.cellSize()) {
    num_near_ = near_ > 0.0 ? static_cast<std::int64_t>(kTransform.near_share * options.num_pairs) : 0;
    num_far_ = options.num_pairs - num_near_;
    const double cell = edt.cellSize(), cell_volume = cell * cell * cell, sum = sampler_.sum();
    const double bin_measure = grid.thetaStep() * grid.phiStep() * grid.radiusStep();
    // S^2 h^3 / (N V |f|^2), the factor of the sum of 1 / (2 d^2 sin theta): the estimator of Section 4.3 for a
    // function f that is not normalized, on cells of volume h^3 and bins of measure V = dtheta dphi dr.
    if (num_far_ > 0) far_weight_ = sum * sum * cell_volume / (num_far_ * bin_measure * edt.sqNorm());
    // S V_near / (N V |f|^2), the factor of the sum of f(x').
    if (num_near_ > 0) near_weight_ = sum * (0.5 * kPi * 2.0 * kPi * near_) / (num_near_ * bin_measure * edt.sqNorm());
    const double step = grid.thetaStep();
    for (int t = 0; t < grid.numTheta(); ++t) sines_.push_back((std::cos(t * step) - std::cos((t + 1) * step)) / step);
  }

  std::int64_t numFar() const { return num_far_; }
  std::int64_t numNear() const { return num_near_; }

  /// Draws a pair (x, x') with probability f(x) f(x') and votes for the plane between its points.
  ///
  /// The weight is w_samp w_change-of-variables = 1 / (f(x) f(x')) * 1 / (2 d^2 sin theta) with d = |x - x'|;
  /// multiplied by the product f(x) f(x') that the transform integrates, it is 1 / (2 d^2 sin theta). The sine is the
  /// mean over the bin, and d is at least a cell, as between the different cells that the paper draws: both bound the
  /// weight.
  void voteFar(RandomStream& random, std::vector<float>& values) const {
    const Eigen::Vector3d x = sampler_.draw(random), y = sampler_.draw(random);
    const double sq_distance = (y - x).squaredNorm(), min_sq_distance = edt_.cellSize() * edt_.cellSize();
    if (sq_distance <= near_ * near_ || sq_distance == 0.0) return;
    const ReflectionPlane plane = ReflectionPlane::between(x, y);
    const auto bin = grid_.find(plane);
    if (!bin) return;
    const double weight = far_weight_ / (2.0 * std::max(sq_distance, min_sq_distance) * sines_[bin->theta]);
    values[grid_.index(*bin)] += static_cast<float>(weight);
  }

  /// Draws x with probability f(x) and a plane that is uniform in (theta, phi, r) at less than near / 2 from x; votes
  /// for the plane with f(x') of the reflected point x'.
  void voteNear(RandomStream& random, std::vector<float>& values) const {
    const Eigen::Vector3d x = sampler_.draw(random);
    const double theta = 0.5 * kPi * random.uniform(), phi = 2.0 * kPi * random.uniform();
    const Eigen::Vector3d n(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
    const double distance = near_ * (2.0 * random.uniform() - 1.0);
    const auto bin = grid_.find(ReflectionPlane(n, n.dot(x) + 0.5 * distance));
    if (!bin) return;
    const double weight = near_weight_ * std::sin(theta) / sines_[bin->theta];
    values[grid_.index(*bin)] += static_cast<float>(weight * edt_(x + distance * n));
  }

private:
  const GaussianEdt& edt_;
  const PlaneGrid& grid_;
  PointSampler sampler_;
  double near_;  // distance below which pairs are drawn plane first, input units
  std::int64_t num_near_ = 0, num_far_ = 0;
  double far_weight_ = 0.0, near_weight_ = 0.0;
  std::vector<double> sines_;  // mean of sin theta over the bins of each row
};

/// Number of pairs of a block if \p total pairs are shared among all blocks.
std::int64_t shareOf(std::size_t block, std::int64_t total) {
  const auto upTo = [&](std::size_t b) {
    return total * static_cast<std::int64_t>(b) / static_cast<std::int64_t>(kTransform.num_vote_blocks);
  };
  return upTo(block + 1) - upTo(block);
}

}  // namespace

void VotingTransformOptions::validate() const {
  check(num_pairs >= 1, "num_pairs", num_pairs, ">= 1");
  check(std::isfinite(near_distance) && near_distance >= 0.0, "near_distance", near_distance, "finite and >= 0");
  checkNumThreads(num_threads);
}

SymmetryMap votingTransform(const GaussianEdt& edt, const PlaneGrid& grid, const VotingTransformOptions& options) {
  options.validate();
  const Votes votes(edt, grid, options);
  std::vector<std::vector<float>> partial(kTransform.num_vote_blocks);
  parallelBlocks(kTransform.num_vote_blocks, options.num_threads, [&](std::size_t block) {
    std::vector<float>& values = partial[block];
    values.assign(grid.size(), 0.0f);
    RandomStream random(options.seed, block);
    const auto goesOn = [](std::int64_t i) {
      if (i % 65536 == 0) checkCancelled();
      return i > 0;
    };
    for (std::int64_t i = shareOf(block, votes.numFar()); goesOn(i); --i) votes.voteFar(random, values);
    for (std::int64_t i = shareOf(block, votes.numNear()); goesOn(i); --i) votes.voteNear(random, values);
  });
  SymmetryMap map = SymmetryMap::zero(edt, grid, TransformMethod::Voting);
  for (const auto& values : partial)
    for (std::size_t i = 0; i < values.size(); ++i) map.values[i] += values[i];
  return map;
}

}  // namespace pcl_symmetry
