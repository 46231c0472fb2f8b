#include "core/segmentation/part_evidence.h"

#include <algorithm>

#include "core/base/options.h"
#include "core/base/parallel.h"
#include "core/geometry/geometry_rules.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/surface_normals.h"
#include "core/geometry/triangles.h"
#include "core/refinement/iterative_symmetric_points.h"
#include "core/segmentation/segmentation_rules.h"
#include "pcl_symmetry/core/closest_point_search.h"
#include "pcl_symmetry/core/planar_transform.h"
#include "pcl_symmetry/core/published_planes.h"
#include "pcl_symmetry/core/symmetry_map.h"

namespace pcl_symmetry {

namespace {

/// Points spread over elements by area.
Points sampleElements(const SurfaceGraph& graph, const std::vector<int>& elements, std::uint64_t seed) {
  std::vector<char> inside(graph.size(), 0);
  for (const int element : elements) inside[element] = 1;
  std::vector<Eigen::Vector3i> triangles;
  for (std::size_t t = 0; t < graph.triangles.size(); ++t)
    if (inside[graph.element_of_triangle[t]]) triangles.push_back(graph.triangles[t]);
  return sampleTriangles(graph.corners, triangles, kSegmentation.feature_samples, seed);
}

/// Transforms planes to the ball that a distance transform covers.
auto intoBall(const GaussianEdt& edt) {
  return [&edt](const ReflectionPlane& plane) { return plane.normalized(edt.center(), edt.radius()); };
}

/// The strongest significant maxima of the transform, one for each basin (Section 4.4).
std::vector<ReflectionPlane> significantMaxima(const Points& samples, const GaussianEdt& edt, std::uint64_t seed,
                                               int num_threads) {
  const PlaneGrid grid(kSegmentation.map_size, edt.center(), edt.radius());
  SymmetryMap map = sampledTransform(edt, grid, {kSegmentation.num_map_samples, seed, num_threads});
  map.center_of_mass = centerOfMass(samples);
  std::vector<ReflectionPlane> maxima;
  for (const LocalMaximum& maximum : findLocalMaxima(map, {}, num_threads)) maxima.push_back(maximum.plane);
  return kSameMaximum.distinct(std::move(maxima), intoBall(edt), kSegmentation.max_planes);
}

/// Refines planes by Iterative Symmetric Points (Section 4.4). Departure from the paper: a plane that leaves its basin
/// keeps its start.
std::vector<ReflectionPlane> refinePlanes(const std::vector<ReflectionPlane>& starts, const Points& samples,
                                          const GaussianEdt& edt, const SegmentationOptions& options) {
  const ClosestPointSearch::Ptr search = options.make_search ? options.make_search(samples) : makeFlannSearch(samples);
  const int num_threads = options.num_threads;
  const LocalGeometry geometry = localGeometry(samples, *search, num_threads);
  IspSurface surface{samples, geometry.normals, *search};
  const std::vector<int> reflected =
      everyNth(samples.cols(), std::max<Eigen::Index>(1, samples.cols() / kSegmentation.refined_samples));
  IspOptions isp;
  isp.sigma = edt.sigma();
  isp.final_sigma = kSegmentation.final_sigma * edt.sigma();
  const MergeTolerance same_basin{kSameMaximum.angle, 2.0 * kSameMaximum.offset};
  const auto in_ball = intoBall(edt);
  std::vector<ReflectionPlane> moved(starts.size());
  parallelBlocks(starts.size(), num_threads, [&](std::size_t i) {
    const ReflectionPlane end = refineSymmetricPoints(surface, reflected, starts[i], isp).plane;
    moved[i] = same_basin.same(in_ball(end), in_ball(starts[i])) ? end : starts[i];
  });
  moved = kSameMaximum.distinct(std::move(moved), in_ball);
  for (ReflectionPlane& plane : moved) plane = plane.canonical();
  return moved;
}

}  // namespace

SymmetryFeatures symmetryFeatures(const SurfaceGraph& graph, const std::vector<int>& elements,
                                  const SegmentationOptions& options, std::uint64_t seed) {
  const int num_threads = options.num_threads;
  const Points samples = sampleElements(graph, elements, seed);
  const GaussianEdt edt(samples, {GaussianEdtOptions().num_cells, 0.0, num_threads});
  SymmetryFeatures features;
  features.radius = boundingBall(samples).radius;
  if (options.splitting.as_published) {
    const SymmetryMap map = publishedMap(samples, edt, TransformMethod::Convolution, seed, num_threads);
    auto published = optionsWith<PublishedOptions>(seed, num_threads);
    published.num_points = kSegmentation.published_samples;
    for (const SymmetryPlane& plane : publishedPlanes(samples, edt, map, published))
      features.planes.push_back({plane, 0.0});
  } else {
    const std::vector<ReflectionPlane> maxima = significantMaxima(samples, edt, seed, num_threads);
    for (const ReflectionPlane& plane : refinePlanes(maxima, samples, edt, options))
      features.planes.push_back({plane, 0.0});
  }
  features.support.resize(features.planes.size(), static_cast<Eigen::Index>(elements.size()));
  double area = 0.0;
  for (const int element : elements) area += graph.areas[element];
  parallelBlocks(features.planes.size(), num_threads, [&](std::size_t k) {
    PartPlane& plane = features.planes[k];
    double mapped = 0.0;
    for (std::size_t i = 0; i < elements.size(); ++i) {
      const Eigen::Vector3d center = graph.centers.col(elements[i]).cast<double>();
      const auto f = static_cast<float>(std::clamp(edt(plane.plane.reflect(center)), 0.0, 1.0));
      features.support(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) = f;
      if (f > kSegmentation.mapped) mapped += graph.areas[elements[i]];
    }
    plane.share = area > 0.0 ? mapped / area : 0.0;
  });
  return features;
}

}  // namespace pcl_symmetry
