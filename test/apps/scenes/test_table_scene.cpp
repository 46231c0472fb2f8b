/// Scenes with known objects, poses and occlusion.
#include "evaluate/scenes/table_scene.h"

#include <gtest/gtest.h>
#include <pcl/common/point_tests.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/support/box_mesh.h"
#include "apps/support/lathe_mesh.h"
#include "apps/support/tool_run.h"
#include "evaluate/scenes/scene_report.h"

namespace {

using namespace pcl_symmetry::apps;

std::vector<SceneModel> boxes() {
  std::vector<SceneModel> models;
  models.emplace_back("flat", boxMesh({3.0f, 2.0f, 1.0f}, {5.0f, 0.0f, 0.0f}), 0.2);
  models.emplace_back("long", boxMesh({0.1f, 0.1f, 0.4f}), 0.25);
  return models;
}

DepthNoise exact() {
  DepthNoise noise;
  noise.factor = 0.0;
  return noise;
}

/// Distance of a point from the surface of a box that stands in a scene.
double distanceFrom(const SceneModel& model, const PlacedModel& placed, const Eigen::Vector3d& x) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : model.vertices) box.extend(vertex);
  const Eigen::Array3d outside =
      (placed.T_scene_model.inverse() * x - box.center()).array().abs() - 0.5 * box.sizes().array();
  return outside.maxCoeff() > 0.0 ? outside.max(0.0).matrix().norm() : -outside.maxCoeff();
}

TEST(TableScene, PixelsLieOnTheirObjectsAndOnTheTable) {
  const std::vector<SceneModel> models = boxes();
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const TableScene scene = drawScene(models, {}, seed);
    const SceneImage image = renderScene(models, scene, exact(), seed);
    ASSERT_FALSE(scene.objects.empty());
    std::vector<int> counted(scene.objects.size(), 0);
    for (std::size_t i = 0; i < image.ids.size(); ++i) {
      const Eigen::Vector3d x = (*image.cloud)[i].getVector3fMap().cast<double>();
      if (image.ids[i] == -2) {
        ASSERT_FALSE(x.allFinite());
      } else if (image.ids[i] == -1) {
        ASSERT_NEAR(x.z(), 0.0, 1e-5);
      } else {
        const auto k = static_cast<std::size_t>(image.ids[i]);
        ++counted[k];
        ASSERT_LT(distanceFrom(models[scene.objects[k].model], scene.objects[k], x), 1e-5);
      }
    }
    EXPECT_EQ(counted, image.num_visible);
    for (std::size_t k = 0; k < counted.size(); ++k) EXPECT_LE(image.num_visible[k], image.num_alone[k]);
  }
}

TEST(TableScene, ObjectsStandOnTheTableAndDoNotMeet) {
  const std::vector<SceneModel> models = boxes();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const TableScene scene = drawScene(models, {}, seed);
    for (const PlacedModel& object : scene.objects) {
      double lowest = 1.0;
      for (const Eigen::Vector3d& vertex : models[object.model].vertices)
        lowest = std::min(lowest, (object.T_scene_model * vertex).z());
      EXPECT_NEAR(lowest, 0.0, 1e-6);
      for (const PlacedModel& other : scene.objects) {
        if (&other == &object) continue;
        for (const Eigen::Vector3d& vertex : models[object.model].vertices)
          EXPECT_GT(distanceFrom(models[other.model], other, object.T_scene_model * vertex), 0.001);
      }
    }
  }
}

TEST(TableScene, NoiseGrowsWithTheSquareOfTheDepth) {
  const std::vector<SceneModel> models = boxes();
  TableScene scene = drawScene(models, {}, 1);
  scene.objects.clear();
  scene.sensor.T_scene_sensor.linear() = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()).toRotationMatrix();
  for (const double height : {0.8, 1.6}) {
    scene.sensor.T_scene_sensor.translation() = height * Eigen::Vector3d::UnitZ();
    const SceneImage image = renderScene(models, scene, DepthNoise(), 7);
    double sum = 0.0, count = 0.0;
    for (const pcl::PointXYZ& point : *image.cloud)
      if (std::isfinite(point.z)) sum += point.z * point.z, ++count;
    // The steps of the depths add their own variance: a twelfth of their square.
    const DepthNoise noise;
    const double expected = std::hypot(noise.deviation, noise.step / std::sqrt(12.0)) * height * height;
    EXPECT_NEAR(std::sqrt(sum / count), expected, 0.1 * expected) << height;
  }
}

