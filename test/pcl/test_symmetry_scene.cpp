/// Objects of a scene: supports out, clusters, what symmetry says of each.
#include "pcl_symmetry/symmetry_scene.h"

#include <gtest/gtest.h>
#include <pcl/common/point_tests.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <set>

#include "pcl/error_message.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/symmetry_maxima_refinement.h"
#include "shapes/table.h"

namespace pcl_symmetry {
namespace {

using Cloud = SymmetryScene::Cloud;

Cloud::Ptr pictureOf(const test::Scan& scan) {
  auto cloud = pcl::make_shared<Cloud>(scan.width, scan.height);
  for (std::size_t i = 0; i < cloud->size(); ++i)
    (*cloud)[i].getVector3fMap() = scan.pixels.col(static_cast<Eigen::Index>(i));
  cloud->is_dense = false;
  return cloud;
}

/// Fewer points than by default, to save time.
SceneAnalysis analysed(const Cloud::ConstPtr& cloud, bool frames = false) {
  SymmetryScene scene;
  SceneOptions options;
  options.max_points = 1000;
  options.frames = frames;
  scene.setOptions(options);
  scene.setInputCloud(cloud);
  return scene.compute();
}

/// Boxes of three different sides have no other planes.
void expectPlanesAcrossAxes(const SceneObject& object) {
  for (const SymmetryPlane& plane : object.planes) {
    if (plane.kind != PlaneKind::Symmetry) continue;
    EXPECT_GT(plane.normal().cwiseAbs().maxCoeff(), std::cos(3.0 * M_PI / 180.0))
        << "confidence " << plane.confidence << ", normal " << plane.normal().transpose();
  }
}

/// Two boxes apart, with room between them in the picture.
const test::Table& twoBoxes() {
  static const test::Table table({{-0.35, 0.1, 0.0}, {0.25, 0.0, 0.0}});
  return table;
}

TEST(SymmetryScene, TakesTheTableOutAndFindsWhatStandsOnIt) {
  const SceneAnalysis scene = analysed(pictureOf(twoBoxes().scan), true);
  ASSERT_EQ(scene.supports.size(), 1u);
  EXPECT_LT((scene.supports[0].coefficients - Eigen::Vector4d(0.0, 0.0, 1.0, 0.0)).norm(), 0.02)
      << "towards the viewer";
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.seen->source(), ViewpointSource::Rays);
  std::set<int> found;
  for (const SceneObject& object : scene.objects) {
    std::set<int> ids;
    for (const pcl::index_t i : object.indices) ids.insert(twoBoxes().ids[static_cast<std::size_t>(i)]);
    ASSERT_EQ(ids.size(), 1u) << "points of one box and none of the table";
    found.insert(*ids.begin());
    ASSERT_TRUE(object.frame);
    const test::Block& box = twoBoxes().blocks.blocks[static_cast<std::size_t>(*ids.begin())];
    EXPECT_LT((object.frame->center - box.center).norm(), 0.25 * box.half.norm());
    expectPlanesAcrossAxes(object);
  }
  EXPECT_EQ(found, (std::set<int>{1, 2}));
}

TEST(SymmetryScene, DecidesThePlanesOfBoxesWithAllTheirPoints) {
  SymmetryScene scene;
  SceneOptions options;
  options.frames = false;
  scene.setOptions(options);
  scene.setInputCloud(pictureOf(twoBoxes().scan));
  const SceneAnalysis analysis = scene.compute();
  ASSERT_EQ(analysis.objects.size(), 2u);
  for (const SceneObject& object : analysis.objects) {
    ASSERT_FALSE(object.planes.empty());
    EXPECT_EQ(object.planes[0].kind, PlaneKind::Symmetry) << "left and right of a box";
    expectPlanesAcrossAxes(object);
  }
}

TEST(SymmetryScene, ObjectsStandOnTheTableWithTheirFeet) {
  const Cloud::ConstPtr cloud = pictureOf(twoBoxes().scan);
  const SceneAnalysis scene = analysed(cloud);
  ASSERT_EQ(scene.supports.size(), 1u);
  EXPECT_LT((scene.supports[0].coefficients - Eigen::Vector4d(0.0, 0.0, 1.0, 0.0)).norm(), 1e-5)
      << "points without noise";
  const auto num_feet =
      std::count_if(scene.supports[0].indices.begin(), scene.supports[0].indices.end(), [&](pcl::index_t i) {
        return twoBoxes().ids[static_cast<std::size_t>(i)] != 0 && (*cloud)[i].z > 0.25 * scene.plane_distance;
      });
  EXPECT_LE(num_feet, 5) << "single pixels on the sides of the boxes, far from their other points";
  for (const SceneObject& object : scene.objects) {
    float lowest = 1.0f;
    for (const pcl::index_t i : object.indices) lowest = std::min(lowest, (*cloud)[i].z);
    EXPECT_LT(lowest, 0.25 * scene.plane_distance) << "the rows of pixels are as far apart";
  }
}

/// The errors of structured light: 1.4 mm at 1 m, growing with the square of the depth.
Cloud::Ptr withDepthErrors(const test::Scan& scan) {
  RandomStream random(5);
  Cloud::Ptr cloud = pictureOf(scan);
  for (pcl::PointXYZ& point : *cloud) {
    double deviate = -6.0;  // normal, from twelve even ones
    for (int i = 0; i < 12; ++i) deviate += random.uniform();
    if (!pcl::isXYZFinite(point)) continue;
    const Eigen::Vector3d x = point.getVector3fMap().cast<double>();
    const double depth = (scan.T_camera_object * x).z();
    point.getVector3fMap() = (scan.viewpoint + (1.0 + 1.4e-3 * depth * deviate) * (x - scan.viewpoint)).cast<float>();
  }
  return cloud;
}

double meanDistance(const Cloud& a, const Cloud& b) {
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!pcl::isXYZFinite(a[i]) || !pcl::isXYZFinite(b[i])) continue;
    sum += (a[i].getVector3fMap() - b[i].getVector3fMap()).norm();
    count += 1.0;
  }
  return sum / count;
}

