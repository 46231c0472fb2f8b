/// Objects of a scene: supports out, clusters, what symmetry says of each.
#include "pcl_symmetry/symmetry_scene.h"

#include <gtest/gtest.h>
#include <pcl/common/point_tests.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <set>

#include "core/geometry/viewing_frame.h"
#include "pcl/clouds.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/symmetry_maxima_refinement.h"
#include "shapes/found_planes.h"
#include "shapes/scans.h"

namespace pcl_symmetry {
namespace {

using Cloud = SymmetryScene::Cloud;
using test::pictureOf;

/// Fewer points than by default, to save time.
SceneAnalysis analyzed(const Cloud::ConstPtr& cloud, bool frames = false,
                       const Eigen::Vector4d& ground = Eigen::Vector4d::Zero()) {
  SymmetryScene scene;
  SceneOptions options;
  options.max_points = 1000;
  options.frames = frames;
  scene.setOptions(options);
  scene.setInputCloud(cloud);
  if (!ground.isZero()) scene.setGround(ground);
  return scene.compute();
}

/// Boxes of three different sides have no other planes.
void expectPlanesAcrossAxes(const SceneObject& object) {
  for (const SymmetryPlane& plane : object.planes) {
    if (plane.kind != PlaneKind::Symmetry) continue;
    EXPECT_GT(plane.normal().cwiseAbs().maxCoeff(), std::cos(3.0 * kPi / 180.0))
        << "confidence " << plane.confidence << ", normal " << plane.normal().transpose();
  }
}

/// Two boxes apart, with room between them in the picture.
const test::Table& twoBoxes() {
  static const test::Table table({{-0.35, 0.1, 0.0}, {0.25, 0.0, 0.0}});
  return table;
}

TEST(SymmetryScene, TakesTheTableOutAndFindsWhatStandsOnIt) {
  const SceneAnalysis scene = analyzed(pictureOf(twoBoxes().scan), true);
  ASSERT_EQ(scene.supports.size(), 1u);
  EXPECT_LT((scene.supports[0].coefficients - Eigen::Vector4d(0.0, 0.0, 1.0, 0.0)).norm(), 0.02) << "toward the viewer";
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

TEST(SymmetryScene, ObjectsStandOnTheTableWithTheirFeet) {
  const Cloud::ConstPtr cloud = pictureOf(twoBoxes().scan);
  const SceneAnalysis scene = analyzed(cloud);
  ASSERT_EQ(scene.supports.size(), 1u);
  EXPECT_LT((scene.supports[0].coefficients - Eigen::Vector4d(0.0, 0.0, 1.0, 0.0)).norm(), 1e-5)
      << "points without noise";
  const auto num_feet =
      std::count_if(scene.supports[0].indices.begin(), scene.supports[0].indices.end(), [&](pcl::index_t i) {
        return twoBoxes().ids[static_cast<std::size_t>(i)] != 0 && (*cloud)[i].z > 0.25 * scene.plane_distance;
      });
  EXPECT_LE(num_feet, 8) << "single pixels on the sides of the boxes, far from their other points";
  for (const SceneObject& object : scene.objects) {
    float lowest = 1.0f;
    for (const pcl::index_t i : object.indices) lowest = std::min(lowest, (*cloud)[i].z);
    EXPECT_LT(lowest, 0.25 * scene.plane_distance) << "the rows of pixels are as far apart";
  }
}

/// The errors of structured light: 1.4 mm at 1 m, growing with the square of the depth.
/// \param window side of the square of pixels whose errors are averaged, as by sensors that match windows.
Cloud::Ptr withDepthErrors(const test::Scan& scan, int window = 1) {
  RandomStream random(5);
  Cloud::Ptr cloud = pictureOf(scan);
  Eigen::MatrixXd deviates(scan.width + window, scan.height + window);
  for (double& deviate : deviates.reshaped()) {
    deviate = -6.0;  // normal, from twelve even ones
    for (int i = 0; i < 12; ++i) deviate += random.uniform();
  }
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    pcl::PointXYZ& point = (*cloud)[i];
    if (!pcl::isXYZFinite(point)) continue;
    const auto u = static_cast<int>(i) % scan.width, v = static_cast<int>(i) / scan.width;
    const double deviate = deviates.block(u, v, window, window).sum() / window;
    const Eigen::Vector3d x = point.getVector3fMap().cast<double>();
    const double depth = (scan.T_camera_object * x).z();
    point.getVector3fMap() = (scan.viewpoint + (1.0 + 1.4e-3 * depth * deviate) * (x - scan.viewpoint)).cast<float>();
  }
  return cloud;
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
  const SceneAnalysis scene = analyzed(withDepthErrors(twoBoxes().scan));
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
  const SeenSpace seen =
      detail::standingInScene(SeenSpace(*frame), detail::ScannerOutput(*frame), twoBoxes().pixelsOf(1), 0.01);
  ASSERT_NE(seen.visibility(), nullptr);
  ASSERT_EQ(seen.visibility()->supports().size(), 1u);
  EXPECT_LT((seen.visibility()->supports()[0].head<3>() - Eigen::Vector3d::UnitZ()).norm(), 1e-3);
}

TEST(SymmetryMaximaRefinement, ErrorsOfAFrameAreTakenOutOfItsParts) {
  const Cloud::ConstPtr noisy = withDepthErrors(twoBoxes().scan);
  auto own = ofBox(noisy, 1), shared = ofBox(withoutDepthErrors(noisy, SeenSpace(*noisy)), 1);
  const std::vector<SymmetryPlane> planes = own.compute(), of_filtered = shared.compute();
  EXPECT_LT(own.getUsedIndices().size(), twoBoxes().pixelsOf(1).size()) << "pixels that fly are left out";
  ASSERT_EQ(planes.size(), of_filtered.size());
  for (std::size_t i = 0; i < planes.size(); ++i) EXPECT_EQ(planes[i].coefficients(), of_filtered[i].coefficients());
  own.setAsPublished(true);
  own.compute();
  EXPECT_EQ(own.getUsedIndices().size(), twoBoxes().pixelsOf(1).size()) << "the paper leaves them in";
}

TEST(SymmetryMaximaRefinement, DecidesAtWhatTheSensorResolves) {
  constexpr int kWindow = 3;  // errors of single pixels would be taken out
  const Cloud::ConstPtr exact = pictureOf(twoBoxes().scan), noisy = withDepthErrors(twoBoxes().scan, kWindow);
  for (const int box : {1, 2}) {
    auto clean = ofBox(exact, box);
    clean.compute();
    EXPECT_LT(clean.getDetection().resolution, 0.01 * clean.getDetection().diameter);
    EXPECT_NEAR(clean.getDetection().tolerance, 0.01 * clean.getDetection().diameter, 1e-9);
    auto blurred = ofBox(noisy, box);
    const auto planes = blurred.compute();
    EXPECT_GT(blurred.getDetection().tolerance, 0.015 * blurred.getDetection().diameter) << "errors of 4 mm at 1.8 m";
    ASSERT_FALSE(planes.empty());
    EXPECT_EQ(planes[0].kind, PlaneKind::Symmetry) << "left and right of a box";
    auto fixed = ofBox(noisy, box);
    fixed.setTolerance(0.01);
    for (const SymmetryPlane& plane : fixed.compute())
      EXPECT_NE(plane.kind, PlaneKind::Symmetry) << "the sensor does not show whether it is";
    EXPECT_NEAR(fixed.getDetection().tolerance, 0.01 * fixed.getDetection().diameter, 1e-9);
  }
}

TEST(SymmetryScene, CompletesIntoSpaceThatWasNotSeen) {
  const SceneAnalysis scene = analyzed(pictureOf(twoBoxes().scan));
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
  const SceneAnalysis scene = analyzed(points);
  EXPECT_EQ(scene.seen->source(), ViewpointSource::Stored);
  EXPECT_EQ(scene.supports.size(), 1u);
  EXPECT_EQ(scene.objects.size(), 2u);
}

TEST(SymmetryScene, TheTableAloneIsNoObject) {
  const test::Scan empty = test::scan({{{{0.0, 0.0, -0.02}, {0.7, 0.7, 0.02}}}, {}}, {0.1, -1.6, 1.0}, 0.0, 160, 120);
  const SceneAnalysis scene = analyzed(pictureOf(empty));
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
  const SceneAnalysis found = analyzed(scene);
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
    return scene.compute().objects;
  };
  const std::vector<SceneObject> one = with(1);
  ASSERT_EQ(one.size(), 2u);
  EXPECT_FALSE(one[0].models.empty());
  for (const int num_threads : {2, 3}) {  // with 3, one object after the other
    const std::vector<SceneObject> many = with(num_threads);
    ASSERT_EQ(many.size(), one.size());
    for (std::size_t k = 0; k < one.size(); ++k) {
      EXPECT_EQ(one[k].indices, many[k].indices);
      EXPECT_EQ(one[k].added.size(), many[k].added.size());
      test::expectSamePlanes(one[k].planes, many[k].planes);
      ASSERT_EQ(one[k].models.size(), many[k].models.size());
      for (std::size_t i = 0; i < one[k].models.size(); ++i) {
        const RecognizedModel &a = one[k].models[i], &b = many[k].models[i];
        EXPECT_EQ(a.name, b.name);
        EXPECT_EQ(a.T_model_scan.matrix(), b.T_model_scan.matrix());
        EXPECT_EQ(a.confidence, b.confidence);
      }
    }
  }
}

TEST(SymmetryScene, ALargeBoxIsNoTable) {
  // Its front is more than half of the picture; what lies behind the front is the rest of the box.
  const test::Scan box = test::scan(test::blockBox(), {0.8, -2.5, 1.2}, 0.0, 160, 120);
  const SceneAnalysis scene = analyzed(pictureOf(box));
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_GT(scene.objects[0].indices.size(), 0.9 * static_cast<double>(box.cloud().cols()));
}

/// Distance along a ray to where it meets a body, in lengths of the direction; infinite where it does not.
using Body = std::function<double(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction)>;

Body block(const Eigen::Vector3d& center, const Eigen::Vector3d& half, double turn = 0.0) {
  return [=](const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
    const Eigen::AngleAxisd back(-turn, Eigen::Vector3d::UnitZ());
    return test::Block{Eigen::Vector3d::Zero(), half}.hit(back * (origin - center), back * direction);
  };
}

/// Upright, from z = low to z = high.
Body uprightCylinder(const Eigen::Vector2d& axis, double radius, double low, double high) {
  return [=](const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
    const Eigen::Vector2d from = origin.head<2>() - axis, along = direction.head<2>();
    const double a = along.squaredNorm(), b = from.dot(along),
                 root = b * b - a * (from.squaredNorm() - radius * radius);
    const double wall = root >= 0.0 ? (-b - std::sqrt(root)) / a : std::numeric_limits<double>::infinity();
    const double z = origin.z() + wall * direction.z();
    if (wall > 0.0 && z >= low && z <= high) return wall;
    const double lid = (high - origin.z()) / direction.z();
    return lid > 0.0 && (from + lid * along).norm() <= radius ? lid : std::numeric_limits<double>::infinity();
  };
}

/// A frame of a camera that looks at bodies on a table, and the body that each pixel shows; -1: the table, or none.
struct Frame {
  Cloud::Ptr cloud = pcl::make_shared<Cloud>(640, 480);
  std::vector<int> ids;

