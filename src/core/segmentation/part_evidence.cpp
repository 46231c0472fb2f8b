#include "core/segmentation/part_evidence.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/neighbours/triangle_tree.h"
#include "core/segmentation/symmetry_splitting.h"
#include "core/surface/surface_patches.h"
#include "pcl_symmetry/core/neighbours/closest_point_search.h"

namespace pcl_symmetry {

namespace {

constexpr float kConcaveDetour = 4.0f;  // of the growing patches, per radian
constexpr int kSamplesOfPatch = 6, kRaysOfSample = 6;
constexpr double kConeAngle = 0.61;   // radians: rays for the thickness lie within, as of the shape diameter
constexpr float kLeastReach = 1e-4f;  // radii: rays begin so far from the surface
constexpr float kCloudReach = 2.5f;   // sqrt(area of a point): triangles about neighbouring points overlap

struct SurfacePoint {
  Eigen::Vector3f position, normal;
  float reach;  ///< of rays that begin here
};

/// Points of each patch, by area.
std::vector<std::vector<SurfacePoint>> samplePatches(const SurfaceGraph& graph, const PartEvidence& evidence,
                                                     std::uint64_t seed) {
  RandomStream random(seed);
  const double whole = graph.area();
  std::vector<double> step(evidence.areas.size()), next(step.size()), so_far(step.size(), 0.0);
  for (std::size_t p = 0; p < step.size(); ++p) {
    step[p] = evidence.areas[p] * whole / kSamplesOfPatch;
    next[p] = random.uniform() * step[p];
  }
  std::vector<std::vector<SurfacePoint>> samples(step.size());
  for (std::size_t t = 0; t < graph.triangles.size(); ++t) {
    const int element = graph.element_of_triangle[t], p = evidence.patch[element];
    const auto corner = [&](int k) -> Eigen::Vector3f { return graph.corners.col(graph.triangles[t][k]); };
    const Eigen::Vector3f u = corner(1) - corner(0), v = corner(2) - corner(0);
    so_far[p] += graph.is_cloud ? graph.areas[element] : 0.5 * u.cross(v).norm();
    for (; step[p] > 0.0 && next[p] < so_far[p]; next[p] += step[p]) {
      SurfacePoint sample{graph.centers.col(element), graph.normals.col(element), 0.0f};
      if (graph.is_cloud) {
        sample.reach = kCloudReach * std::sqrt(graph.areas[element]);
      } else {
        const auto root = static_cast<float>(std::sqrt(random.uniform())), share = static_cast<float>(random.uniform());
        sample.position = corner(0) + root * ((1.0f - share) * u + share * v);
      }
      samples[p].push_back(sample);
    }
  }
  return samples;
}

void measurePatches(const SurfaceGraph& graph, PartEvidence& evidence) {
  const int size = *std::max_element(evidence.patch.begin(), evidence.patch.end()) + 1;
  const double whole = graph.area();
  evidence.areas.assign(static_cast<std::size_t>(size), 0.0);
  Eigen::Matrix3Xd centers = Eigen::Matrix3Xd::Zero(3, size), normals = centers;
  for (int i = 0; i < graph.size(); ++i) {
    const double area = graph.areas[i] / whole;
    evidence.areas[evidence.patch[i]] += area;
    centers.col(evidence.patch[i]) += area * graph.centers.col(i).cast<double>();
    normals.col(evidence.patch[i]) += area * graph.normals.col(i).cast<double>();
  }
  for (int p = 0; p < size; ++p)
    if (evidence.areas[p] > 0.0) centers.col(p) /= evidence.areas[p];
  evidence.centers = centers.cast<float>();
  for (int p = 0; p < size; ++p) normals.col(p) = normals.col(p).stableNormalized();
  evidence.normals = normals.cast<float>();
}

void measureBorders(const SurfaceGraph& graph, PartEvidence& evidence) {
  std::map<std::pair<int, int>, PatchBorder> borders;
  for (const SurfaceGraph::Edge& edge : graph.edges) {
    const auto ends = std::minmax(evidence.patch[edge.from], evidence.patch[edge.to]);
    if (ends.first == ends.second) continue;
    PatchBorder& border = borders.insert({ends, {ends.first, ends.second, 0.0, 0.0, 0.0}}).first->second;
    border.length += edge.length;
    border.edge_concavity += static_cast<double>(edge.length) * edge.concavity;
  }
  for (auto& [ends, border] : borders) {
    if (border.length > 0.0) border.edge_concavity /= border.length;
    const Eigen::Vector3f step = evidence.centers.col(border.to) - evidence.centers.col(border.from);
    const Eigen::Vector3f turn = evidence.normals.col(border.from) - evidence.normals.col(border.to);
    border.patch_concavity = turn.dot(step.stableNormalized());
    evidence.borders.push_back(border);
  }
}

/// Thickness behind each patch, and from the places half-way through the body what sees what.
void lookThroughBody(const SurfaceGraph& graph, std::uint64_t seed, int num_threads, PartEvidence& evidence) {
  const TriangleTree tree(graph.corners, graph.triangles);
  const auto samples = samplePatches(graph, evidence, seed);
  const auto radius = static_cast<float>(boundingBall(graph.centers).radius);
  const int size = evidence.size();
  evidence.thickness.assign(static_cast<std::size_t>(size), 0.0);
  Points inner = evidence.centers;
  parallelBlocks(static_cast<std::size_t>(size), num_threads, [&](std::size_t p) {
    if (samples[p].empty()) return;
    RandomStream random(seed, p);
    std::vector<float> distances;
    const SurfacePoint* middle = &samples[p].front();
    const auto off_center = [&](const SurfacePoint& s) { return (s.position - evidence.centers.col(p)).squaredNorm(); };
    for (const SurfacePoint& sample : samples[p]) {
      if (off_center(sample) < off_center(*middle)) middle = &sample;
      const Eigen::Vector3f u = sample.normal.unitOrthogonal(), v = sample.normal.cross(u);
      for (int k = 0; k < kRaysOfSample; ++k) {
        const double around = 2.0 * M_PI * (k + random.uniform()) / kRaysOfSample;
        const double tilt = std::tan(kConeAngle) * std::sqrt(random.uniform());
        const Eigen::Vector3f aside =
            static_cast<float>(tilt * std::cos(around)) * u + static_cast<float>(tilt * std::sin(around)) * v;
        const Eigen::Vector3f inward = (aside - sample.normal).normalized();
        const RayHit hit = tree.closest(sample.position, inward, std::max(sample.reach, kLeastReach * radius));
        if (hit.triangle >= 0) distances.push_back(hit.distance);
      }
    }
    float depth = 0.0f;
    if (!distances.empty()) {
      const auto half = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
      std::nth_element(distances.begin(), half, distances.end());
      depth = *half;
      evidence.thickness[p] = depth / radius;
    }
    const float reach = std::max(middle->reach, kLeastReach * radius);
    depth = std::min(depth, tree.closest(middle->position, -middle->normal, reach).distance);
    inner.col(static_cast<Eigen::Index>(p)) = middle->position - 0.5f * depth * middle->normal;
  });
  evidence.sight = Eigen::MatrixXf::Identity(size, size);
  parallelBlocks(static_cast<std::size_t>(size), num_threads, [&](std::size_t i) {
    const auto from = static_cast<Eigen::Index>(i);
    for (Eigen::Index to = 0; to < from; ++to)
      evidence.sight(to, from) = tree.blocks(inner.col(from), inner.col(to)) ? 0.0f : 1.0f;
  });
  evidence.sight.triangularView<Eigen::StrictlyLower>() = evidence.sight.transpose();
}

void measureSymmetry(const SurfaceGraph& graph, const SegmentationOptions& options, PartEvidence& evidence) {
  std::vector<int> all(static_cast<std::size_t>(graph.size()));
  std::iota(all.begin(), all.end(), 0);
  const SymmetryFeatures features = symmetryFeatures(graph, all, options.splitting, options.seed, options.num_threads);
  const int size = evidence.size();
  evidence.planes = features.planes;
  evidence.support = Eigen::MatrixXf::Zero(features.support.rows(), size);
  const double whole = graph.area();
  for (int i = 0; i < graph.size(); ++i) {
    const int p = evidence.patch[i];
    if (evidence.areas[p] > 0.0)
      evidence.support.col(p) +=
          static_cast<float>(graph.areas[i] / (whole * evidence.areas[p])) * features.support.col(i);
  }
  const auto search = makeFlannSearch(evidence.centers);
  for (const PartPlane& plane : evidence.planes) {
    if (plane.share < kMappedShare) continue;
    Points reflected(3, size);
    for (int p = 0; p < size; ++p)
      reflected.col(p) = plane.plane.reflect(evidence.centers.col(p).cast<double>()).cast<float>();
    std::vector<float> sq_distances;
    search->search(reflected, 1, evidence.images.emplace_back(), sq_distances);
  }
}

}  // namespace

PartEvidence partEvidence(const SurfaceGraph& graph, const SegmentationOptions& options) {
  PartEvidence evidence;
  const bool concave = options.merging.evidence != MergingEvidence::Symmetry;
  evidence.patch = growPatches(graph, options.merging.num_patches, concave ? kConcaveDetour : 0.0f);
  measurePatches(graph, evidence);
  measureBorders(graph, evidence);
  if (options.merging.evidence == MergingEvidence::All) {
    lookThroughBody(graph, options.seed, options.num_threads, evidence);
  } else {
    evidence.thickness.assign(evidence.areas.size(), 0.0);
    evidence.sight = Eigen::MatrixXf::Identity(evidence.size(), evidence.size());
  }
  measureSymmetry(graph, options, evidence);
  return evidence;
}

}  // namespace pcl_symmetry