TEST(WithoutDepthErrors, BringsPointsBackToTheirSurfaces) {
  const Cloud::ConstPtr truth = pictureOf(twoBoxes().scan), noisy = withDepthErrors(twoBoxes().scan);
  const Cloud::ConstPtr filtered = withoutDepthErrors(noisy, SeenSpace(*noisy));
  ASSERT_EQ(filtered->width, noisy->width);
  ASSERT_EQ(filtered->height, noisy->height);
  EXPECT_LT(meanDistance(*filtered, *truth), meanDistance(*noisy, *truth) / 2.5)
      << "25 pixels leave a fifth, edges more";
  std::size_t num_lost = 0, num_points = 0;
  for (std::size_t i = 0; i < noisy->size(); ++i) {
    num_points += pcl::isXYZFinite((*noisy)[i]) ? 1 : 0;
    num_lost += pcl::isXYZFinite((*noisy)[i]) && !pcl::isXYZFinite((*filtered)[i]) ? 1 : 0;
  }
  EXPECT_LT(static_cast<double>(num_lost), 0.05 * static_cast<double>(num_points))
      << "1.2 % of normal errors, and edges";
}

TEST(WithoutDepthErrors, LeavesExactAndUnorganizedFramesAsTheyAre) {
  const Cloud::ConstPtr exact = pictureOf(twoBoxes().scan);
  EXPECT_EQ(withoutDepthErrors(exact, SeenSpace(*exact)), exact);
  auto row = pcl::make_shared<Cloud>(*withDepthErrors(twoBoxes().scan));
  row->width = static_cast<std::uint32_t>(row->size());
  row->height = 1;
  EXPECT_EQ(withoutDepthErrors(row, SeenSpace()), Cloud::ConstPtr(row));
  EXPECT_EQ(withoutDepthErrors(nullptr, SeenSpace()), nullptr);
}

TEST(SymmetryScene, DecidesPlanesOfBoxesThroughTheErrorsOfACamera) {
  const SceneAnalysis scene = analysed(withDepthErrors(twoBoxes().scan));
  ASSERT_EQ(scene.supports.size(), 1u);
  ASSERT_EQ(scene.objects.size(), 2u);
  for (const SceneObject& object : scene.objects) {
    ASSERT_FALSE(object.planes.empty());
    EXPECT_EQ(object.planes[0].kind, PlaneKind::Symmetry) << "left and right of a box";
    expectPlanesAcrossAxes(object);
  }
}

