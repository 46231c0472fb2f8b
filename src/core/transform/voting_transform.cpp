#include "pcl_symmetry/core/transform/planar_transform.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/base/random.h"

namespace pcl_symmetry {

namespace {

/// Draws points of the EDT with probability f: cells in constant time by Walker's alias method, then a uniform place in
/// the cell, whose blur f is sharpened against; input frame.
class PointSampler {
public:
  PointSampler(const GaussianEdt& edt, int num_threads) : edt_(edt) {
    std::vector<double> share;
    const std::vector<float> f = edt.sharpened(1.0 / 24.0, num_threads);
    for (std::size_t i = 0; i < f.size(); ++i) {
      if (f[i] <= 0.0f) continue;
      cells_.push_back(edt.cellCenter(i).cast<float>());
      share.push_back(f[i]);
    }
    sum_ = std::accumulate(share.begin(), share.end(), 0.0);
    const double mean = sum_ / static_cast<double>(share.size());
    std::vector<std::uint32_t> small, large;
    for (std::uint32_t i = 0; i < share.size(); ++i) {
      share[i] /= mean;
      (share[i] < 1.0 ? small : large).push_back(i);
    }
    alias_.resize(share.size());
    threshold_.assign(share.size(), 1.0f);
    for (std::uint32_t i = 0; i < share.size(); ++i) alias_[i] = i;
    while (!small.empty() && !large.empty()) {
      const std::uint32_t s = small.back(), l = large.back();
      small.pop_back();
      threshold_[s] = static_cast<float>(share[s]);
      alias_[s] = l;
      share[l] -= 1.0 - share[s];
      if (share[l] < 1.0) {
        large.pop_back();
        small.push_back(l);
      }
    }
  }

  Eigen::Vector3d draw(RandomStream& random) const {
    const auto slot = random.below(cells_.size());
    const auto cell = random.uniform() < threshold_[slot] ? slot : alias_[slot];
    const Eigen::Vector3d jitter(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
    return cells_[cell].cast<double>() + edt_.cellSize() * jitter;
  }

  double sum() const { return sum_; }

private:
  const GaussianEdt& edt_;
  double sum_ = 0.0;
  std::vector<Eigen::Vector3f> cells_;
  std::vector<float> threshold_;
  std::vector<std::uint32_t> alias_;
};

}  // namespace

void VotingTransformOptions::validate() const {
  check(num_pairs >= 1, "num_pairs", num_pairs, ">= 1");
  check(std::isfinite(near_distance) && near_distance >= 0.0, "near_distance", near_distance, "finite and >= 0");
  check(near_share > 0.0 && near_share < 1.0, "near_share", near_share, "in (0, 1)");
  checkNumThreads(num_threads);
}

SymmetryMap votingTransform(const GaussianEdt& edt, const PlaneGrid& grid, const VotingTransformOptions& options) {
  options.validate();
  const PointSampler sampler(edt, options.num_threads);
  const double cell = edt.cellSize();
  const double near_distance = options.near_distance * cell;
  const bool split = near_distance > 0.0;
  const std::int64_t num_near = split ? static_cast<std::int64_t>(options.near_share * options.num_pairs) : 0;
  const std::int64_t num_far = options.num_pairs - num_near;
  const double bin_measure = grid.thetaStep() * grid.phiStep() * grid.radiusStep();
  const double cell_volume = cell * cell * cell;
  // Far pairs: S^2 h^3 / (N V |f|^2) sum 1 / (2 d^2 sin theta); the near ones: S V_near / (N V |f|^2) sum f(x').
  const double far_weight =
      num_far > 0 ? sampler.sum() * sampler.sum() * cell_volume / (num_far * bin_measure * edt.sqNorm()) : 0.0;
  const double near_weight =
      num_near > 0 ? sampler.sum() * (0.5 * kPi * 2.0 * kPi * near_distance) / (num_near * bin_measure * edt.sqNorm())
                   : 0.0;

  // A fixed number of partial maps, added up in their order.
  constexpr std::size_t kNumBlocks = 8;
  std::vector<std::vector<float>> partial(kNumBlocks);
  const auto share = [](std::int64_t total, std::size_t block) {
    return total * static_cast<std::int64_t>(block + 1) / static_cast<std::int64_t>(kNumBlocks) -
           total * static_cast<std::int64_t>(block) / static_cast<std::int64_t>(kNumBlocks);
  };
  parallelBlocks(kNumBlocks, options.num_threads, [&](std::size_t block) {
    auto& values = partial[block];
    values.assign(grid.size(), 0.0f);
    RandomStream random(options.seed, block);
    for (std::int64_t i = share(num_far, block); i > 0; --i) {
      const Eigen::Vector3d x = sampler.draw(random), y = sampler.draw(random);
      const double sq_distance = (y - x).squaredNorm();
      if (sq_distance <= near_distance * near_distance || sq_distance == 0.0) continue;
      const ReflectionPlane plane = ReflectionPlane::between(x, y);
      const auto bin = grid.find(plane);
      if (!bin) continue;
      const double sine = std::max(1e-6, std::hypot(plane.normal().x(), plane.normal().y()));
      values[grid.index(*bin)] += static_cast<float>(far_weight / (2.0 * sq_distance * sine));
    }
    for (std::int64_t i = share(num_near, block); i > 0; --i) {
      const Eigen::Vector3d x = sampler.draw(random);
      const double theta = 0.5 * kPi * random.uniform(), phi = 2.0 * kPi * random.uniform();
      const Eigen::Vector3d n(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      const double distance = near_distance * (2.0 * random.uniform() - 1.0);
      const auto bin = grid.find(ReflectionPlane(n, n.dot(x) + 0.5 * distance));
      if (bin) values[grid.index(*bin)] += static_cast<float>(near_weight * edt(x + distance * n));
    }
  });

  SymmetryMap map;
  map.grid = grid;
  map.method = TransformMethod::Voting;
  map.sigma = edt.sigma();
  map.center_of_mass = grid.center();
  map.values.assign(grid.size(), 0.0f);
  for (const auto& values : partial)
    for (std::size_t i = 0; i < values.size(); ++i) map.values[i] += values[i];
  return map;
}

}  // namespace pcl_symmetry
