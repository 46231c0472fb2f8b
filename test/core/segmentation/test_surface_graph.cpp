#include "pcl_symmetry/core/surface_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/base/parallel.h"
#include "core/segmentation/surface_patches.h"
#include "shapes/meshes.h"
#include "shapes/shapes.h"

namespace pcl_symmetry {
namespace {

using test::Mesh;
using test::neighborsOf;

Mesh cube() {
  return test::voxelMesh(4, [](int, int, int) { return true; });
}

/// The mesh of a step: a cube of 4 x 4 x 4 without its upper quarter.
Mesh step() {
  return test::voxelMesh(4, [](int x, int, int z) { return x < 2 || z < 2; });
}

TEST(SurfaceGraph, EveryFaceOfACubeHasFourNeighborsAndItsArea) {
  const SurfaceGraph graph = cube().graph();
  ASSERT_EQ(graph.size(), 6 * 16);
  EXPECT_FLOAT_EQ(graph.area(), 96.0);
  for (int i = 0; i < graph.size(); ++i) {
    EXPECT_EQ(graph.first_edge[i + 1] - graph.first_edge[i], 4);
    EXPECT_FLOAT_EQ(graph.areas[i], 1.0f);
    EXPECT_GT(graph.normals.col(i).dot(graph.centers.col(i) - Eigen::Vector3f::Constant(2.0f)), 0.0f) << "outward";
  }
}

TEST(SurfaceGraph, ConcaveEdgesArePositiveAndConvexOnesNegative) {
  const SurfaceGraph graph = step().graph();
  int num_concave = 0, num_convex = 0;
  for (const SurfaceGraph::Edge& edge : graph.edges) {
    num_concave += edge.concavity >= 1e-6f;
    num_convex += edge.concavity <= -1e-6f;
    EXPECT_NEAR(std::sin(2.0 * edge.concavity), 0.0, 1e-5) << "flat or right angles";
  }
  EXPECT_EQ(num_concave, 4) << "the inner edge of the step";
  EXPECT_EQ(static_cast<int>(graph.edges.size()), 2 * graph.size());
  EXPECT_GT(num_convex, 40);
}

TEST(SurfaceGraph, SoupsAndTurnedFacesGiveTheSameGraph) {
  const Mesh mesh = step();
  Mesh soup;  // without shared corners
  for (std::size_t f = 0; f < mesh.polygons.size(); ++f) {
    soup.polygons.emplace_back();
    for (const int v : mesh.polygons[f]) soup.polygons[f].push_back(soup.add(mesh.vertices.col(v)));
    if (f % 3 == 0) std::reverse(soup.polygons[f].begin(), soup.polygons[f].end());
  }
  const SurfaceGraph graph = mesh.graph(), same = soup.graph();
  EXPECT_EQ(same.edges.size(), graph.edges.size());
  EXPECT_TRUE(same.normals.isApprox(graph.normals, 1e-5f));
  for (const auto* g : {&graph, &same})
    EXPECT_EQ(std::count_if(g->edges.begin(), g->edges.end(), [](const auto& e) { return e.concavity > 1; }), 4);
}

TEST(SurfaceGraph, BrokenFacesAreElementsToo) {
  Mesh mesh = cube();
  const int num_faces = static_cast<int>(mesh.polygons.size());
  mesh.polygons.push_back(mesh.polygons[0]);                                                 // twice
  mesh.polygons.push_back({mesh.polygons[1][0], mesh.polygons[1][1], mesh.polygons[1][0]});  // no area
  const int nowhere = mesh.add(Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
  mesh.polygons.push_back({0, 1, nowhere});
  const SurfaceGraph graph = mesh.graph();
  ASSERT_EQ(graph.size(), num_faces + 3);
  const auto num_neighbors = [&](int i) { return graph.first_edge[i + 1] - graph.first_edge[i]; };
  EXPECT_GT(num_neighbors(num_faces), 0) << "the copy joins the faces of its edges";
  EXPECT_GT(num_neighbors(num_faces + 1), 0);
  EXPECT_EQ(graph.areas[num_faces + 1], 0.0f);
  EXPECT_EQ(num_neighbors(num_faces + 2), 0);
  EXPECT_TRUE(graph.centers.allFinite());
  EXPECT_TRUE(graph.normals.allFinite());
}

TEST(SurfaceGraph, RefusesMissingVerticesAndNoArea) {
  const Mesh mesh = cube();
  EXPECT_THROW(meshGraph(mesh.vertices, {{0, 1, 1000}}), std::invalid_argument);
  EXPECT_THROW(meshGraph(mesh.vertices, {{0, 1, 1}}), std::invalid_argument);
  EXPECT_THROW(meshGraph(mesh.vertices, {}), std::invalid_argument);
  EXPECT_THROW(cloudGraph(Points::Ones(3, 5), neighborsOf(Points::Ones(3, 5), 2)), std::invalid_argument);
  const Points& corners = mesh.vertices;
  auto neighbors = neighborsOf(corners, 2);
  EXPECT_NO_THROW(cloudGraph(corners, neighbors));
  for (const int wrong : {-1, static_cast<int>(corners.cols())}) {
    neighbors[0][0] = wrong;
    EXPECT_THROW(cloudGraph(corners, neighbors), std::invalid_argument) << wrong;
  }
  EXPECT_THROW(cloudGraph(corners, {{1, 2}}), std::invalid_argument) << "one list for all points";
  for (const float scale : {1e-20f, 1e20f}) {  // no squares in float
    EXPECT_THROW(cloudGraph(scale * corners, neighborsOf(corners, 2)), std::invalid_argument) << scale;
    EXPECT_THROW(meshGraph(scale * mesh.vertices, mesh.polygons), std::invalid_argument) << scale;
  }
  for (const float scale : {1e-12f, 1e12f}) EXPECT_GT(meshGraph(scale * mesh.vertices, mesh.polygons).area(), 0.0);
}

TEST(SurfaceGraph, CloudOfABoxHasItsAreaAndOutwardNormals) {
  const Points points = test::box({1.0, 0.7, 0.45}, 4000, test::Sampling::Random, 3).cloud();
  const SurfaceGraph graph = cloudGraph(points, neighborsOf(points, 12));
  const double area = 8 * (0.7 + 0.45 + 0.7 * 0.45);
  EXPECT_NEAR(graph.area(), area, 0.15 * area);
  const auto outward = graph.normals.cwiseProduct(graph.centers).colwise().sum().array();
  EXPECT_GT((outward > 0.0f).count(), 0.99 * graph.size());
}

TEST(SurfaceGraph, AWatchEndsTheStepsOfOneThread) {
  constexpr int kSide = 400;
  Mesh sheet;
  sheet.vertices.resize(3, kSide * kSide);
  for (int i = 0; i < kSide * kSide; ++i)
    sheet.vertices.col(i) << static_cast<float>(i % kSide), static_cast<float>(i / kSide), std::sin(0.1f * i);
  for (int i = 0; i + kSide + 1 < kSide * kSide; ++i)
    if ((i + 1) % kSide != 0) sheet.polygons.push_back({i, i + 1, i + kSide + 1, i + kSide});
  const auto watched = [](const auto& step) {
    const ProgressMonitor monitor([](double) { throw 5; });
    step();
  };
  EXPECT_THROW(watched([&] { sheet.graph(); }), int);
  const SurfaceGraph graph = sheet.graph();
  EXPECT_THROW(watched([&] { growPatches(graph, 100, 1.0f); }), int);
}

TEST(SurfaceGraph, PiecesAreConnectedAndOfOneLabel) {
  const SurfaceGraph graph = cube().graph();
  std::vector<int> labels(static_cast<std::size_t>(graph.size()), 0);
  EXPECT_EQ(connectedPieces(graph, labels), labels);
  // Top and bottom have label 0 and do not touch; the other faces have no label.
  for (int i = 0; i < graph.size(); ++i) labels[i] = std::abs(graph.normals(2, i)) > 0.5f ? 0 : -1;
  const std::vector<int> pieces = connectedPieces(graph, labels);
  EXPECT_EQ(*std::max_element(pieces.begin(), pieces.end()), 1);
  EXPECT_EQ(std::count(pieces.begin(), pieces.end(), 0), 16);
  EXPECT_EQ(std::count(pieces.begin(), pieces.end(), -1), 64);
}

}  // namespace
}  // namespace pcl_symmetry