/// The planes of a part of a frame.
SymmetryMaximaRefinement<pcl::PointXYZ> ofBox(const Cloud::ConstPtr& frame, int box) {
  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  refinement.setInputCloud(frame);
  refinement.setIndices(pcl::make_shared<pcl::Indices>(twoBoxes().pixelsOf(box)));
  return refinement;
}

TEST(SymmetryMaximaRefinement, APartOfAFrameKnowsTheTableThatItStandsOn) {
  const Cloud::ConstPtr frame = pictureOf(twoBoxes().scan);
  const SeenSpace seen = detail::seenOfPart(detail::ScannerOutput(*frame), twoBoxes().pixelsOf(1), Viewpoint(), 0.01);
  ASSERT_NE(seen.visibility(), nullptr);
  ASSERT_EQ(seen.visibility()->supports().size(), 1u);
  EXPECT_LT((seen.visibility()->supports()[0].head<3>() - Eigen::Vector3d::UnitZ()).norm(), 1e-3);
}

TEST(SymmetryMaximaRefinement, DecidesAtWhatTheSensorResolves) {
  const Cloud::ConstPtr exact = pictureOf(twoBoxes().scan), noisy = withDepthErrors(twoBoxes().scan);
  for (const int box : {1, 2}) {
    auto clean = ofBox(exact, box);
    clean.compute();
    EXPECT_LT(clean.getResolution(), 0.01 * clean.getDiameter());
    EXPECT_NEAR(clean.getUsedTolerance(), 0.01 * clean.getDiameter(), 1e-9);
    auto blurred = ofBox(noisy, box);
    const auto planes = blurred.compute();
    EXPECT_GT(blurred.getUsedTolerance(), 0.015 * blurred.getDiameter()) << "errors of 4 mm at 1.8 m";
    ASSERT_FALSE(planes.empty());
    EXPECT_EQ(planes[0].kind, PlaneKind::Symmetry) << "left and right of a box";
    auto fixed = ofBox(noisy, box);
    fixed.setTolerance(0.01);
    for (const SymmetryPlane& plane : fixed.compute())
      EXPECT_NE(plane.kind, PlaneKind::Symmetry) << "the sensor does not show whether it is";
    EXPECT_NEAR(fixed.getUsedTolerance(), 0.01 * fixed.getDiameter(), 1e-9);
  }
}

TEST(SymmetryScene, CompletesIntoSpaceThatWasNotSeen) {
  const SceneAnalysis scene = analysed(pictureOf(twoBoxes().scan));
  const Visibility truth = twoBoxes().scan.visibility();
  for (const SceneObject& object : scene.objects) {
    EXPECT_EQ(object.completed_by.has_value(), !object.planes.empty() && object.planes[0].kind == PlaneKind::Symmetry);
    std::size_t num_in_front = 0;
    for (const pcl::PointXYZ& point : object.added)
      num_in_front += truth.depthBehind(point.getVector3fMap().cast<double>()) < -0.05 ? 1 : 0;
    EXPECT_LE(static_cast<double>(num_in_front), 0.02 * static_cast<double>(object.added.size()));
  }
}

TEST(SymmetryScene, AnUnorganizedSceneGivesTheSameObjects) {
  auto points = pcl::make_shared<Cloud>();
  const Cloud::ConstPtr picture = pictureOf(twoBoxes().scan);
  for (const pcl::PointXYZ& point : *picture)
    if (pcl::isXYZFinite(point)) points->push_back(point);
  points->sensor_origin_ << twoBoxes().scan.viewpoint.cast<float>(), 0.0f;
  const SceneAnalysis scene = analysed(points);
  EXPECT_EQ(scene.seen->source(), ViewpointSource::Stored);
  EXPECT_EQ(scene.supports.size(), 1u);
  EXPECT_EQ(scene.objects.size(), 2u);
}

TEST(SymmetryScene, TheTableAloneIsNoObject) {
  const test::Scan empty = test::scan({{{{0.0, 0.0, -0.02}, {0.7, 0.7, 0.02}}}, {}}, {0.1, -1.6, 1.0}, 0.0, 160, 120);
  const SceneAnalysis scene = analysed(pictureOf(empty));
  EXPECT_EQ(scene.supports.size(), 1u);
  EXPECT_TRUE(scene.objects.empty());
}

