#include "core/detection/matched_region.h"

#include <algorithm>
#include <boost/pending/disjoint_sets.hpp>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/detection/detection_rules.h"
#include "core/detection/plane_fit.h"
#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

namespace {

/// Edge of a flat disc: sum over its samples of the share of neighbors beyond the edge, over the root of their number.
/// K neighbors lie within rho = sqrt(k / pi) spacings. Of the neighbors of samples within rho of a straight edge, 2 rho
/// / (3 pi) per spacing of edge lie beyond it. A disc of n samples has an edge of 2 sqrt(pi n) spacings.
double edgeOfDisc() {
  const double reach = std::sqrt((kDetection.parts.num_smoothing + 1) / kPi);
  return 2.0 * reach / (3.0 * kPi) * 2.0 * std::sqrt(kPi);
}

}  // namespace

MatchedRegions::MatchedRegions(const NormalizedCloud& cloud, const PlaneFit& fit, std::uint64_t seed, int num_threads)
    : cloud_(cloud), fit_(fit), samples_(drawSamples(cloud.points.cols(), kDetection.parts.num_region_samples, seed)) {
  std::sort(samples_.begin(), samples_.end());
  const Points places = pointsAt(cloud.points, samples_);
  const ClosestPointSearch::Ptr search = makeFlannSearch(places);
  std::vector<float> sq_distances;
  const int num_neighbors = std::min<int>(kDetection.parts.num_smoothing + 1, static_cast<int>(samples_.size()));
  search->search(places, num_neighbors, neighbors_, sq_distances);
  closest_sample_.resize(static_cast<std::size_t>(cloud.points.cols()));
  parallelRanges(closest_sample_.size(), 1024, num_threads, [&](std::size_t begin, std::size_t end) {
    std::vector<int> closest;
    std::vector<float> ignored;
    const auto first = static_cast<Eigen::Index>(begin), count = static_cast<Eigen::Index>(end - begin);
    search->search(cloud_.points.middleCols(first, count), 1, closest, ignored);
    std::copy(closest.begin(), closest.end(), closest_sample_.begin() + static_cast<std::ptrdiff_t>(begin));
  });
}

MatchedRegion MatchedRegions::largest(const ReflectionPlane& plane, const std::vector<int>* guesses) const {
  IspStep step = matchReflectionsOnly(cloud_.surface, samples_, plane, cloud_.final_sigma, guesses);
  const std::vector<float> support = fit_.shares(plane, samples_, step).point_support;
  const std::size_t size = samples_.size(), num_neighbors = neighbors_.size() / size;
  std::vector<char> matched(size);
  for (std::size_t i = 0; i < size; ++i) {
    double sum = 0.0;
    for (std::size_t k = 0; k < num_neighbors; ++k) sum += support[neighbors_[i * num_neighbors + k]];
    matched[i] = sum >= kDetection.parts.matched_support * static_cast<double>(num_neighbors);
  }
  const std::vector<char> inside = inLargest(matched, step, support);
  MatchedRegion region;
  region.closest = std::move(step.closest);
  for (std::size_t i = 0; i < size; ++i) {
    if (!inside[i]) continue;
    region.points.push_back(samples_[i]);
    region.support += support[i];
  }
  if (region.points.empty()) return region;
  const auto count = static_cast<double>(region.points.size());
  region.share = count / static_cast<double>(size);
  region.support = std::min(1.0, region.support / (count * cloud_.baseline));
  region.edge = edgeOf(inside, count);
  return region;
}

/// Neighbors that match are in one region, and so are samples and what they are mapped to: two hands are a region of
/// the plane between them.
std::vector<char> MatchedRegions::inLargest(const std::vector<char>& matched, const IspStep& step,
                                            const std::vector<float>& support) const {
  const std::size_t size = samples_.size(), num_neighbors = neighbors_.size() / size;
  std::vector<int> rank(size, 0), parent(size);
  std::iota(parent.begin(), parent.end(), 0);
  boost::disjoint_sets<int*, int*> sets(rank.data(), parent.data());
  const std::size_t num_connecting = std::min<std::size_t>(kDetection.parts.num_connecting + 1, num_neighbors);
  for (std::size_t i = 0; i < size; ++i) {
    if (!matched[i]) continue;
    for (std::size_t k = 0; k < num_connecting; ++k) {
      const int j = neighbors_[i * num_neighbors + k];
      if (matched[j]) sets.union_set(static_cast<int>(i), j);
    }
    if (step.closest[i] < 0 || support[i] < kDetection.parts.counterpart) continue;
    const int j = closest_sample_[step.closest[i]];
    if (matched[j]) sets.union_set(static_cast<int>(i), j);
  }
  std::vector<int> count(size, 0);
  for (std::size_t i = 0; i < size; ++i)
    if (matched[i]) ++count[sets.find_set(static_cast<int>(i))];
  const auto largest = static_cast<int>(std::max_element(count.begin(), count.end()) - count.begin());
  std::vector<char> inside(size, 0);
  for (std::size_t i = 0; i < size; ++i) inside[i] = matched[i] && sets.find_set(static_cast<int>(i)) == largest;
  return inside;
}

double MatchedRegions::edgeOf(const std::vector<char>& inside, double count) const {
  const std::size_t size = samples_.size(), num_neighbors = neighbors_.size() / size;
  std::size_t num_beyond = 0;
  for (std::size_t i = 0; i < size; ++i) {
    if (!inside[i]) continue;
    for (std::size_t k = 0; k < num_neighbors; ++k) num_beyond += inside[neighbors_[i * num_neighbors + k]] ? 0 : 1;
  }
  const double share = static_cast<double>(num_beyond) / static_cast<double>(num_neighbors);
  return share / (std::sqrt(count) * edgeOfDisc());
}

}  // namespace pcl_symmetry