TEST(TableScene, DepthsHaveTheStepsOfTheDisparity) {
  const std::vector<SceneModel> models = boxes();
  TableScene scene = drawScene(models, {}, 1);
  const SceneImage image = renderScene(models, scene, DepthNoise(), 7);
  const Eigen::Isometry3d T_sensor_scene = scene.sensor.T_scene_sensor.inverse();
  std::set<int> steps;
  for (const pcl::PointXYZ& point : *image.cloud) {
    if (!pcl::isXYZFinite(point)) continue;
    const double depth = (T_sensor_scene * point.getVector3fMap().cast<double>()).z();
    const double disparity = 1.0 / (DepthNoise().step * depth);
    ASSERT_NEAR(disparity, std::round(disparity), 0.01) << depth;
    steps.insert(static_cast<int>(std::round(disparity)));
  }
  // Depths from 0.7 to 1.6 m: 1 / (0.00285 depth) goes from 500 to 220.
  EXPECT_GT(steps.size(), 50u);
}

TEST(TableScene, ABinStandsAroundItsObjects) {
  const std::vector<SceneModel> models = boxes();
  SceneOptionsOfTable options;
  options.in_bin = true;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const TableScene scene = drawScene(models, options, seed);
    ASSERT_TRUE(scene.bin);
    for (const PlacedModel& object : scene.objects)
      for (const Eigen::Vector3d& vertex : models[object.model].vertices)
        for (const Eigen::Vector4d& face : scene.bin->innerFaces())
          ASSERT_GT(face.dot((object.T_scene_model * vertex).homogeneous()), 0.005);
    const SceneImage image = renderScene(models, scene, exact(), seed);
    int on_walls = 0;
    for (std::size_t i = 0; i < image.ids.size(); ++i) {
      if (image.ids[i] != -1) continue;
      const Eigen::Vector3d x = (*image.cloud)[i].getVector3fMap().cast<double>();
      if (x.z() < 1e-4) continue;
      ++on_walls;
      double outside = 1.0;
      for (const Eigen::AlignedBox3d& wall : scene.bin->walls()) outside = std::min(outside, wall.exteriorDistance(x));
      ASSERT_LT(outside, 1e-5);
      ASSERT_LT(x.z(), scene.bin->height + 1e-5);
    }
    EXPECT_GT(on_walls, 1000);
  }
}

TEST(TableScene, AScannerHasRingsAndSparseObjects) {
  const std::vector<SceneModel> models = boxes();
  for (const int num_rings : {16, 64}) {
    SceneOptionsOfTable options;
    options.most_objects = 1;
    options.sensor = SceneSensor::lidar(num_rings);
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const TableScene scene = drawScene(models, options, seed);
      const SceneImage image = renderScene(models, scene, exact(), seed);
      ASSERT_EQ(image.cloud->size(), image.ids.size());
      ASSERT_EQ(scene.objects.size(), 1u);
      EXPECT_GE(image.num_visible[0], 100);
      EXPECT_LE(image.num_visible[0], 5000);
      const Eigen::Isometry3d T_sensor_scene = scene.sensor.T_scene_sensor.inverse();
      std::set<int> rings;
      for (std::size_t i = 0; i < image.ids.size(); ++i) {
        const Eigen::Vector3d x = (*image.cloud)[i].getVector3fMap().cast<double>(), seen = T_sensor_scene * x;
        ASSERT_NE(image.ids[i], -2);
        if (image.ids[i] == 0) {
          ASSERT_LT(distanceFrom(models[scene.objects[0].model], scene.objects[0], x), 1e-5);
        }
        const double ring = std::asin(seen.y() / seen.norm()) / scene.sensor.ring_step + 0.5 * num_rings - 0.5;
        ASSERT_NEAR(ring, std::round(ring), 0.01);
        rings.insert(static_cast<int>(std::round(ring)));
      }
      EXPECT_LE(rings.size(), static_cast<std::size_t>(num_rings));
    }
  }
}

