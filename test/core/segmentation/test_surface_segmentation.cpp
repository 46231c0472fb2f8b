#include "pcl_symmetry/core/surface_segmentation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "shapes/meshes.h"
#include "shapes/neighbors.h"

namespace pcl_symmetry {
namespace {

using test::Mesh;
using test::neighborsOf;

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

void expectNumberedByFallingArea(const SurfaceGraph& graph, const Segmentation& segmentation) {
  std::vector<double> areas(static_cast<std::size_t>(segmentation.num_segments), 0.0);
  for (int i = 0; i < graph.size(); ++i) areas[segmentation.labels[i]] += graph.areas[i];
  EXPECT_TRUE(std::is_sorted(areas.rbegin(), areas.rend()));
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
  const Segmentation deep = segmentSurface(graph, splittingTo(2));
  EXPECT_GT(deep.num_segments, 2);
  EXPECT_LE(deep.num_segments, 4);
  expectTreeOf(deep);
  expectNumberedByFallingArea(graph, deep);
  SegmentationOptions three = splittingTo(1);
  three.num_parts = 3;
  EXPECT_EQ(segmentSurface(graph, three).num_segments, 3) << "parts overrule the depth";
}

TEST(Splitting, EndsIfNoPlaneMapsAShareBetweenTheTwo) {
  const Mesh mesh = mug();
  const SurfaceGraph graph = meshGraph(mesh.vertices, mesh.polygons);
  SegmentationOptions options = splittingTo(3);
  options.splitting.min_share = options.splitting.max_share = 0.5;
  const Segmentation segmentation = segmentSurface(graph, options);
  EXPECT_EQ(segmentation.num_segments, 1) << "no plane maps exactly half of it";
  EXPECT_FALSE(segmentation.tree[0].planes.empty());
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

/// Segment of the face whose center is closest to a position.
int segmentAt(const SurfaceGraph& graph, const Segmentation& segmentation, const Eigen::Vector3f& position) {
  Eigen::Index closest = 0;
  (graph.centers.colwise() - position).colwise().squaredNorm().minCoeff(&closest);
  return segmentation.labels[closest];
}

const Eigen::Vector3f kLeftCube(4, 4, 8), kRightCube(18, 4, 8), kBar(11, 4, 5);

TEST(Merging, FindsThePartsOfADumbbellAndTheirImages) {
  const Mesh mesh = test::dumbbell();
  const SurfaceGraph graph = meshGraph(mesh.vertices, mesh.polygons);
  const Segmentation segmentation = segmentSurface(graph);
  expectTreeOf(segmentation);
  EXPECT_GE(segmentation.num_segments, 3);
  EXPECT_LE(segmentation.num_segments, 5) << "the bar may be cut across";
  const int left = segmentAt(graph, segmentation, kLeftCube), right = segmentAt(graph, segmentation, kRightCube);
  EXPECT_NE(left, right);
  int num_wrong = 0;
  for (int i = 0; i < graph.size(); ++i) {
    const float x = graph.centers(0, i);
    if (x < 7.9f) num_wrong += segmentation.labels[i] != left;
    if (x > 14.1f) num_wrong += segmentation.labels[i] != right;
    if (x > 8.1f && x < 13.9f) num_wrong += segmentation.labels[i] == left || segmentation.labels[i] == right;
  }
  EXPECT_LT(num_wrong, 0.02 * graph.size());

  // Segments have images in the planes of the whole: two across x and y, one of which exchanges the cubes.
  const int bar = segmentAt(graph, segmentation, kBar);
  bool across_x = false, across_y = false;
  std::size_t next = 0;
  for (const PartPlane& plane : segmentation.tree[0].planes) {
    if (plane.share < kMappedShare) continue;
    ASSERT_LT(next, segmentation.images.size());
    const std::vector<int>& image = segmentation.images[next++];
    EXPECT_EQ(image[bar], bar);
    if (std::abs(plane.plane.normal().x()) > 0.99) {
      across_x = true;
      EXPECT_EQ(image[left], right);
      EXPECT_EQ(image[right], left);
    } else if (std::abs(plane.plane.normal().x()) < 0.01) {
      across_y = true;
      EXPECT_EQ(image[left], left);
    }
  }
  EXPECT_EQ(next, segmentation.images.size());
  EXPECT_TRUE(across_x);
  EXPECT_TRUE(across_y);
}

TEST(Merging, GivesAsManyPartsAsAskedFor) {
  const Mesh mesh = test::dumbbell();
  const SurfaceGraph graph = meshGraph(mesh.vertices, mesh.polygons);
  for (const int num_parts : {1, 2, 5}) {
    SegmentationOptions options;
    options.num_parts = num_parts;
    const Segmentation segmentation = segmentSurface(graph, options);
    EXPECT_EQ(segmentation.num_segments, num_parts);
    expectTreeOf(segmentation);
  }
}

TEST(Merging, ConcavityWithoutTheBodySeparatesTheCubes) {
  const Mesh mesh = test::dumbbell();
  const SurfaceGraph graph = meshGraph(mesh.vertices, mesh.polygons);
  SegmentationOptions options;
  options.merging.evidence = MergingEvidence::SymmetryAndConcavity;
  const Segmentation segmentation = segmentSurface(graph, options);
  expectNumberedByFallingArea(graph, segmentation);
  EXPECT_NE(segmentAt(graph, segmentation, kLeftCube), segmentAt(graph, segmentation, kRightCube));
}

TEST(Merging, PiecesThatNothingJoinsAreSegmentsAndCrumbsJoinTheClosest) {
  // Two cubes apart, and a small triangle beside the right one.
  Mesh mesh = test::voxelMesh(22, [](int x, int y, int z) { return y < 8 && z < 8 && (x < 8 || x >= 14); });
  const int a = mesh.add({22.5f, 4, 4}), b = mesh.add({22.5f, 4.5f, 4}), c = mesh.add({22.5f, 4, 4.5f});
  mesh.polygons.push_back({a, b, c});
  const SurfaceGraph graph = meshGraph(mesh.vertices, mesh.polygons);
  const Segmentation segmentation = segmentSurface(graph);
  expectTreeOf(segmentation);
  EXPECT_EQ(segmentation.num_segments, 2);
  EXPECT_EQ(segmentation.labels.back(), segmentAt(graph, segmentation, {22, 4, 4}));
}

TEST(Merging, BrokenMeshesAreCutToo) {
  Mesh mesh = test::dumbbell();
  const std::size_t num_faces = mesh.polygons.size();
  for (std::size_t f = 0; f < num_faces; f += 50) mesh.polygons.push_back(mesh.polygons[f]);   // twice
  for (std::size_t f = 10; f < num_faces; f += 90) mesh.polygons[f] = {0, 1, 1};               // holes
  mesh.polygons.push_back({mesh.polygons[5][0], mesh.polygons[5][1], mesh.polygons[300][0]});  // a fin
  const SurfaceGraph graph = meshGraph(mesh.vertices, mesh.polygons);
  const Segmentation segmentation = segmentSurface(graph);
  expectTreeOf(segmentation);
  ASSERT_EQ(segmentation.labels.size(), mesh.polygons.size());
  EXPECT_NE(segmentAt(graph, segmentation, kLeftCube), segmentAt(graph, segmentation, kRightCube));
}

TEST(Merging, ShapesWithoutAnInsideAreCutToo) {
  Mesh sheet;
  for (int x = 0; x <= 10; ++x)
    for (int y = 0; y <= 10; ++y) sheet.add(Eigen::Vector3f(static_cast<float>(x), static_cast<float>(y), 0.0f));
  for (int x = 0; x < 10; ++x)
    for (int y = 0; y < 10; ++y)
      sheet.polygons.push_back({11 * x + y, 11 * x + y + 11, 11 * x + y + 12, 11 * x + y + 1});
  expectTreeOf(segmentSurface(meshGraph(sheet.vertices, sheet.polygons)));
  const Segmentation one = segmentSurface(meshGraph(sheet.vertices, {{0, 11, 1}}));
  EXPECT_EQ(one.labels, std::vector<int>{0});
}

TEST(Merging, SameForAnyNumberOfThreads) {
  const Mesh mesh = mug();
  const SurfaceGraph graph = meshGraph(mesh.vertices, mesh.polygons);
  SegmentationOptions options;
  options.num_threads = 1;
  const std::vector<int> labels = segmentSurface(graph, options).labels;
  options.num_threads = 3;
  EXPECT_EQ(segmentSurface(graph, options).labels, labels);
}

/// Points spread over the faces of a dumbbell.
Points dumbbellPoints(int size) {
  const Mesh mesh = test::dumbbell();
  Points points(3, size);
  for (int i = 0; i < size; ++i) points.col(i) = mesh.center(mesh.polygons.size() * i / size);
  return points;
}

TEST(SurfaceSegmentation, FewDistinctPointsAreOneSegment) {
  Points twice(3, 38);
  twice << dumbbellPoints(19), dumbbellPoints(19);
  for (const SegmentationMethod method : {SegmentationMethod::Merging, SegmentationMethod::Splitting}) {
    for (const Points& points : {dumbbellPoints(10), twice}) {
      SegmentationOptions options;
      options.method = method;
      for (const int num_parts : {0, 5}) {
        options.num_parts = num_parts;
        const Segmentation segmentation = segmentSurface(cloudGraph(points, neighborsOf(points, 6)), options);
        EXPECT_EQ(segmentation.num_segments, 1);
        EXPECT_EQ(segmentation.labels, std::vector<int>(static_cast<std::size_t>(points.cols()), 0));
        expectTreeOf(segmentation);
        EXPECT_TRUE(segmentation.images.empty());
      }
    }
  }
}

TEST(SurfaceSegmentation, TwentyPointsAndSmallMeshesMayHaveParts) {
  SegmentationOptions two;
  two.num_parts = 2;
  const Points points = dumbbellPoints(20);
  EXPECT_EQ(segmentSurface(cloudGraph(points, neighborsOf(points, 6)), two).num_segments, 2);
  Mesh cube;
  for (int corner = 0; corner < 8; ++corner)
    cube.add(Eigen::Vector3f(static_cast<float>(corner & 1), static_cast<float>(corner >> 1 & 1),
                             static_cast<float>(corner >> 2)));
  cube.polygons = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  EXPECT_EQ(segmentSurface(meshGraph(cube.vertices, cube.polygons), two).num_segments, 2);
}

TEST(SurfaceSegmentation, RefusesBadOptions) {
  const Mesh mesh = mug();
  const SurfaceGraph graph = meshGraph(mesh.vertices, mesh.polygons);
  EXPECT_THROW(segmentSurface(graph, splittingTo(-1)), std::invalid_argument);
  SegmentationOptions options;
  options.splitting.min_share = 0.95;
  EXPECT_THROW(segmentSurface(graph, options), std::invalid_argument);
  options = {};
  options.merging.num_patches = 0;
  EXPECT_THROW(segmentSurface(graph, options), std::invalid_argument);
  options = {};
  options.num_parts = -1;
  EXPECT_THROW(segmentSurface(graph, options), std::invalid_argument);
  EXPECT_THROW(segmentSurface(SurfaceGraph(), {}), std::invalid_argument);
}

}  // namespace
}  // namespace pcl_symmetry
