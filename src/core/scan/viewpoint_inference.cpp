#include "core/scan/viewpoint_inference.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/geometry/point_samples.h"
#include "core/geometry/surface_normals.h"
#include "core/scan/range_image.h"
#include "core/scan/scan_density.h"
#include "core/scan/scan_rules.h"
#include "pcl_symmetry/core/closest_point_search.h"

namespace pcl_symmetry {

namespace {

// Stricter than for stored viewpoints: two scans put together pass those limits half as often again.
constexpr SingleViewLimits kLimits{0.12, 0.15};
// The same if a viewpoint explains nearly all of the variance of the density: leaves and wires lie in layers even from
// the true viewpoint.
constexpr SingleViewLimits kSureLimits{kScan.max_hidden, 0.4};

/// Whether all points are at a border, as in a wire, whose density is uninformative and which rays from everywhere meet
/// once.
bool isWire(const PointsRef& points) {
  const Points drawn = pointsAt(points, drawSamples(points.cols(), kScan.border_samples, 1));
  const ClosestPointSearch::Ptr search = makeFlannSearch(drawn);
  const LocalGeometry geometry = localGeometry(drawn, *search, 1);
  return shareNearBorders(openBorders(drawn, *search, geometry.normals, 1), geometry) > kScan.wire;
}

/// Decides between the two sides by the bulge of the surface: a scanner so far away that its rays are parallel leaves
/// the same density from behind.
Eigen::Vector3d onItsSide(const ScanDensity& density, const Eigen::Vector3d& best) {
  const Eigen::Vector3d center = density.ball().center, opposite = 2.0 * center - best;
  const Eigen::Vector3d far = center + kScan.greatest_distance * density.ball().radius * (center - best).normalized();
  const Eigen::Vector3d& behind = density.unexplained(far) < density.unexplained(opposite) ? far : opposite;
  const bool as_good = density.unexplained(behind) <= kScan.as_good * density.unexplained(best) + kScan.as_good_beyond;
  return as_good && !density.bulgesToward(best) ? behind : best;
}

/// The view from the position with the fewest layers, among those from which the points may be seen at all. Two or
/// three flat pieces have the density of views from several positions.
template <typename SeenFrom>
std::optional<InferredView> leastLayered(const PointsRef& points, const ScanDensity& density, double max_unexplained,
                                         const SeenFrom& seenFrom) {
  std::optional<InferredView> view;
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& best : density.viewpoints(max_unexplained)) {
    for (const Eigen::Vector3d& position : {onItsSide(density, best), best}) {
      const double layered = layeredShare(points, position);
      if (layered >= least) continue;
      if (std::optional<Visibility> seen = seenFrom(position, kScan.surely_even)) {
        view = {std::move(*seen), position, false};
        least = layered;
      }
    }
  }
  return view;
}

}  // namespace

std::optional<InferredView> inferView(const PointsRef& points, const Eigen::Vector3d& stored, bool may_be_default) {
  if (!may_be_default)
    if (std::optional<Visibility> seen = spaceSeenFrom(points, stored))
      return InferredView{std::move(*seen), stored, true};
  if (points.cols() < kScan.fewest_points) return std::nullopt;
  const ScanDensity density(points);
  const std::optional<Eigen::Vector3d> best = density.bestViewpoint();
  if (!best) return std::nullopt;
  const double left = density.unexplained(*best);
  const auto leaves = [&](double share) {
    return left + kScan.min_variance < share * (density.variance() + kScan.min_variance);
  };
  if (!leaves(kScan.max_unexplained)) return std::nullopt;
  // Few points leave much to chance, but chance never distributes them as evenly as a scanner does.
  const bool surely =
      left + kScan.min_variance <
      kScan.surely_explained * std::min(density.variance() + kScan.min_variance, density.varianceAtRandom());
  const double as_good = kScan.as_good * left + kScan.as_good_beyond;
  const bool as_stored = density.unexplained(stored) <= as_good;
  const auto seenFrom = [&](const Eigen::Vector3d& position, double max_uneven) {
    const double by_patches = density.unexplainedByPatches(position);
    if (by_patches > max_uneven) return std::optional<Visibility>();
    return spaceSeenFrom(points, position, by_patches <= kScan.surely_even && surely ? kSureLimits : kLimits);
  };
  const Eigen::Vector3d position = as_stored ? stored : onItsSide(density, *best);
  std::optional<InferredView> view;
  if (std::optional<Visibility> seen = seenFrom(position, kScan.max_uneven))
    view = {std::move(*seen), position, as_stored};
  if (!view) view = leastLayered(points, density, std::min(as_good, kScan.max_of_several), seenFrom);
  if (!view || (!surely && isWire(points))) return std::nullopt;
  return view;
}

}  // namespace pcl_symmetry
