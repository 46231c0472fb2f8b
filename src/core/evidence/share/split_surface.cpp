#include "core/evidence/share/split_surface.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "core/evidence/share/surface_distance.h"
#include "core/geometry/point_samples.h"
#include "pcl_symmetry/core/distance_transform/gaussian_edt.h"

namespace pcl_symmetry {

SplitSurface::SplitSurface(const Points& points, std::uint64_t seed, int num_threads) {
  const Eigen::Index size = points.cols();
  std::vector<int> second = drawSamples(size, static_cast<int>(size / 2), seed), first;
  std::sort(second.begin(), second.end());
  const std::vector<int> all = allOf(size);
  std::set_difference(all.begin(), all.end(), second.begin(), second.end(), std::back_inserter(first));
  first_ = pointsAt(points, first);
  second_ = pointsAt(points, second);
  search_ = makeTreeSearch(second_);
  samples_.emplace(second_, localGeometry(second_, *search_, kNumSupportNeighbours, num_threads));
}

std::vector<float> SplitSurface::reflectedDistances(const ReflectionPlane& plane) const {
  Points reflected(3, first_.cols());
  for (Eigen::Index i = 0; i < first_.cols(); ++i)
    reflected.col(i) = plane.reflect(first_.col(i).cast<double>()).cast<float>();
  return distances(reflected);
}

double SplitSurface::ownScore(int num_cells, double sigma, const BoundingBall& ball, int num_threads) const {
  GaussianEdtOptions options;
  options.num_cells = num_cells;
  options.sigma = sigma;
  options.center = ball.center;
  options.radius = ball.radius;
  options.num_threads = num_threads;
  const GaussianEdt first(first_, options), second(second_, options);
  const double product = std::inner_product(first.values().begin(), first.values().end(), second.values().begin(), 0.0);
  const double half = product / std::sqrt(first.sqNorm() * second.sqNorm());
  return 0.5 * (1.0 + std::clamp(half, 0.0, 1.0));
}

std::vector<float> SplitSurface::distances(const Points& points) const {
  std::vector<int> closest;
  std::vector<float> sq_distances;
  search_->search(points, 1, closest, sq_distances);
  return surfaceDistances(points, closest, *samples_);
}

}  // namespace pcl_symmetry