TEST(SymmetryScene, BulgesOfTheTableAreNoObjects) {
  // 45 mm high, as stereo cameras measure walls in waves; more than three times what belongs to the plane.
  const Cloud::Ptr scene = pictureOf(twoBoxes().scan);
  for (const int i : twoBoxes().pixelsOf(0)) {
    pcl::PointXYZ& point = (*scene)[static_cast<std::size_t>(i)];
    const double sq_distance = std::pow(point.x + 0.2, 2) + std::pow(point.y + 0.35, 2);
    point.z += static_cast<float>(0.045 * std::exp(-sq_distance / (0.15 * 0.15)));
  }
  const SceneAnalysis found = analysed(scene);
  EXPECT_EQ(found.supports.size(), 1u);
  EXPECT_EQ(found.objects.size(), 2u) << "the boxes";
}

TEST(SymmetryScene, AnyNumberOfThreadsGivesTheSameObjects) {
  const Cloud::Ptr picture = pictureOf(twoBoxes().scan);
  const auto database = std::make_shared<SymmetryDatabase>(":memory:");
  for (int object = 1; object <= 2; ++object)
    database->add("box " + std::to_string(object), Cloud(*picture, twoBoxes().pixelsOf(object)));
  const auto with = [&](int num_threads) {
    SymmetryScene scene;
    SceneOptions options;
    options.max_points = 1000;
    options.num_threads = options.recognition.num_threads = num_threads;
    options.recognition.min_confidence = 0.0;
    scene.setOptions(options);
    scene.setInputCloud(picture);
    scene.setDatabase(database);
    return scene.compute();
  };
  const SceneAnalysis one = with(1);
  ASSERT_EQ(one.objects.size(), 2u);
  EXPECT_FALSE(one.objects[0].models.empty());
  for (const int num_threads : {2, 3}) {  // with 3, one object after the other
    const SceneAnalysis many = with(num_threads);
    ASSERT_EQ(many.objects.size(), one.objects.size());
    for (std::size_t k = 0; k < one.objects.size(); ++k) {
      const SceneObject &a = one.objects[k], &b = many.objects[k];
      EXPECT_EQ(a.indices, b.indices);
      EXPECT_EQ(a.added.size(), b.added.size());
      ASSERT_EQ(a.planes.size(), b.planes.size());
      for (std::size_t i = 0; i < a.planes.size(); ++i) {
        EXPECT_EQ(a.planes[i].coefficients(), b.planes[i].coefficients());
        EXPECT_EQ(a.planes[i].confidence, b.planes[i].confidence);
      }
      ASSERT_EQ(a.models.size(), b.models.size());
      for (std::size_t i = 0; i < a.models.size(); ++i) {
        EXPECT_EQ(a.models[i].name, b.models[i].name);
        EXPECT_EQ(a.models[i].T_model_scan.matrix(), b.models[i].T_model_scan.matrix());
        EXPECT_EQ(a.models[i].confidence, b.models[i].confidence);
      }
    }
  }
}

TEST(SymmetryScene, ALargeBoxIsNoTable) {
  // Its front is more than half of the picture; what lies behind the front is the rest of the box.
  const test::Scan box = test::scan(test::blockBox(), {0.8, -2.5, 1.2}, 0.0, 160, 120);
  const SceneAnalysis scene = analysed(pictureOf(box));
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_GT(scene.objects[0].indices.size(), 0.9 * static_cast<double>(box.cloud().cols()));
}

TEST(SymmetryScene, DataWithoutAnswerGiveNoObject) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(SymmetryScene().compute().objects.empty());
  EXPECT_TRUE(analysed(pcl::make_shared<Cloud>()).objects.empty());
  EXPECT_TRUE(analysed(pcl::make_shared<Cloud>(50, 1, pcl::PointXYZ(none, 0.0f, 0.0f))).objects.empty());
  EXPECT_TRUE(analysed(pcl::make_shared<Cloud>(500, 1, pcl::PointXYZ(1.0f, 2.0f, 3.0f))).objects.empty());
}

TEST(SymmetryScene, RefusesBadOptions) {
  SymmetryScene scene;
  SceneOptions options;
  options.min_points = 3;
  EXPECT_EQ(test::messageOf([&] { scene.setOptions(options); }), "min_points = 3, must be >= 20");
  EXPECT_EQ(scene.getOptions().min_points, SceneOptions().min_points) << "as before";
}

}  // namespace
}  // namespace pcl_symmetry
