#include "core/segmentation/surface_patches.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "shapes/meshes.h"

namespace pcl_symmetry {
namespace {

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
