#include "pcl_symmetry/core/published_planes.h"

#include <algorithm>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/geometry/point_samples.h"
#include "core/transform/edt_correlation.h"
#include "pcl_symmetry/core/iterative_symmetric_points.h"

namespace pcl_symmetry {

void PublishedOptions::validate() const {
  maxima.validate();
  check(num_points >= 10, "num_points", num_points, ">= 10");
  check(max_maxima >= 0, "max_maxima", max_maxima, ">= 0");
  check(max_iterations >= 1, "max_iterations", max_iterations, ">= 1");
  checkNumThreads(num_threads);
}

/// Section 4.4 from top to bottom.
std::vector<SymmetryPlane> publishedPlanes(const PointsRef& points, const GaussianEdt& edt, const SymmetryMap& map,
                                           const PublishedOptions& options) {
  options.validate();
  const ClosestPointSearch::Ptr search = makeFlannSearch(points);
  const Points surface_points = points, no_normals(3, 0);
  const IspSurface surface{surface_points, no_normals, *search};
  IspOptions isp;
  isp.update = IspUpdate::PointToPoint;
  isp.sigma = isp.final_sigma = edt.sigma();
  isp.max_iterations = options.max_iterations;
  std::vector<LocalMaximum> maxima = findLocalMaxima(map, options.maxima, options.num_threads);
  if (options.max_maxima > 0 && maxima.size() > static_cast<std::size_t>(options.max_maxima))
    maxima.erase(maxima.begin() + options.max_maxima, maxima.end());
  std::vector<SymmetryPlane> refined(maxima.size());
  std::vector<char> is_stable(maxima.size());
  parallelBlocks(maxima.size(), options.num_threads, [&](std::size_t i) {
    const std::vector<int> samples = drawSamples(points.cols(), options.num_points, options.seed + i);
    const IspResult end = refineSymmetricPoints(surface, samples, maxima[i].plane, isp);
    const auto cell = map.grid.find(end.plane);
    is_stable[i] = cell && map.grid.index(*cell) == map.grid.index(maxima[i].bin);
    refined[i] = SymmetryPlane(end.plane);
    refined[i].iterations = end.iterations;
    refined[i].converged = end.converged;
    refined[i].residual = end.last.residual;
    refined[i].support = end.last.weight;
    refined[i].score = correlation(edt, end.plane, 1);
  });
  std::vector<SymmetryPlane> planes;
  for (std::size_t i = 0; i < refined.size(); ++i)
    if (is_stable[i] || !options.discard_unstable) planes.push_back(refined[i]);
  std::stable_sort(planes.begin(), planes.end(), [](const auto& a, const auto& b) { return a.score > b.score; });
  return planes;
}

SymmetryMap publishedMap(const PointsRef& points, const GaussianEdt& edt, TransformMethod method, std::uint64_t seed,
                         int num_threads) {
  constexpr int kNumBins = 64;
  PlanarTransformOptions options;
  options.method = method;
  options.voting.near_distance = 0.0;
  options.setSeed(seed);
  options.setNumThreads(num_threads);
  const PlaneGrid grid(kNumBins, kNumBins, kNumBins, edt.center(), edt.radius());
  return planarTransform(edt, grid, centerOfMass(points), options);
}

}  // namespace pcl_symmetry
