/// Parts of surfaces, and what they are made of: patches, cuts, votes.
#include "pcl_symmetry/core/surface_segmentation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "core/segmentation/labels.h"
#include "core/segmentation/patch_merging.h"
#include "core/segmentation/segment_borders.h"
#include "core/segmentation/surface_patches.h"
#include "shapes/meshes.h"
#include "shapes/threads.h"

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
  const SurfaceGraph graph = mug().graph();
  const Segmentation segmentation = segmentSurface(graph, splittingTo(1));
  ASSERT_EQ(segmentation.num_segments, 2);
  expectTreeOf(segmentation);
  EXPECT_FALSE(segmentation.tree[0].planes.empty());
  int num_wrong = 0;
  for (int i = 0; i < graph.size(); ++i) num_wrong += segmentation.labels[i] != (graph.centers(0, i) > 12.01f ? 1 : 0);
  EXPECT_LT(num_wrong, 0.05 * graph.size());
}

TEST(Splitting, DepthAndPartsBoundTheNumberOfSegments) {
  const SurfaceGraph graph = mug().graph();
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

/// Segment of the face whose center is closest to a position.
int segmentAt(const SurfaceGraph& graph, const Segmentation& segmentation, const Eigen::Vector3f& position) {
  Eigen::Index closest = 0;
  (graph.centers.colwise() - position).colwise().squaredNorm().minCoeff(&closest);
  return segmentation.labels[closest];
}

const Eigen::Vector3f kLeftCube(4, 4, 8), kRightCube(18, 4, 8), kBar(11, 4, 5);

TEST(Merging, FindsThePartsOfADumbbellAndTheirImages) {
  const SurfaceGraph graph = test::dumbbell().graph();
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
  const SurfaceGraph graph = test::dumbbell().graph();
  for (const int num_parts : {1, 2, 5}) {
    SegmentationOptions options;
    options.num_parts = num_parts;
    const Segmentation segmentation = segmentSurface(graph, options);
    EXPECT_EQ(segmentation.num_segments, num_parts);
    expectTreeOf(segmentation);
  }
}

TEST(Merging, ConcavityWithoutTheBodySeparatesTheCubes) {
  const SurfaceGraph graph = test::dumbbell().graph();
  SegmentationOptions options;
  options.evidence = MergingEvidence::SymmetryAndConcavity;
  const Segmentation segmentation = segmentSurface(graph, options);
  expectNumberedByFallingArea(graph, segmentation);
  EXPECT_NE(segmentAt(graph, segmentation, kLeftCube), segmentAt(graph, segmentation, kRightCube));
}

TEST(Merging, PiecesThatNothingJoinsAreSegmentsAndCrumbsJoinTheClosest) {
  // Two cubes apart, and a small triangle beside the right one.
  Mesh mesh = test::voxelMesh(22, [](int x, int y, int z) { return y < 8 && z < 8 && (x < 8 || x >= 14); });
  const int a = mesh.add({22.5f, 4, 4}), b = mesh.add({22.5f, 4.5f, 4}), c = mesh.add({22.5f, 4, 4.5f});
  mesh.polygons.push_back({a, b, c});
  const SurfaceGraph graph = mesh.graph();
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
  const SurfaceGraph graph = mesh.graph();
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
  expectTreeOf(segmentSurface(sheet.graph()));
  const Segmentation one = segmentSurface(meshGraph(sheet.vertices, {{0, 11, 1}}));
  EXPECT_EQ(one.labels, std::vector<int>{0});
}

TEST(SurfaceSegmentation, IsTheSameForAnyNumberOfThreads) {
  const SurfaceGraph graph = mug().graph();
  for (SegmentationOptions options : {SegmentationOptions(), splittingTo(2)})
    test::compareThreads([&](int num_threads) {
      options.num_threads = num_threads;
      return segmentSurface(graph, options).labels;
    });
}

/// Points spread over the faces of a dumbbell.
Points dumbbellPoints(int size) {
  const Mesh mesh = test::dumbbell();
  Points points(3, size);
  for (int i = 0; i < size; ++i) points.col(i) = mesh.center(mesh.polygons.size() * i / size);
  return points;
}

TEST(SurfaceSegmentation, FewDistinctPointsAreOneSegment) {
  const Points twice = dumbbellPoints(19).replicate(1, 2);
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
        EXPECT_EQ(segmentation.reason,
                  num_parts == 0 ? "" : "num_parts = 5, 1 possible: so few points show no surface");
      }
    }
  }
}