  explicit Frame(const std::vector<Body>& bodies) : ids(cloud->size(), -1) {
    const Eigen::Vector3d origin(0.25, -0.75, 0.6);
    const Eigen::Matrix3d R_scene_camera =
        viewingFrame((Eigen::Vector3d(0.0, 0.0, 0.05) - origin).normalized()).transpose();
    for (std::size_t i = 0; i < cloud->size(); ++i) {
      const Eigen::Vector3d pixel(static_cast<double>(i % 640) - 319.5, static_cast<double>(i / 640) - 239.5, 700.0);
      const Eigen::Vector3d direction = R_scene_camera * pixel;
      double nearest = -origin.z() / direction.z();  // of the table, z = 0
      const Eigen::Vector2d on_table = (origin + nearest * direction).head<2>();
      if (!(nearest > 0.0) || on_table.norm() > 0.6) nearest = std::numeric_limits<double>::quiet_NaN();
      for (std::size_t k = 0; k < bodies.size(); ++k) {
        const double hit = bodies[k](origin, direction);
        if (!std::isfinite(hit) || hit >= nearest) continue;
        nearest = hit;
        ids[i] = static_cast<int>(k);
      }
      (*cloud)[i].getVector3fMap() = (origin + nearest * direction).cast<float>();
    }
    cloud->is_dense = false;
  }

