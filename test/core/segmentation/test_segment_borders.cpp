#include "core/segmentation/segment_borders.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "shapes/meshes.h"

namespace pcl_symmetry {
namespace {

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

}  // namespace
}  // namespace pcl_symmetry
