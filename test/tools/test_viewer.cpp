/// What the viewer shows of a shape, its keys and its colors.
#include <gtest/gtest.h>
#include <pcl/conversions.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "pcl/pcl_meshes.h"
#include "pictures/colors.h"
#include "viewer/viewer_model.h"
#include "viewer/viewer_state.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

using pcl_symmetry::test::boxMesh;

TEST(Cividis, RunsFromDarkBlueToYellow) {
  EXPECT_LT(cividis(0).sum(), 0.5);
  EXPECT_TRUE(cividis(1).isApprox(Eigen::Vector3d(255, 234, 70) / 255));
  EXPECT_EQ(cividis(-1), cividis(0));
  EXPECT_EQ(cividis(7), cividis(1));
  const Eigen::Vector3d luminance(0.2126, 0.7152, 0.0722);
  for (double value = 0.02; value <= 1; value += 0.02) {
    EXPECT_GT(luminance.dot(cividis(value)), luminance.dot(cividis(value - 0.02)));
  }
}

TEST(ViewerKeys, DoWhatTheHelpSays) {
  ViewerState state;
  state.num_planes = 3;
  state.has_mesh = true;
  pressKey(state, "n");
  EXPECT_EQ(state.plane, 1);
  pressKey(state, "b");
  pressKey(state, "Left");
  EXPECT_EQ(state.plane, 2) << "round";
  pressKey(state, "Right");
  EXPECT_EQ(state.plane, 0);
  using Toggle = std::pair<const char*, bool ViewerState::*>;
  for (const auto& [key, field] :
       {Toggle("g", &ViewerState::patch), Toggle("s", &ViewerState::support), Toggle("o", &ViewerState::reflection),
        Toggle("a", &ViewerState::axes), Toggle("m", &ViewerState::mesh), Toggle("c", &ViewerState::parts),
        Toggle("h", &ViewerState::help)})
    for (const bool expected : {!(state.*field), state.*field}) {
      pressKey(state, key);
      EXPECT_EQ(state.*field, expected) << key;
    }
  pressKey(state, "i");
  pressKey(state, "i");
  EXPECT_EQ(state.step, 1);
  pressKey(state, "u");
  EXPECT_EQ(state.step, 0);
  pressKey(state, "n");
  EXPECT_EQ(state.step, -1) << "of another plane";
  pressKey(state, "w");
  EXPECT_EQ(state.camera, CameraMove::Worst);
  pressKey(state, "v");
  EXPECT_EQ(state.camera, CameraMove::Best);
  pressKey(state, "e");
  EXPECT_EQ(state.camera, CameraMove::Along);
  pressKey(state, "p");
  EXPECT_TRUE(state.save);
  EXPECT_FALSE(state.quit);
  pressKey(state, "Escape");
  EXPECT_TRUE(state.quit);
  EXPECT_FALSE(pressKey(state, "F7"));
}

/// The box as loadShape() gives it.
Shape loadedBox(const Eigen::Vector3f& center) {
  Shape shape;
  shape.mesh = boxMesh({2.0f, 3.0f, 4.0f}, center);
  shape.cloud = shape.mesh->cloud;
  shape.points.reset(new pcl::PointCloud<pcl::PointXYZ>);
  pcl::fromPCLPointCloud2(shape.cloud, *shape.points);
  return shape;
}

TEST(ViewerModel, IsOfUnitSizeAboutTheOriginWithItsPlanes) {
  ViewerModelOptions options;
  const Eigen::Vector3f center(40, -30, 20);
  const ViewerModel model = makeViewerModel(loadedBox(center), options);
  ASSERT_EQ(model.planes.size(), 3u);
  EXPECT_EQ(model.labels.size(), 3u);
  Eigen::AlignedBox3d box;
  for (const pcl::PointXYZ& point : *model.points) box.extend(point.getVector3fMap().cast<double>());
  for (const SymmetryPlane& plane : model.planes) {
    EXPECT_LT(std::abs(plane.signedDistance(box.center())), 0.005) << "through the middle of the box";
    EXPECT_EQ(plane.point_support.size(), model.points->size());
  }
  float farthest = 0.0f;
  for (const pcl::PointXYZ& point : *model.points) farthest = std::max(farthest, point.getVector3fMap().norm());
  EXPECT_NEAR(farthest, 1.0f, 0.02f);
}

TEST(ViewerModel, IsCutIntoPartsOfTheMeshOrOfTheCloud) {
  ViewerModelOptions options;
  options.num_parts = 2;
  Shape shape = loadedBox(Eigen::Vector3f::Zero());
  ViewerModel model = makeViewerModel(shape, options);
  EXPECT_EQ(findParts(model).size(), model.mesh->polygons.size());
  shape.points = model.points;
  shape.mesh.reset();
  model = makeViewerModel(shape, options);
  const std::vector<int> parts = findParts(model);
  EXPECT_EQ(parts.size(), model.points->size());
  EXPECT_EQ(std::set<int>(parts.begin(), parts.end()), (std::set<int>{0, 1}));
}

}  // namespace
