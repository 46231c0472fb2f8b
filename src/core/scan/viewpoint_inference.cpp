#include "core/scan/viewpoint_inference.h"

#include "core/scan/scan_density.h"
#include "core/scan/single_view.h"

namespace pcl_symmetry {

namespace {

// share of the variance; chosen: between scans (0.005; 0.3 to 0.7 where one of ten points was kept or the noise reaches
// half the spacing) and whole clouds (more than 1 in most). At half the thinned scans are lost, at 1 whole clouds of
// uneven density pass.
constexpr double kMostUnexplained = 0.75;
// variance of the log of the density. chosen: 64 patches of scans have up to 0.005, of two scans put together from
// viewpoints 90 degrees apart 0.015 and more. Half loses noisy scans, twice accepts such pairs.
constexpr double kMostUneven = 0.008;
// Shares of the points, stricter than for viewpoints that are stored. chosen: nine of ten scans have less than 0.08 and
// 0.10, two scans put together from viewpoints 90 degrees apart have 0.11 and 0.28 in the middle. At half, noisy scans
// are lost, at twice every second pair of scans passes.
constexpr SingleViewLimits kLimits{0.12, 0.15};
// chosen: in scans of 1000 points the true viewpoint leaves up to 1.25 of what the best one leaves. Less refuses true
// viewpoints, twice accepts places that are 20 degrees off.
constexpr double kAsGood = 1.3;
// variance of the log of the density; chosen: what a depth camera has at 3 degrees from the best viewpoint. Half
// refuses true viewpoints of scans without noise, twice accepts places that are 10 degrees off.
constexpr double kAsGoodBeyond = 2.0 * ScanDensity::kLeastVariance;

}  // namespace

std::optional<InferredView> inferView(const PointsRef& points, const Eigen::Vector3d& stored) {
  const ScanDensity density(points);
  const std::optional<Eigen::Vector3d> best = density.bestViewpoint();
  if (!best) return std::nullopt;
  const double left = density.unexplained(*best);
  if (!(left + ScanDensity::kLeastVariance < kMostUnexplained * (density.variance() + ScanDensity::kLeastVariance)))
    return std::nullopt;
  const bool as_stored = density.unexplained(stored) <= kAsGood * left + kAsGoodBeyond;
  const Eigen::Vector3d& position = as_stored ? stored : *best;
  if (density.unexplainedByPatches(position) > kMostUneven) return std::nullopt;
  std::optional<Visibility> seen = spaceSeenFrom(points, position, kLimits);
  if (!seen) return std::nullopt;
  return InferredView{std::move(*seen), position, as_stored};
}

}  // namespace pcl_symmetry
