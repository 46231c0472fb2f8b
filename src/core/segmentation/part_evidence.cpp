#include "core/segmentation/part_evidence.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/constants.h"
#include "core/base/random.h"
#include "core/base/statistics.h"
#include "core/geometry/point_samples.h"
#include "core/segmentation/segmentation_rules.h"
#include "pcl_symmetry/core/closest_point_search.h"

namespace pcl_symmetry {

namespace {

struct SurfacePoint {
  Eigen::Vector3f position, normal;
  float reach;  ///< input units; rays from the point begin at this distance
};

/// Points spread over each patch by area, one in each of equal shares. The points of a cloud are used themselves.
std::vector<std::vector<SurfacePoint>> samplePatches(const SurfaceGraph& graph, const Patches& patches, float radius,
                                                     std::uint64_t seed) {
  RandomStream random(seed);
  const double whole = graph.area();
  std::vector<double> step(patches.areas.size()), next(step.size()), so_far(step.size(), 0.0);
  for (std::size_t p = 0; p < step.size(); ++p) {
    step[p] = patches.areas[p] * whole / kSegmentation.samples_of_patch;
    next[p] = random.uniform() * step[p];
  }
  std::vector<std::vector<SurfacePoint>> samples(step.size());
  for (std::size_t t = 0; t < graph.triangles.size(); ++t) {
    const int element = graph.element_of_triangle[t], p = patches.of_element[element];
    const auto corner = [&](int k) -> Eigen::Vector3f { return graph.corners.col(graph.triangles[t][k]); };
    const Eigen::Vector3f u = corner(1) - corner(0), v = corner(2) - corner(0);
    so_far[p] += graph.is_cloud ? graph.areas[element] : 0.5 * u.cross(v).norm();
    for (; step[p] > 0.0 && next[p] < so_far[p]; next[p] += step[p]) {
      SurfacePoint sample{graph.centers.col(element), graph.normals.col(element), kSegmentation.min_reach * radius};
      if (graph.is_cloud) {
        sample.reach = std::max(kSegmentation.cloud_reach * std::sqrt(graph.areas[element]), sample.reach);
      } else {
        const auto root = static_cast<float>(std::sqrt(random.uniform())), share = static_cast<float>(random.uniform());
        sample.position = corner(0) + root * ((1.0f - share) * u + share * v);
      }
      samples[p].push_back(sample);
    }
  }
  return samples;
}

/// Directions in a cone about the inward normal, one in each of kSegmentation.rays_of_sample sectors.
std::vector<Eigen::Vector3f> inwardDirections(const Eigen::Vector3f& normal, RandomStream& random) {
  const Eigen::Vector3f u = normal.unitOrthogonal(), v = normal.cross(u);
  std::vector<Eigen::Vector3f> directions;
  for (int k = 0; k < kSegmentation.rays_of_sample; ++k) {
    const double around = 2.0 * kPi * (k + random.uniform()) / kSegmentation.rays_of_sample;
    const double tilt = std::tan(kSegmentation.cone_angle) * std::sqrt(random.uniform());
    const Eigen::Vector3f aside =
        static_cast<float>(tilt * std::cos(around)) * u + static_cast<float>(tilt * std::sin(around)) * v;
    directions.push_back((aside - normal).normalized());
  }
  return directions;
}

/// Median length of the rays from the samples of a patch, input units; 0 if none met another side.
float depthBehind(const std::vector<SurfacePoint>& samples, const TriangleTree& tree, RandomStream& random) {
  std::vector<float> distances;
  for (const SurfacePoint& sample : samples) {
    for (const Eigen::Vector3f& inward : inwardDirections(sample.normal, random)) {
      const RayHit hit = tree.closest(sample.position, inward, sample.reach);
      if (hit.triangle >= 0) distances.push_back(hit.distance);
    }
  }
  return distances.empty() ? 0.0f : static_cast<float>(median(std::move(distances)));
}

/// The position half-way through the body behind the sample that is closest to the center of its patch.
Eigen::Vector3f innerPosition(const std::vector<SurfacePoint>& samples, const Eigen::Vector3f& center, float depth,
                              const TriangleTree& tree) {
  const SurfacePoint& middle = *std::min_element(samples.begin(), samples.end(), [&](const auto& a, const auto& b) {
    return (a.position - center).squaredNorm() < (b.position - center).squaredNorm();
  });
  depth = std::min(depth, tree.closest(middle.position, -middle.normal, middle.reach).distance);
  return middle.position - 0.5f * depth * middle.normal;
}

Eigen::MatrixXf linesOfSight(const Points& positions, const TriangleTree& tree) {
  const Eigen::Index size = positions.cols();
  Eigen::MatrixXf sight = Eigen::MatrixXf::Identity(size, size);
  for (Eigen::Index from = 0; from < size; ++from)
    for (Eigen::Index to = 0; to < from; ++to)
      sight(to, from) = tree.blocks(positions.col(from), positions.col(to)) ? 0.0f : 1.0f;
  sight.triangularView<Eigen::StrictlyLower>() = sight.transpose();
  return sight;
}

/// Sets thickness and sight by rays through the body behind each patch.
void measureBody(const SurfaceGraph& graph, const TriangleTree& tree, std::uint64_t seed, PartEvidence& evidence) {
  const Patches& patches = evidence.patches;
  const auto radius = static_cast<float>(boundingBall(graph.centers).radius);
  const auto samples = samplePatches(graph, patches, radius, seed);
  Points inner = patches.centers;
  for (std::size_t p = 0; p < samples.size(); ++p) {
    if (samples[p].empty()) continue;
    RandomStream random(seed, p);
    const float depth = depthBehind(samples[p], tree, random);
    const auto column = static_cast<Eigen::Index>(p);
    evidence.thickness[p] = depth / radius;
    inner.col(column) = innerPosition(samples[p], patches.centers.col(column), depth, tree);
  }
  evidence.sight = linesOfSight(inner, tree);
}

/// Means of the support of the elements of each patch, weighted by area.
Eigen::MatrixXf supportOfPatches(const SurfaceGraph& graph, const Patches& patches, const Eigen::MatrixXf& support) {
  Eigen::MatrixXf means = Eigen::MatrixXf::Zero(support.rows(), patches.size());
  const double whole = graph.area();
  for (int i = 0; i < graph.size(); ++i) {
    const int p = patches.of_element[i];
    if (patches.areas[p] > 0.0)
      means.col(p) += static_cast<float>(graph.areas[i] / (whole * patches.areas[p])) * support.col(i);
  }
  return means;
}

/// For each plane that maps enough of the surface onto itself, the patch at the reflection of the center of each patch.
std::vector<std::vector<int>> imagesOfPatches(const Patches& patches, const std::vector<PartPlane>& planes) {
  std::vector<std::vector<int>> images;
  const auto search = makeFlannSearch(patches.centers);
  for (const PartPlane& plane : planes) {
    if (plane.share < kMappedShare) continue;
    images.push_back(search->closest(reflectedPoints(patches.centers, plane.plane)));
  }
  return images;
}

/// The element from which the first patch of a division grows, drawn by area; -1 for the first division: the default
/// one.
int firstSeed(const SurfaceGraph& graph, int division, std::uint64_t seed) {
  if (division == 0) return -1;
  double left = RandomStream(seed).uniform() * graph.area();
  int element = 0;
  while (element + 1 < graph.size() && (left -= graph.areas[element]) > 0.0) ++element;
  return element;
}

}  // namespace

WholeEvidence::WholeEvidence(const SurfaceGraph& graph, const SegmentationOptions& options)
    : graph_(graph),
      seed_(options.seed),
      features_(symmetryFeatures(graph, allIndices(graph.size()), options, options.seed)) {
  if (options.evidence == MergingEvidence::All) tree_.emplace(graph.corners, graph.triangles);
}

PartEvidence WholeEvidence::ofDivision(int division) const {
  const std::uint64_t seed = seed_ + static_cast<std::uint64_t>(division);
  PartEvidence evidence;
  evidence.patches = measuredPatches(
      graph_,
      growPatches(graph_, kSegmentation.num_patches, kSegmentation.concave_detour, firstSeed(graph_, division, seed)));
  evidence.borders = patchBorders(graph_, evidence.patches);
  evidence.thickness.assign(evidence.patches.areas.size(), 0.0);
  evidence.sight.setIdentity(evidence.size(), evidence.size());
  if (tree_) measureBody(graph_, *tree_, seed, evidence);
  evidence.planes = features_.planes;
  evidence.support = supportOfPatches(graph_, evidence.patches, features_.support);
  evidence.images = imagesOfPatches(evidence.patches, evidence.planes);
  return evidence;
}

}  // namespace pcl_symmetry
