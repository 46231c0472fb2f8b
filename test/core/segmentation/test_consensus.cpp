#include "core/segmentation/consensus.h"

#include <gtest/gtest.h>

#include <set>

#include "core/segmentation/segment_borders.h"
#include "core/segmentation/mirrored_labels.h"
#include "pcl_symmetry/core/surface_graph.h"

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

}  // namespace
}  // namespace pcl_symmetry