TEST(SurfaceSegmentation, TwentyPointsAndSmallMeshesMayHaveParts) {
  SegmentationOptions two;
  two.num_parts = 2;
  const Points points = dumbbellPoints(20);
  EXPECT_EQ(segmentSurface(cloudGraph(points, neighborsOf(points, 6)), two).num_segments, 2);
  const SurfaceGraph cube = test::boxOfTriangles(1.0f, 1.0f, 1.0f).graph();
  const Segmentation halves = segmentSurface(cube, two);
  EXPECT_EQ(halves.num_segments, 2);
  EXPECT_EQ(halves.reason, "");
  SegmentationOptions many;
  many.num_parts = 13;
  const Segmentation faces = segmentSurface(cube, many);
  EXPECT_EQ(faces.reason.rfind("num_parts = 13, " + std::to_string(faces.num_segments) + " possible: parts are", 0), 0u)
      << faces.reason;
}

TEST(SurfaceSegmentation, RefusesBadOptions) {
  const SurfaceGraph graph = mug().graph();
  EXPECT_THROW(segmentSurface(graph, splittingTo(-1)), std::invalid_argument);
  SegmentationOptions options;
  options.num_parts = -1;
  EXPECT_THROW(segmentSurface(graph, options), std::invalid_argument);
  EXPECT_THROW(segmentSurface(SurfaceGraph(), {}), std::invalid_argument);
}

/// A strip of \p size quads of width 1 between y = 0 and y = 1, with the (x, z) that \p at gives for each edge across.
template <typename At>
Mesh stripAlong(int size, const At& at) {
  Mesh mesh;
  for (int k = 0; k <= size; ++k)
    for (const float y : {0.0f, 1.0f}) mesh.add({at(k).x(), y, at(k).y()});
  for (int k = 0; k < size; ++k) mesh.polygons.push_back({2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1});
  return mesh;
}

/// A row of unit squares along x, from 0 to \p size.
SurfaceGraph stripOfSquares(int size) {
  return stripAlong(size, [](int x) { return Eigen::Vector2f(static_cast<float>(x), 0.0f); }).graph();
}

/// A division whose cells are surely parts of their own.
MergedDivision divisionOf(std::vector<int> cells) {
  const Eigen::Index size = 1 + *std::max_element(cells.begin(), cells.end());
  return {std::move(cells), Eigen::MatrixXf::Identity(size, size)};
}

TEST(Consensus, FollowsTheMajority) {
  const std::vector<MergedDivision> divisions{divisionOf({0, 0, 0, 1, 1, 1}), divisionOf({0, 0, 0, 1, 1, 1}),
                                              divisionOf({0, 0, 1, 1, 1, 1})};
  EXPECT_EQ(consensus(stripOfSquares(6), divisions, 0), (std::vector<int>{0, 0, 0, 1, 1, 1}));
}

TEST(Consensus, MergesCellsThatAreLikelyOnePart) {
  MergedDivision division = divisionOf({0, 0, 1, 1, 2, 2});
  division.probability(0, 1) = division.probability(1, 0) = 0.6f;
  division.probability(1, 2) = division.probability(2, 1) = 0.4f;
  EXPECT_EQ(consensus(stripOfSquares(6), {division}, 0), (std::vector<int>{0, 0, 0, 0, 1, 1}));
}

