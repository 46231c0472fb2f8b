/// Patches, cuts of borders, and divisions that agree.
#include "core/segmentation/consensus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>

#include "core/base/random.h"
#include "core/segmentation/graph_cut.h"
#include "core/segmentation/mirrored_labels.h"
#include "core/segmentation/segment_borders.h"
#include "core/segmentation/surface_patches.h"
#include "pcl_symmetry/core/surface_graph.h"
#include "shapes/meshes.h"

namespace pcl_symmetry {
namespace {

/// A row of unit squares along x, from 0 to \p size.
SurfaceGraph stripOfSquares(int size) {
  Points vertices(3, 2 * (size + 1));
  std::vector<std::vector<int>> polygons;
  for (int x = 0; x <= size; ++x)
    for (int y = 0; y < 2; ++y)
      vertices.col(2 * x + y) = Eigen::Vector3f(static_cast<float>(x), static_cast<float>(y), 0.0f);
  for (int x = 0; x < size; ++x) polygons.push_back({2 * x, 2 * x + 2, 2 * x + 3, 2 * x + 1});
  return meshGraph(vertices, polygons);
}

/// A division whose cells are surely parts of their own.
MergedDivision divisionOf(std::vector<int> cells) {
  const Eigen::Index size = 1 + *std::max_element(cells.begin(), cells.end());
  return {std::move(cells), Eigen::MatrixXf::Identity(size, size)};
}

TEST(Consensus, OfOneDivisionIsThatDivision) {
  EXPECT_EQ(consensus(stripOfSquares(6), {divisionOf({0, 0, 1, 1, 2, 2})}, 0), (std::vector<int>{0, 0, 1, 1, 2, 2}));
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
  EXPECT_EQ(joinSmallSegments(graph, {0, 0, 0, 1, 2, 2, 2, 2}, 1.5, 8).size(), 8u);
  const std::vector<int> joined = joinSmallSegments(graph, {0, 0, 0, 1, 2, 2, 2, 2}, 1.5, 8);
  EXPECT_EQ(std::set<int>(joined.begin(), joined.end()), (std::set<int>{0, 1}));
  EXPECT_EQ(joinSmallSegments(graph, {0, 0, 1, 1, 2, 2, 3, 3}, 0.0, 8), (std::vector<int>{0, 0, 1, 1, 2, 2, 3, 3}));
  const std::vector<int> two = joinSmallSegments(graph, {0, 0, 1, 1, 2, 2, 3, 3}, 0.0, 2);
  EXPECT_EQ(std::set<int>(two.begin(), two.end()).size(), 2u) << "at most two may stay";

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
  const auto mirrored = [&](const std::vector<int>& labels) { return mirroredLabels(graph, labels, plane, reflected); };
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
  test::Mesh mesh;
  for (int x = 0; x <= 10; ++x) {
    const float half_width = x == 4 ? 0.5f : 1.0f;
    for (const float side : {-1.0f, 1.0f})
      mesh.add({static_cast<float>(std::min(x, 7)), side * half_width, static_cast<float>(std::max(0, x - 7))});
  }
  for (int x = 0; x < 10; ++x) mesh.polygons.push_back({2 * x, 2 * x + 2, 2 * x + 3, 2 * x + 1});
  return meshGraph(mesh.vertices, mesh.polygons);
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

double costOf(const GraphCut& cut, const std::vector<bool>& with_source) {
  double cost = 0.0;
  for (std::size_t i = 0; i < with_source.size(); ++i) cost += with_source[i] ? cut.to_sink[i] : cut.to_source[i];
  for (const GraphCut::Edge& edge : cut.edges)
    if (with_source[edge.from] != with_source[edge.to]) cost += edge.capacity;
  return cost;
}

TEST(GraphCut, CutsAChainAtItsWeakestEdge) {
  constexpr double kNever = std::numeric_limits<double>::max();
  GraphCut cut;
  cut.to_source = {kNever, 0, 0, 0, 0};
  cut.to_sink = {0, 0, 0, 0, kNever};
  cut.edges = {{0, 1, 3.0}, {1, 2, 2.0}, {3, 2, 1.0}, {3, 4, 5.0}};
  EXPECT_EQ(cut.solve(), (std::vector<bool>{true, true, true, false, false}));
}

TEST(GraphCut, NoAssignmentOfASmallGraphCostsLess) {
  RandomStream random(5);
  for (int trial = 0; trial < 20; ++trial) {
    const int size = 8;
    GraphCut cut;
    for (int i = 0; i < size; ++i) {
      cut.to_source.push_back(random.uniform());
      cut.to_sink.push_back(random.uniform());
      for (int j = 0; j < i; ++j)
        if (random.uniform() < 0.5) cut.edges.push_back({i, j, 0.5 * random.uniform()});
    }
    const double cost = costOf(cut, cut.solve());
    for (int code = 0; code < 1 << size; ++code) {
      std::vector<bool> other(size);
      for (int i = 0; i < size; ++i) other[i] = (code >> i & 1) != 0;
      EXPECT_LE(cost, costOf(cut, other) + 1e-12);
    }
  }
}

TEST(GraphCut, RefusesWhatMakesNoSense) {
  GraphCut cut;
  cut.to_source = {1.0, 0.0};
  cut.to_sink = {0.0};
  EXPECT_THROW(cut.solve(), std::invalid_argument);
  cut.to_sink = {0.0, 1.0};
  cut.edges = {{0, 2, 1.0}};
  EXPECT_THROW(cut.solve(), std::invalid_argument);
  cut.edges = {{0, 1, -1.0}};
  EXPECT_THROW(cut.solve(), std::invalid_argument);
}

int numPatches(const std::vector<int>& patches) {
  return 1 + *std::max_element(patches.begin(), patches.end());
}

TEST(SurfacePatches, AreAsManyAsAskedForAndConnected) {
  const test::Mesh mesh = test::dumbbell();
  const SurfaceGraph graph = meshGraph(mesh.vertices, mesh.polygons);
  for (const int num_patches : {1, 7, 40}) {
    const std::vector<int> patches = growPatches(graph, num_patches, 0.0f);
    EXPECT_EQ(numPatches(patches), num_patches);
    EXPECT_EQ(numPatches(connectedPieces(graph, patches)), num_patches) << "one piece each";
  }
}

TEST(SurfacePatches, BordersPreferConcaveEdges) {
  // Four quads in a row, folded upwards behind the first. Which side of an open strip is outward is chance: the fold is
  // made concave below.
  test::Mesh mesh;
  for (int x = 0; x <= 4; ++x)
    for (const float y : {0.0f, 1.0f})
      mesh.add({static_cast<float>(std::min(x, 1)), y, static_cast<float>(std::max(0, x - 1))});
  for (int x = 0; x < 4; ++x) mesh.polygons.push_back({2 * x, 2 * x + 2, 2 * x + 3, 2 * x + 1});
  SurfaceGraph graph = meshGraph(mesh.vertices, mesh.polygons);
  for (SurfaceGraph::Edge& edge : graph.edges) edge.concavity = std::abs(edge.concavity);
  const std::vector<int> patches = growPatches(graph, 2, 100.0f);
  EXPECT_NE(patches[0], patches[1]);
  EXPECT_EQ(patches[1], patches[2]);
  EXPECT_EQ(patches[2], patches[3]);
}

}  // namespace
}  // namespace pcl_symmetry