TEST(TableScene, IsTheSameForTheSameSeed) {
  const std::vector<SceneModel> models = boxes();
  const auto image = [&](std::uint64_t seed) {
    return renderScene(models, drawScene(models, {}, seed), DepthNoise(), seed);
  };
  const SceneImage one = image(3), same = image(3), other = image(4);
  EXPECT_EQ(one.ids, same.ids);
  EXPECT_NE(one.ids, other.ids);
  for (std::size_t i = 0; i < one.cloud->size(); i += 97)
    if (pcl::isXYZFinite((*one.cloud)[i])) {
      EXPECT_EQ((*one.cloud)[i].z, (*same.cloud)[i].z);
    }
}

TEST(SceneReport, OcclusionFallsIntoBands) {
  EXPECT_EQ(bandOf(0.0), 0u);
  EXPECT_EQ(bandOf(0.1), 1u);
  EXPECT_EQ(bandOf(0.49), 2u);
  EXPECT_EQ(bandOf(0.69), 3u);
  EXPECT_FALSE(bandOf(0.7));
}

class EvaluateScenes : public ToolTest {
protected:
  EvaluateScenes() : ToolTest(toolPath("evaluate") + " scenes") {}
};

TEST_F(EvaluateScenes, JudgesNoisyFramesAlsoFiltered) {
  folder_.write("box.off", boxOFF());
  ASSERT_EQ(run(folder_ / "" + " -scenes 1 -objects 1 -noise 1 -quiet -json " + (folder_ / "r.json")), 0) << error_;
  const nlohmann::json report = nlohmann::json::parse(contentOf(folder_ / "r.json"));
  std::set<std::string> names;
  for (const nlohmann::json& row : report["rows"]) names.insert(row["seen"].get<std::string>());
  EXPECT_EQ(names, (std::set<std::string>{"alone", "scene", "table", "filtered"}));
}

TEST_F(EvaluateScenes, JudgesBinsAndScanners) {
  folder_.write("box.off", boxOFF());
  ASSERT_EQ(run(folder_ / "" + " -scenes 1 -objects 1 -noise 1 -place bin -sensor lidar -rings 64 -quiet -json " +
                (folder_ / "r.json")),
            0)
      << error_;
  const nlohmann::json report = nlohmann::json::parse(contentOf(folder_ / "r.json"));
  EXPECT_EQ(report["place"], "bin");
  EXPECT_EQ(report["sensor"], "lidar");
  EXPECT_EQ(report["rows"].size(), 3u) << "a scan without rows is not filtered";
  EXPECT_EQ(run(folder_ / "" + " -place moon"), 2);
}

TEST_F(EvaluateScenes, JudgesEachObjectAloneInItsSceneAndOnItsTable) {
  folder_.write("box.off", boxOFF());
  ASSERT_EQ(run(folder_ / "" + " -scenes 2 -objects 1 -noise 0 -quiet -json " + (folder_ / "r.json") + " -export " +
                (folder_ / "scenes") + " -csv " + (folder_ / "objects.csv")),
            0)
      << error_;
  const nlohmann::json report = nlohmann::json::parse(contentOf(folder_ / "r.json"));
  ASSERT_EQ(report["rows"].size(), 3u) << output_;
  std::set<std::string> names;
  for (const nlohmann::json& row : report["rows"]) {
    names.insert(row["seen"].get<std::string>());
    EXPECT_EQ(row["decided_right"]["total"], 2) << "each scene has one box, and nothing hides it";
    EXPECT_EQ(row["asymmetric_called"]["total"], 0);
  }
  EXPECT_EQ(names, (std::set<std::string>{"alone", "scene", "table"}));
  const nlohmann::json truth = nlohmann::json::parse(contentOf(folder_ / "scenes/ground_truth.json"));
  const nlohmann::json& object = truth["scenes"]["scene_0000_noise_0"][0];
  EXPECT_EQ(object["model"], "box");
  EXPECT_EQ(object["symmetries"]["planes"].size(), 3u);
  EXPECT_EQ(object["num_visible"], object["num_alone"]);
  EXPECT_EQ(run(folder_ / "" + " -no_planes"), 2);
  EXPECT_NE(error_.find("-no_planes needs -leave_out"), std::string::npos) << error_;
}

}  // namespace
