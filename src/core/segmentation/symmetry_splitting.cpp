#include "core/segmentation/symmetry_splitting.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/k_means.h"
#include "core/base/parallel.h"
#include "core/geometry/mesh_sampling.h"
#include "core/neighbours/surface_normals.h"
#include "core/segmentation/border_cut.h"
#include "pcl_symmetry/core/detection/local_maxima.h"
#include "pcl_symmetry/core/neighbours/closest_point_search.h"
#include "pcl_symmetry/core/refinement/iterative_symmetric_points.h"
#include "pcl_symmetry/core/transform/planar_transform.h"

namespace pcl_symmetry {

namespace {

constexpr int kNumSamples = 4000;  // of the surface of a part
constexpr int kNumRefined = 400;   // of them reflected by Iterative Symmetric Points
constexpr int kNumNormalNeighbours = 8;
constexpr double kSameAngle = 0.1, kSameOffset = 0.06;  // radians, radii: maxima that share one basin
constexpr float kMapped = 0.5f;                         // f from which on an element counts as mapped onto the surface

bool isNear(const ReflectionPlane& a, const ReflectionPlane& b, const Eigen::Vector3d& center, double radius) {
  const double sign = a.normal().dot(b.normal()) < 0.0 ? -1.0 : 1.0;
  return a.angleTo(b) < kSameAngle &&
         std::abs(a.signedDistance(center) - sign * b.signedDistance(center)) < kSameOffset * radius;
}

/// Strongest maxima of the map, one of each basin, refined on the samples.
std::vector<ReflectionPlane> refinedMaxima(const Points& samples, const GaussianEdt& edt,
                                           const SplittingOptions& options, std::uint64_t seed, int num_threads) {
  constexpr int kNumTheta = 32, kNumPhi = 128, kNumRadius = 64, kNumMapSamples = 64;
  const PlaneGrid grid(kNumTheta, kNumPhi, kNumRadius, edt.center(), edt.radius());
  PlanarTransformOptions transform;
  transform.sampled.num_samples = kNumMapSamples;
  transform.sampled.seed = seed;
  transform.sampled.num_threads = num_threads;
  LocalMaximaOptions significant;
  significant.strength = options.strength;
  significant.num_threads = num_threads;
  const SymmetryMap map = planarTransform(edt, grid, centerOfMass(samples), transform);
  std::vector<ReflectionPlane> starts;
  const auto isNew = [&](const ReflectionPlane& plane, const std::vector<ReflectionPlane>& known) {
    return std::none_of(known.begin(), known.end(),
                        [&](const ReflectionPlane& k) { return isNear(plane, k, edt.center(), edt.radius()); });
  };
  for (const LocalMaximum& maximum : findLocalMaxima(map, significant)) {
    if (static_cast<int>(starts.size()) == options.max_planes) break;
    if (isNew(maximum.plane, starts)) starts.push_back(maximum.plane);
  }

  const auto search = makeFlannSearch(samples);
  const LocalGeometry geometry = localGeometry(samples, *search, kNumNormalNeighbours, num_threads);
  IspSurface surface{samples, geometry.normals, *search};
  std::vector<int> reflected;
  const Eigen::Index stride = std::max<Eigen::Index>(1, samples.cols() / kNumRefined);
  for (Eigen::Index i = 0; i < samples.cols(); i += stride) reflected.push_back(static_cast<int>(i));
  IspOptions isp;
  isp.sigma = edt.sigma();
  isp.final_sigma = 0.5 * edt.sigma();
  std::vector<ReflectionPlane> refined(starts.size());
  parallelBlocks(starts.size(), num_threads, [&](std::size_t i) {
    const ReflectionPlane plane = refineSymmetricPoints(surface, reflected, starts[i], isp).plane;
    refined[i] = isNear(plane, starts[i], edt.center(), 2.0 * edt.radius()) ? plane : starts[i];
  });
  std::vector<ReflectionPlane> planes;
  for (const ReflectionPlane& plane : refined)
    if (isNew(plane, planes)) planes.push_back(plane.canonical());
  return planes;
}

/// The two pieces with the largest areas; -1 where there are not so many.
std::pair<int, int> largestPieces(const SurfaceGraph& graph, const std::vector<int>& pieces) {
  std::vector<double> areas(1 + *std::max_element(pieces.begin(), pieces.end()), 0.0);
  for (int i = 0; i < graph.size(); ++i)
    if (pieces[i] >= 0) areas[pieces[i]] += graph.areas[i];
  int first = -1, second = -1;
  for (int p = 0; p < static_cast<int>(areas.size()); ++p) {
    if (first < 0 || areas[p] > areas[first]) {
      second = first;
      first = p;
    } else if (second < 0 || areas[p] > areas[second]) {
      second = p;
    }
  }
  return {first, second};
}

}  // namespace

Points sampleElements(const SurfaceGraph& graph, const std::vector<int>& elements, int num_points, std::uint64_t seed) {
  std::vector<char> inside(static_cast<std::size_t>(graph.size()), 0);
  for (const int element : elements) inside[element] = 1;
  std::vector<Eigen::Vector3i> triangles;
  for (std::size_t t = 0; t < graph.triangles.size(); ++t)
    if (inside[graph.element_of_triangle[t]]) triangles.push_back(graph.triangles[t]);
  return sampleTriangles(graph.corners, triangles, num_points, seed);
}

SymmetryFeatures symmetryFeatures(const SurfaceGraph& graph, const std::vector<int>& elements,
                                  const SplittingOptions& options, std::uint64_t seed, int num_threads) {
  const Points samples = sampleElements(graph, elements, kNumSamples, seed);
  GaussianEdtOptions edt_options;
  edt_options.num_threads = num_threads;
  const GaussianEdt edt(samples, edt_options);
  SymmetryFeatures features;
  for (const ReflectionPlane& plane : refinedMaxima(samples, edt, options, seed, num_threads))
    features.planes.push_back({plane, 0.0});
  features.support.resize(static_cast<Eigen::Index>(features.planes.size()),
                          static_cast<Eigen::Index>(elements.size()));
  double area = 0.0;
  for (const int element : elements) area += graph.areas[element];
  parallelBlocks(features.planes.size(), num_threads, [&](std::size_t k) {
    PartPlane& plane = features.planes[k];
    double mapped = 0.0;
    for (std::size_t i = 0; i < elements.size(); ++i) {
      const Eigen::Vector3d center = graph.centers.col(elements[i]).cast<double>();
      const auto f = static_cast<float>(std::clamp(edt(plane.plane.reflect(center)), 0.0, 1.0));
      features.support(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) = f;
      if (f > kMapped) mapped += graph.areas[elements[i]];
    }
    plane.share = area > 0.0 ? mapped / area : 0.0;
  });
  return features;
}

std::optional<std::pair<std::vector<int>, std::vector<int>>> splitBySymmetry(const SurfaceGraph& graph,
                                                                             const std::vector<int>& elements,
                                                                             const SymmetryFeatures& features,
                                                                             const SplittingOptions& options,
                                                                             std::uint64_t seed) {
  std::vector<float> areas;
  for (const int element : elements) areas.push_back(graph.areas[element]);
  KMeansOptions two_means;
  two_means.seed = seed;
  const Clusters clusters = kMeans(features.support, areas, two_means);
  if (clusters.centers.cols() < 2) return std::nullopt;

  // Elements of other parts: -1. The second side begins as the second largest piece, the first as all others.
  std::vector<int> side(static_cast<std::size_t>(graph.size()), -1);
  for (std::size_t i = 0; i < elements.size(); ++i) side[elements[i]] = clusters.labels[i];
  const std::vector<int> pieces = connectedPieces(graph, side);
  const auto [first, second] = largestPieces(graph, pieces);
  if (second < 0) return std::nullopt;
  std::vector<int> open;
  for (const int element : elements) {
    side[element] = pieces[element] == second ? 1 : 0;
    if (pieces[element] != first && pieces[element] != second) open.push_back(element);
  }
  const BoundingBall ball = boundingBall(sampleElements(graph, elements, kNumSamples, seed));
  cutBorder(graph, side, open, options.cut_band * ball.radius, options.concavity_weight);
  std::pair<std::vector<int>, std::vector<int>> sides;
  for (const int element : elements) (side[element] == 0 ? sides.first : sides.second).push_back(element);
  if (sides.first.empty() || sides.second.empty()) return std::nullopt;
  return sides;
}

}  // namespace pcl_symmetry