  /// Body of most of the points of an object, and the share of it.
  std::pair<int, double> bodyOf(const SceneObject& object, std::size_t num_bodies) const {
    std::vector<double> counts(num_bodies, 0.0);
    for (const pcl::index_t i : object.indices)
      if (ids[i] >= 0) counts[ids[i]] += 1;
    const auto most = std::max_element(counts.begin(), counts.end());
    return {static_cast<int>(most - counts.begin()), *most / static_cast<double>(object.indices.size())};
  }
};

void expectOneObjectEach(const std::vector<Body>& bodies) {
  const Frame frame(bodies);
  const SceneAnalysis scene = analyzed(frame.cloud);
  ASSERT_EQ(scene.objects.size(), bodies.size());
  std::set<int> found;
  for (const SceneObject& object : scene.objects) {
    const auto [body, share] = frame.bodyOf(object, bodies.size());
    EXPECT_GT(share, 0.95);
    found.insert(body);
  }
  EXPECT_EQ(found.size(), bodies.size());
  ASSERT_EQ(scene.junctions.size(), bodies.size() - 1);
  for (const SceneJunction& junction : scene.junctions) {
    EXPECT_FALSE(junction.isJoined());
    EXPECT_LT(std::max(junction.first, junction.second), scene.objects.size());
    EXPECT_GE(junction.apart, 0.0);
    EXPECT_LE(junction.together, 1.0);
  }
}

TEST(SymmetryScene, BodiesThatTouchAreTwo) {
  // A box beside a box, a stack, a box before a cylinder.
  expectOneObjectEach({block({-0.1, 0.0, 0.1}, {0.1, 0.06, 0.1}), block({0.08, -0.02, 0.05}, {0.08, 0.1, 0.05})});
  expectOneObjectEach(
      {block({0.0, 0.0, 0.05}, {0.15, 0.12, 0.05}), block({0.01, 0.02, 0.15}, {0.08, 0.06, 0.05}, 0.4)});
  expectOneObjectEach({uprightCylinder({0.0, 0.1}, 0.07, 0.0, 0.2), block({0.0, -0.03, 0.05}, {0.1, 0.06, 0.05})});
}

TEST(SymmetryScene, AMugAndItsHandleAreOne) {
  const Frame frame(
      {uprightCylinder({0.0, 0.0}, 0.08, 0.0, 0.2), block({0.12, -0.04, 0.11}, {0.06, 0.012, 0.06}, -0.3)});
  const SceneAnalysis scene = analyzed(frame.cloud);
  ASSERT_EQ(scene.objects.size(), 1u);
  ASSERT_EQ(scene.junctions.size(), 1u) << "convexity cuts the handle off";
  EXPECT_TRUE(scene.junctions[0].isJoined());
  EXPECT_GT(scene.junctions[0].together, 0.9);
  ASSERT_FALSE(scene.objects[0].planes.empty());
  EXPECT_EQ(scene.objects[0].planes[0].kind, PlaneKind::Symmetry) << "through the handle";
  EXPECT_TRUE(scene.objects[0].axes.empty());
}

TEST(SymmetryScene, TheInsideOfABowlIsOne) {
  // A cone that opens upward: its inside bends inward everywhere.
  const Body bowl = [](const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
    double nearest = std::numeric_limits<double>::infinity();
    // (x^2 + y^2) = (0.05 + z / 2)^2 from z = 0 to z = 0.16; the side toward the camera first.
    const double u = 0.05 + 0.5 * origin.z(), w = 0.5 * direction.z();
    const double a = direction.head<2>().squaredNorm() - w * w, b = origin.head<2>().dot(direction.head<2>()) - u * w;
    const double root = b * b - a * (origin.head<2>().squaredNorm() - u * u);
    if (root < 0.0) return nearest;
    for (const double hit : {(-b - std::sqrt(root)) / a, (-b + std::sqrt(root)) / a}) {
      const double z = origin.z() + hit * direction.z();
      if (hit > 0.0 && z >= 0.0 && z <= 0.16) nearest = std::min(nearest, hit);
    }
    return nearest;
  };
  const Frame frame({bowl});
  for (const SceneObject& object : analyzed(frame.cloud).objects)
    EXPECT_GT(object.indices.size(), 5000u) << "in a piece";
}

TEST(SymmetryScene, KnowsTheGroundThatIsGiven) {
  const SceneAnalysis found = analyzed(pictureOf(twoBoxes().scan), false, {0.0, 0.0, -2.0, 0.0});
  ASSERT_EQ(found.supports.size(), 1u);
  EXPECT_EQ(found.supports[0].coefficients, Eigen::Vector4d(0.0, 0.0, 1.0, 0.0)) << "toward the viewer";
  EXPECT_EQ(found.objects.size(), 2u);
  EXPECT_EQ(test::messageOf([&] { SymmetryScene().setGround(Eigen::Vector4d(0.0, 0.0, 0.0, 1.0)); }),
            "ground: must be four finite numbers A,B,C,D, not all of A, B, C zero");
}

/// What the rings of a LiDAR at 0 0 0 see of vehicles around it, and of the ground 1.7 m below.
Cloud::Ptr sweep(const std::vector<Body>& bodies) {
  auto cloud = pcl::make_shared<Cloud>();
  RandomStream random(7);
  for (int ring = 0; ring < 64; ++ring)
    for (int column = 0; column < 1800; ++column) {
      const double fall = kPi / 180.0 * (-24.8 + 26.8 * ring / 63.0), turn = kPi * column / 900.0;
      const Eigen::Vector3d ray(std::cos(fall) * std::cos(turn), std::cos(fall) * std::sin(turn), std::sin(fall));
      double nearest = ray.z() < 0.0 ? -1.7 / ray.z() : std::numeric_limits<double>::infinity();
      for (const Body& body : bodies) nearest = std::min(nearest, body(Eigen::Vector3d::Zero(), ray));
      if (!(nearest < 60.0)) continue;
      nearest += 0.02 * (random.uniform() + random.uniform() + random.uniform() - 1.5);
      cloud->emplace_back(nearest * ray.x(), nearest * ray.y(), nearest * ray.z());
    }
  return cloud;
}

/// A box with a cabin behind its middle, in meters.
std::vector<Body> vehicle(double x, double y, double turn) {
  const Eigen::Vector3d back(-0.7 * std::cos(turn), -0.7 * std::sin(turn), 0.0);
  return {block({x, y, -1.15}, {2.2, 0.9, 0.4}, turn),
          block(Eigen::Vector3d(x, y, -0.5) + back, {1.2, 0.8, 0.25}, turn)};
}

TEST(SymmetryScene, FindsVehiclesAroundALidar) {
  std::vector<Body> bodies;
  const std::vector<std::array<double, 3>> poses{{9.0, 3.0, -0.6}, {-9.0, 6.0, 0.3}, {2.0, -12.0, -0.5}};
  for (const auto& [x, y, turn] : poses)
    for (const Body& part : vehicle(x, y, turn)) bodies.push_back(part);
  SymmetryScene searched;
  SceneOptions options;
  options.frames = options.complete = false;
  searched.setOptions(options);
  searched.setInputCloud(sweep(bodies));
  const SceneAnalysis scene = searched.compute();
  EXPECT_EQ(scene.seen->source(), ViewpointSource::Stored) << "amid the points";
  ASSERT_GE(scene.supports.size(), 1u);
  EXPECT_GT(scene.supports[0].coefficients[2], 0.99);
  ASSERT_EQ(scene.objects.size(), poses.size());
  for (const SceneObject& object : scene.objects) {
    ASSERT_FALSE(object.planes.empty());
    EXPECT_EQ(object.planes[0].kind, PlaneKind::Symmetry);
    const bool is_right = std::any_of(poses.begin(), poses.end(), [&](const auto& pose) {
      const Eigen::Vector3d across(-std::sin(pose[2]), std::cos(pose[2]), 0.0);
      return std::abs(across.dot(object.planes[0].normal())) > std::cos(5.0 * kPi / 180.0) &&
             std::abs(object.planes[0].signedDistance({pose[0], pose[1], -1.2})) < 0.2;
    });
    EXPECT_TRUE(is_right) << object.planes[0].coefficients().transpose();
  }
}

TEST(SymmetryMaximaRefinement, NeedsAGroundForTheBoxOfAVehicle) {
  const Cloud::ConstPtr points = sweep(vehicle(12.0, 4.0, -0.3));
  auto car = pcl::make_shared<Cloud>();
  for (const pcl::PointXYZ& point : *points)
    if (point.z > -1.5f) car->push_back(point);
  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  refinement.setInputCloud(car);
  refinement.setViewpoint(Eigen::Vector3d::Zero());
  refinement.setGround({0.0, 0.0, 1.0, 1.7});
  const auto planes = refinement.compute();
  ASSERT_EQ(planes.size(), 1u);
  EXPECT_EQ(planes[0].kind, PlaneKind::Symmetry);
  EXPECT_GT(std::abs(planes[0].normal().dot(Eigen::Vector3d(std::sin(0.3), std::cos(0.3), 0.0))), 0.99);
  EXPECT_EQ(planes[0].point_support.size(), car->size());
}

TEST(SymmetryScene, DataWithoutAnswerGiveNoObject) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(SymmetryScene().compute().objects.empty());
  EXPECT_TRUE(analyzed(pcl::make_shared<Cloud>()).objects.empty());
  EXPECT_TRUE(analyzed(pcl::make_shared<Cloud>(50, 1, pcl::PointXYZ(none, 0.0f, 0.0f))).objects.empty());
  EXPECT_TRUE(analyzed(pcl::make_shared<Cloud>(500, 1, pcl::PointXYZ(1.0f, 2.0f, 3.0f))).objects.empty());
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
