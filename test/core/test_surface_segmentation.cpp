#include "pcl_symmetry/core/surface_segmentation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <stdexcept>

#include "meshes.h"

namespace pcl_symmetry {
namespace {

using test::Mesh;

SegmentationOptions splittingTo(int depth) {
  SegmentationOptions options;
  options.method = SegmentationMethod::Splitting;
  options.splitting.depth = depth;
  return options;
}

/// A box of 12 x 8 x 8 with a handle on one side: nearly symmetric, but for the handle.
Mesh mug() {
  return test::voxelMesh(20, [](int x, int y, int z) {
    if (x < 12) return y < 8 && z < 8;
    const bool bar = z >= 3 && z < 5 && y >= 1 && y < 7;
    return x < 18 && bar && (y < 3 || y >= 5 || x >= 16);
  });
}

/// Every node has two children whose segments are its own, or is a leaf.
void expectTreeOf(const Segmentation& segmentation) {
  std::set<int> leaves;
  for (std::size_t i = 0; i < segmentation.tree.size(); ++i) {
    const SegmentNode& node = segmentation.tree[i];
    EXPECT_EQ(node.parent < 0, i == 0);
    EXPECT_LT(node.parent, static_cast<int>(i));
    EXPECT_EQ(node.children[0] < 0, node.segment >= 0);
    EXPECT_EQ(node.children[0] < 0, node.children[1] < 0);
    if (node.segment >= 0) {
      EXPECT_TRUE(leaves.insert(node.segment).second);
      continue;
    }
    for (const int child : node.children) EXPECT_EQ(segmentation.tree[child].parent, static_cast<int>(i));
  }
  EXPECT_EQ(static_cast<int>(leaves.size()), segmentation.num_segments);
}

TEST(Splitting, TakesTheHandleOffABox) {
  const Mesh mesh = mug();
  const SurfaceGraph graph = meshGraph(mesh.vertices, mesh.polygons);
  const Segmentation segmentation = segmentSurface(graph, splittingTo(1));
  ASSERT_EQ(segmentation.num_segments, 2);
  expectTreeOf(segmentation);
  EXPECT_FALSE(segmentation.tree[0].planes.empty());
  int num_wrong = 0;
  for (int i = 0; i < graph.size(); ++i) num_wrong += segmentation.labels[i] != (graph.centers(0, i) > 12.01f ? 1 : 0);
  EXPECT_LT(num_wrong, 0.05 * graph.size());
}

TEST(Splitting, DepthAndPartsBoundTheNumberOfSegments) {
  const Mesh mesh = mug();
  const SurfaceGraph graph = meshGraph(mesh.vertices, mesh.polygons);
  EXPECT_EQ(segmentSurface(graph, splittingTo(0)).num_segments, 1);
  const Segmentation deep = segmentSurface(graph, splittingTo(3));
  EXPECT_GT(deep.num_segments, 2);
  EXPECT_LE(deep.num_segments, 8);
  expectTreeOf(deep);
  SegmentationOptions five = splittingTo(1);
  five.num_parts = 5;
  EXPECT_EQ(segmentSurface(graph, five).num_segments, 5) << "parts overrule the depth";
}

TEST(Splitting, SegmentsAreNumberedByFallingArea) {
  const Mesh mesh = mug();
  const SurfaceGraph graph = meshGraph(mesh.vertices, mesh.polygons);
  const Segmentation segmentation = segmentSurface(graph, splittingTo(3));
  std::vector<double> areas(static_cast<std::size_t>(segmentation.num_segments), 0.0);
  for (int i = 0; i < graph.size(); ++i) areas[segmentation.labels[i]] += graph.areas[i];
  EXPECT_TRUE(std::is_sorted(areas.rbegin(), areas.rend()));
  EXPECT_GT(areas.back(), 0.0);
}

TEST(Splitting, SameForAnyNumberOfThreads) {
  const Mesh mesh = mug();
  const SurfaceGraph graph = meshGraph(mesh.vertices, mesh.polygons);
  SegmentationOptions options = splittingTo(2);
  options.num_threads = 1;
  const std::vector<int> labels = segmentSurface(graph, options).labels;
  options.num_threads = 3;
  EXPECT_EQ(segmentSurface(graph, options).labels, labels);
}

TEST(SurfaceSegmentation, RefusesBadOptions) {
  const Mesh mesh = mug();
  const SurfaceGraph graph = meshGraph(mesh.vertices, mesh.polygons);
  EXPECT_THROW(segmentSurface(graph, splittingTo(-1)), std::invalid_argument);
  SegmentationOptions options;
  options.splitting.min_share = 0.95;
  EXPECT_THROW(segmentSurface(graph, options), std::invalid_argument);
  options = {};
  options.num_parts = -1;
  EXPECT_THROW(segmentSurface(graph, options), std::invalid_argument);
  EXPECT_THROW(segmentSurface(SurfaceGraph(), {}), std::invalid_argument);
}

}  // namespace
}  // namespace pcl_symmetry
