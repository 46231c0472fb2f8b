#include "core/scan/viewpoint_inference.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "core/geometry/open_borders.h"
#include "core/geometry/point_samples.h"
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
// 0.10, two scans put together from viewpoints 90 degrees apart 0.11 and 0.28 in the middle. At half, noisy scans are
// lost; those of stored viewpoints, 0.18 and 0.25, accept half as many such pairs again.
constexpr SingleViewLimits kLimits{0.12, 0.15};
// The same where a viewpoint explains all of the variance of the density but kSurely, and all patches: leaves and wires
// lie in layers from the true viewpoint, too. measured: of 106 moved scans of folds 0 and 1 that had no viewpoint 19
// are accepted so, all within 4.5 degrees of the true one; of 632 whole and cut clouds none leaves less than a tenth.
// With twice kSurely 31 are accepted, of which 4 are 15 to 70 degrees off, with half of it 12.
constexpr SingleViewLimits kSureLimits{0.12, 0.4};
constexpr double kSurely = 0.015;
// variance of the log of the density. chosen: a quarter of kMostUneven; at twice, one more of these scans is accepted.
constexpr double kSurelyEven = 0.002;
// chosen: in scans of 1000 points the true viewpoint leaves up to 1.25 of what the best one leaves. Less refuses true
// viewpoints, twice accepts places that are 20 degrees off.
constexpr double kAsGood = 1.3;
// variance of the log of the density; chosen: what a depth camera has at 3 degrees from the best viewpoint. Half
// refuses true viewpoints of scans without noise, twice accepts places that are 10 degrees off.
constexpr double kAsGoodBeyond = 2.0 * ScanDensity::kLeastVariance;

// Variance of the log of the density that a place may leave that is not the best one. measured: of 1264 moved scans of
// folds 0 and 1 49 have a viewpoint in this way, 48 of them within 12 degrees of the true one, and leave up to 0.0023;
// two scans of a block put together leave 0.006. Of 2528 whole and cut clouds none has one.
constexpr double kMostOfSeveral = 0.003;

// derived: 12 neighbours give a density, so that fewer points have fewer than 25 independent ones, and the three
// numbers of a viewpoint explain a quarter of their variance by chance.
constexpr Eigen::Index kFewestPoints = 300;
// Of the points, for open borders. chosen: fewer see borders everywhere, more cost time.
constexpr int kBorderSamples = 2000;
// Share of the surface near open borders from which there is no surface to be seen. chosen: 60 scans of 1000 and of
// 10 000 points (fold 0) have 0.8 at most, curves in space 1.0.
constexpr double kWire = 0.9;

/// Whether all points are at a border, as those of a wire: its density says nothing, and it is seen once from
/// everywhere.
bool isWire(const PointsRef& points) {
  const Points drawn = pointsAt(points, drawSamples(points.cols(), kBorderSamples, 1));
  const ClosestPointSearch::Ptr search = makeFlannSearch(drawn);
  const LocalGeometry geometry = localGeometry(drawn, *search, kNumSupportNeighbours, 1);
  return shareNearBorders(openBorders(drawn, *search, geometry.normals, 1), geometry) > kWire;
}

/// Whether the surface bulges towards the viewer: on average it is farther away the farther it is from the middle of
/// the picture.
bool bulgesTowards(const PointsRef& points, const Eigen::Vector3d& center, const Eigen::Vector3d& viewpoint) {
  const Eigen::Vector3d forward = (center - viewpoint).normalized();
  double depth_sum = 0.0, sq_across_sum = 0.0, product_sum = 0.0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d x = points.col(i).cast<double>() - center;
    const double depth = forward.dot(x), sq_across = x.squaredNorm() - depth * depth;
    depth_sum += depth;
    sq_across_sum += sq_across;
    product_sum += depth * sq_across;
  }
  return product_sum * static_cast<double>(points.cols()) > depth_sum * sq_across_sum;
}

/// A scanner so far away that its rays are parallel leaves the same density from behind: then the bulge decides.
Eigen::Vector3d onItsSide(const PointsRef& points, const ScanDensity& density, const Eigen::Vector3d& best) {
  const Eigen::Vector3d center = density.ball().center, behind = 2.0 * center - best;
  const bool as_good = density.unexplained(behind) <= kAsGood * density.unexplained(best) + kAsGoodBeyond;
  return as_good && bulgesTowards(points, center, behind) ? behind : best;
}

/// The view from the place from which the points have the fewest layers, of those from which they may be seen at all.
/// Two or three flat pieces are as dense as seen from several places.
template <typename SeenFrom>
std::optional<InferredView> leastLayered(const PointsRef& points, const std::vector<Eigen::Vector3d>& places,
                                         const SeenFrom& seenFrom) {
  std::optional<InferredView> view;
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& place : places) {
    const double layered = layeredShare(points, place);
    if (layered >= least) continue;
    if (std::optional<Visibility> seen = seenFrom(place, kSurelyEven)) {
      view = {std::move(*seen), place, false};
      least = layered;
    }
  }
  return view;
}

}  // namespace

std::optional<InferredView> inferView(const PointsRef& points, const Eigen::Vector3d& stored) {
  if (points.cols() < kFewestPoints) return std::nullopt;
  const ScanDensity density(points);
  const std::optional<Eigen::Vector3d> best = density.bestViewpoint();
  if (!best) return std::nullopt;
  const double left = density.unexplained(*best);
  const auto leaves = [&](double share) {
    return left + ScanDensity::kLeastVariance < share * (density.variance() + ScanDensity::kLeastVariance);
  };
  if (!leaves(kMostUnexplained)) return std::nullopt;
  const double as_good = kAsGood * left + kAsGoodBeyond;
  const bool as_stored = density.unexplained(stored) <= as_good;
  const auto seenFrom = [&](const Eigen::Vector3d& position, double most_uneven) {
    const double by_patches = density.unexplainedByPatches(position);
    if (by_patches > most_uneven) return std::optional<Visibility>();
    const bool surely = by_patches <= kSurelyEven && leaves(kSurely);
    return spaceSeenFrom(points, position, surely ? kSureLimits : kLimits);
  };
  const Eigen::Vector3d position = as_stored ? stored : onItsSide(points, density, *best);
  std::optional<InferredView> view;
  if (std::optional<Visibility> seen = seenFrom(position, kMostUneven)) view = {std::move(*seen), position, as_stored};
  if (!view) view = leastLayered(points, density.viewpoints(std::min(as_good, kMostOfSeveral)), seenFrom);
  if (!view || isWire(points)) return std::nullopt;
  return view;
}

}  // namespace pcl_symmetry