TEST(Consensus, WithTheMirrorImageIsSymmetric) {
  const SurfaceGraph graph = stripOfSquares(8);
  const std::vector<int> reflected = reflectedElements(graph, ReflectionPlane(Eigen::Vector3d::UnitX(), 4.0));
  EXPECT_EQ(reflected, (std::vector<int>{7, 6, 5, 4, 3, 2, 1, 0}));
  // The right end is seen as a part, the left end is not quite.
  MergedDivision division = divisionOf({0, 0, 1, 1, 1, 1, 2, 2});
  division.probability(0, 1) = division.probability(1, 0) = 0.7f;
  EXPECT_EQ(consensus(graph, {division, reflectedDivision(division, reflected)}, 0),
            (std::vector<int>{0, 0, 1, 1, 1, 1, 2, 2}))
      << "0.7 and 0: the mean is below one half on both sides";
  division.probability(1, 2) = division.probability(2, 1) = 0.6f;
  division.probability(0, 2) = division.probability(2, 0) = 0.6f;
  const std::vector<int> labels = consensus(graph, {division, reflectedDivision(division, reflected)}, 0);
  EXPECT_EQ(labels.front(), labels[3]) << "0.7 and 0.6";
  EXPECT_EQ(labels.back(), labels[3]);
}

TEST(SmallSegments, JoinTheLongestBorderOrTheClosest) {
  const SurfaceGraph graph = stripOfSquares(8);
  const std::vector<int> joined = joinSmallSegments(graph, {0, 0, 0, 1, 2, 2, 2, 2}, 1.5, 8);
  EXPECT_EQ(joined.size(), 8u);
  EXPECT_EQ(std::set<int>(joined.begin(), joined.end()), (std::set<int>{0, 1}));
  EXPECT_EQ(joinSmallSegments(graph, {0, 0, 1, 1, 2, 2, 3, 3}, 0.0, 8), (std::vector<int>{0, 0, 1, 1, 2, 2, 3, 3}));
  const std::vector<int> two = joinSmallSegments(graph, {0, 0, 1, 1, 2, 2, 3, 3}, 0.0, 2);
  EXPECT_EQ(std::set<int>(two.begin(), two.end()).size(), 2u) << "at most two may stay";

  // What counts of the area of a point is at most the mean.
  SurfaceGraph sparse = graph;
  sparse.areas[7] = 20.0f;
  EXPECT_EQ(joinSmallSegments(sparse, {0, 0, 0, 0, 0, 0, 0, 1}, 6.0, 8).back(), 1);
  sparse.is_cloud = true;
  EXPECT_EQ(joinSmallSegments(sparse, {0, 0, 0, 0, 0, 0, 0, 1}, 6.0, 8).back(), 0);

  // A triangle that touches nothing, closest to the right end.
  Points vertices(3, 9);
  vertices << 0, 0, 1, 1, 2, 2, 2.1f, 2.2f, 2.1f, 0, 1, 0, 1, 0, 1, 0.5f, 0.5f, 0.6f, 0, 0, 0, 0, 0, 0, 0, 0, 0;
  const SurfaceGraph apart = meshGraph(vertices, {{0, 2, 3, 1}, {2, 4, 5, 3}, {6, 7, 8}});
  EXPECT_EQ(joinSmallSegments(apart, {0, 1, 2}, 0.1, 3), (std::vector<int>{0, 1, 1}));
}

TEST(MirroredLabels, CopiesTheSideThatChangesLess) {
  const SurfaceGraph graph = stripOfSquares(8);
  const ReflectionPlane plane(Eigen::Vector3d::UnitX(), 4.0);
  const std::vector<int> reflected = reflectedElements(graph, plane);
  const auto mirrored = [&](const std::vector<int>& labels) {
    return symmetrizedLabels(graph, labels, plane, reflected);
  };
  const std::vector<int> ends{0, 0, 1, 1, 1, 1, 2, 2};
  EXPECT_EQ(mirrored(ends), ends) << "symmetric already";
  const std::vector<int> labels = mirrored({0, 0, 0, 1, 1, 1, 2, 2});
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) EXPECT_EQ(labels[i] == labels[j], labels[7 - i] == labels[7 - j]);
  EXPECT_NE(labels[0], labels[7]);
  EXPECT_EQ(labels[3], labels[4]) << "the middle lies across the plane";
  EXPECT_EQ(mirrored(std::vector<int>(8, 0)), std::vector<int>(8, 0));
}

