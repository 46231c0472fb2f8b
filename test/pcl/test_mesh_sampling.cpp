#include "pcl_symmetry/mesh_sampling.h"

#include <gtest/gtest.h>

#include "pcl/clouds.h"
#include "pcl/pcl_meshes.h"

namespace pcl_symmetry {
namespace {

TEST(MeshSampling, AMeshWithoutAreaGivesNoPoints) {
  EXPECT_TRUE(sampleMesh(pcl::PolygonMesh(), 10)->empty());
  pcl::PolygonMesh flat = test::boxMesh();
  for (pcl::Vertices& polygon : flat.polygons) polygon.vertices.resize(2);
  EXPECT_TRUE(sampleMesh(flat, 10)->empty());
}

TEST(MeshSampling, RefusesWrongParameters) {
  EXPECT_EQ(test::messageOf([] { sampleMesh(test::boxMesh(), 0); }), "num_points = 0, must be >= 1");
  pcl::PolygonMesh mesh = test::boxMesh();
  mesh.polygons[2].vertices[1] = 8;
  EXPECT_EQ(test::messageOf([&] { sampleMesh(mesh, 10); }), "vertex of a polygon = 8, must be one that the mesh has");
}

}  // namespace
}  // namespace pcl_symmetry
