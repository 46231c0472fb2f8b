#include "pcl_symmetry/core/published_planes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/base/check.h"
#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/geometry/point_samples.h"
#include "core/refinement/iterative_symmetric_points.h"
#include "core/transform/sampled_transform.h"

namespace pcl_symmetry {

namespace {

/// Averages over the neighbors of each bin, weighted by the solid angle of the bins.
///
/// Voting leaves 7.6 votes per bin and, near the pole, single votes that weigh as much as a symmetry. Departure from
/// the paper: it searches for maxima in the unsmoothed map and applies its thresholds of 1/10 there.
SymmetryMap smoothed(const SymmetryMap& map, int num_threads) {
  const PlaneGrid& grid = map.grid;
  SymmetryMap result = map;
  parallelBlocks(grid.numDirections(), num_threads, [&](std::size_t direction) {
    for (int k = 0; k < grid.numRadius(); ++k) {
      const std::size_t index = direction * grid.numRadius() + k;
      double sum = 0.0, weights = 0.0;
      const auto add = [&](std::size_t i) {
        const double weight = std::sin(grid.theta(grid.bin(i).theta));
        sum += weight * map[i];
        weights += weight;
        return true;
      };
      add(index);
      grid.visitNeighbors(grid.bin(index), add);
      result.values[index] = static_cast<float>(sum / weights);
    }
  });
  return result;
}

/// The region of a maximum of the map: its bin, the neighbors that it is higher than (across borders and seams and
/// around the pole), and all bins whose steepest ascent ends at it.
///
/// This is our reading of "leaves its cell" (Section 4.4): the sentence protects against a refinement that runs to
/// another maximum. A peak near the border of a cell, or wider than the slivers at the pole, has its top in a neighbor.
class MaximumRegion {
public:
  MaximumRegion(const SymmetryMap& map, const PlaneGrid::Bin& bin) : map_(map), top_(map.grid.index(bin)) {}

  bool holds(const ReflectionPlane& plane) const {
    const auto cell = map_.grid.find(plane);
    if (!cell) return false;
    const std::size_t start = map_.grid.index(*cell);
    const bool is_neighbor = !map_.grid.visitNeighbors(map_.grid.bin(top_), [&](std::size_t i) { return i != start; });
    return is_neighbor || ascent(start) == top_;
  }

private:
  std::size_t ascent(std::size_t from) const {
    for (std::size_t highest = from;; from = highest) {
      map_.grid.visitNeighbors(map_.grid.bin(from), [&](std::size_t i) {
        if (map_[i] > map_[highest] || (map_[i] == map_[highest] && i < highest)) highest = i;
        return true;
      });
      if (highest == from) return from;
    }
  }

  const SymmetryMap& map_;
  std::size_t top_;
};

/// Keeps one plane per cell, if planes may not leave their cells: of planes that came from neighboring cells, only the
/// first.
void keepOneOfEachCell(std::vector<SymmetryPlane>& planes, const PlaneGrid& grid) {
  std::set<std::size_t> cells;
  const auto isKnown = [&](const SymmetryPlane& plane) {
    const auto cell = grid.find(plane);
    return cell && !cells.insert(grid.index(*cell)).second;
  };
  eraseIf(planes, isKnown);
}

}  // namespace

void PublishedOptions::validate() const {
  maxima.validate();
  check(num_points >= 10, "num_points", num_points, ">= 10");
  check(max_maxima >= 0, "max_maxima", max_maxima, ">= 0");
  check(max_iterations >= 1, "max_iterations", max_iterations, ">= 1");
  checkNumThreads(num_threads);
}

/// Section 4.4, step by step.
std::vector<SymmetryPlane> publishedPlanes(const PointsRef& points, const GaussianEdt& edt, const SymmetryMap& map,
                                           const PublishedOptions& options) {
  options.validate();
  const bool is_noisy = map.method == TransformMethod::Voting;
  const SymmetryMap even = is_noisy ? smoothed(smoothed(map, options.num_threads), options.num_threads) : SymmetryMap();
  const SymmetryMap& tabulated = is_noisy ? even : map;
  const ClosestPointSearch::Ptr search = makeFlannSearch(points);
  const Points surface_points = points, no_normals(3, 0);
  const FarTest far(edt, Eigen::Vector3d::Zero(), 1.0);
  const IspSurface surface{surface_points, no_normals, *search, nullptr, &far};
  std::vector<LocalMaximum> maxima = findLocalMaxima(tabulated, options.maxima, options.num_threads);
  if (options.max_maxima > 0 && maxima.size() > static_cast<std::size_t>(options.max_maxima))
    maxima.erase(maxima.begin() + options.max_maxima, maxima.end());
  std::vector<SymmetryPlane> refined(maxima.size());
  std::vector<char> is_stable(maxima.size());
  // The closed form, and weights of constant width.
  IspOptions published;
  published.update = IspUpdate::PointToPoint;
  published.sigma = published.final_sigma = edt.sigma();
  published.max_iterations = options.max_iterations;
  parallelBlocks(maxima.size(), options.num_threads, [&](std::size_t i) {
    IspOptions isp = published;
    const MaximumRegion region(tabulated, maxima[i].bin);
    const auto stays = [&](const ReflectionPlane& plane) { return !options.discard_unstable || region.holds(plane); };
    IspResult found;
    found.plane = maxima[i].plane;
    int iterations = 0;
    // Few points bring a plane near its end at little cost; all points determine where it ends.
    for (const int count : {std::min(1000, options.num_points), options.num_points}) {
      const std::vector<int> samples = drawSamples(points.cols(), count, options.seed + i);
      isp.settled_errors = count == options.num_points ? 0.5 : 0.1;
      found = refineSymmetricPoints(surface, samples, found.plane, isp, stays);
      iterations += found.iterations;
      if (!stays(found.plane)) return;
    }
    is_stable[i] = found.converged || !options.discard_unstable;
    refined[i] = SymmetryPlane(found.plane);
    refined[i].iterations = iterations;
    refined[i].converged = found.converged;
    refined[i].residual = found.last.residual;
    refined[i].support = found.last.weight;
    refined[i].score = correlation(edt, found.plane, 1);
    for (double* unmeasured : {&refined[i].share, &refined[i].share_low, &refined[i].share_high, &refined[i].deviation})
      *unmeasured = std::numeric_limits<double>::quiet_NaN();
  });
  std::vector<SymmetryPlane> planes;
  for (std::size_t i = 0; i < refined.size(); ++i)
    if (is_stable[i]) planes.push_back(refined[i]);
  sortDescending(planes, &SymmetryPlane::score);
  if (options.discard_unstable) keepOneOfEachCell(planes, map.grid);
  return planes;
}

SymmetryMap publishedMap(const PointsRef& points, const GaussianEdt& edt, TransformMethod method, std::uint64_t seed,
                         int num_threads) {
  constexpr int kNumBins = 64;
  PlanarTransformOptions options;
  options.method = method;
  options.setSeed(seed);
  options.setNumThreads(num_threads);
  const PlaneGrid grid(kNumBins, kNumBins, kNumBins, edt.center(), edt.radius());
  return planarTransform(edt, grid, centerOfMass(points), options);
}

}  // namespace pcl_symmetry