/// A flat strip of ten quads of length 1 along x, folded upwards at x = 7. Its width is 2, but 1 at x = 4.
SurfaceGraph strip() {
  Mesh mesh = stripAlong(10, [](int x) { return Eigen::Vector2f(std::min(x, 7), std::max(0, x - 7)); });
  mesh.vertices.row(1) = 2.0f * mesh.vertices.row(1).array() - 1.0f;
  mesh.vertices.block<1, 2>(1, 2 * 4) *= 0.5f;
  return mesh.graph();
}

/// Elements 0 to 4 on one side, 5 to 9 on the other: the border is at x = 5.
const std::vector<int> kSides{0, 0, 0, 0, 0, 1, 1, 1, 1, 1};

BorderCutOptions within(double band) {
  BorderCutOptions options;
  options.band = band;
  return options;
}

TEST(BorderCut, TakesTheShortestBorderWithinTheBand) {
  EXPECT_EQ(cutBorder(strip(), kSides, {}, within(2.5)), (std::vector<int>{0, 0, 0, 0, 1, 1, 1, 1, 1, 1}));
  EXPECT_EQ(cutBorder(strip(), kSides, {4}, within(0.0)), (std::vector<int>{0, 0, 0, 0, 1, 1, 1, 1, 1, 1}))
      << "open elements change sides at any distance";
}

TEST(BorderCut, EdgesThatFoldCostMoreOrLessByTheirSign) {
  const SurfaceGraph graph = strip();
  const auto fold = std::max_element(graph.edges.begin(), graph.edges.end(), [](const auto& a, const auto& b) {
    return std::abs(a.concavity) < std::abs(b.concavity);
  });
  // The strip is open: either side may be outward. Capacity 2 exp(-weight * pi / 2) at a concave fold is below 1.
  BorderCutOptions options = within(2.5);
  options.concavity_weight = 1.0;
  const std::vector<int> side = cutBorder(graph, kSides, {}, options);
  EXPECT_EQ(std::count(side.begin(), side.end(), 0), fold->concavity > 0.0f ? 7 : 4);
}

TEST(BorderCut, OtherPartsStayAndNoSideVanishes) {
  std::vector<int> side = kSides;
  side[0] = side[9] = -1;
  const std::vector<int> cut = cutBorder(strip(), side, {}, within(100.0));
  EXPECT_EQ(cut[0], -1);
  EXPECT_EQ(cut[9], -1);
  EXPECT_EQ(cut[1], 0) << "the farthest of its side";
  EXPECT_EQ(cut[8], 1) << "the farthest of its side";
}

int numPatches(const std::vector<int>& patches) {
  return 1 + *std::max_element(patches.begin(), patches.end());
}

TEST(SurfacePatches, AreAsManyAsAskedForAndConnected) {
  const SurfaceGraph graph = test::dumbbell().graph();
  for (const int num_patches : {1, 7, 40}) {
    const std::vector<int> patches = growPatches(graph, num_patches, 0.0f);
    EXPECT_EQ(numPatches(patches), num_patches);
    EXPECT_EQ(numPatches(connectedPieces(graph, patches)), num_patches) << "one piece each";
  }
}

TEST(SurfacePatches, BordersPreferConcaveEdges) {
  // Four quads in a row, folded upwards behind the first. Which side of an open strip is outward is chance: the fold is
  // made concave below.
  SurfaceGraph graph = stripAlong(4, [](int x) { return Eigen::Vector2f(std::min(x, 1), std::max(0, x - 1)); }).graph();
  for (SurfaceGraph::Edge& edge : graph.edges) edge.concavity = std::abs(edge.concavity);
  const std::vector<int> patches = growPatches(graph, 2, 100.0f);
  EXPECT_NE(patches[0], patches[1]);
  EXPECT_EQ(patches[1], patches[2]);
  EXPECT_EQ(patches[2], patches[3]);
}

}  // namespace
}  // namespace pcl_symmetry
