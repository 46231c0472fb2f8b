#include "pcl_symmetry/core/visibility.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "shapes/scans.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Eigen::Vector3d kViewpoint(0.5, -1.0, -5.0);

Points spherePoints(int num_points = 20'000) {
  return sphere(num_points, 1).cloud();
}

/// The half of the unit sphere that faces the viewpoint; its normals are the points.
Points sphereScan(const Eigen::Vector3d& viewpoint = kViewpoint) {
  return facing(spherePoints(), viewpoint);
}

/// Where rays of the viewpoint meet the sphere, no farther than 0.6 from the middle of its picture.
std::vector<Eigen::Vector3d> hits() {
  const Eigen::Vector3d forward = -kViewpoint.normalized(), u = forward.unitOrthogonal(), v = forward.cross(u);
  std::vector<Eigen::Vector3d> points;
  for (int i = -3; i <= 3; ++i)
    for (int j = -3; j <= 3; ++j)
      if (std::hypot(i, j) <= 3.0) {
        const Eigen::Vector3d across = 0.2 * i * u + 0.2 * j * v;
        points.push_back(across - std::sqrt(1.0 - across.squaredNorm()) * forward);
      }
  return points;
}

TEST(Visibility, KnowsTheErrorsOfDepthsInAnyFrame) {
  Visibility::Projection projection = Visibility::Projection::Zero();
  projection.leftCols<3>() = Eigen::Matrix3d::Identity();  // looks along z
  const Visibility exact(projection, 1, 1, {2.0f});
  EXPECT_EQ(exact.depthError({0.0, 0.0, 2.0}), 0.0);
  const Visibility seen = exact.withDepthErrors(1.5e-3);
  EXPECT_NEAR(seen.depthError({0.1, 0.0, 2.0}), 6e-3, 1e-12) << "1.5e-3 / m at 2 m";
  const Visibility scaled = seen.normalized({0.0, 0.0, 1.0}, 0.5);
  EXPECT_NEAR(scaled.depthError({0.0, 0.0, 2.0}), 12e-3, 1e-12) << "the same point, in units of 0.5 m";
}

TEST(Visibility, FrontIsFreeBehindIsUnknownBesideIsFree) {
  const auto seen = Visibility::fromPoints(sphereScan(), kViewpoint);
  ASSERT_TRUE(seen);
  // Pixels hold 4 of 10^4 points on the half sphere of area 2 pi: they are 0.028 to 0.04 wide. A surface that slants
  // by 0.75 and more (rays diverge) is 0.03 deep in one, and twice as deep where the closing looked a pixel farther.
  constexpr double kPixelDepth = 0.06;
  for (const Eigen::Vector3d& hit : hits()) {
    const Eigen::Vector3d forward = -kViewpoint.normalized(),
                          ray = (hit - kViewpoint) / (hit - kViewpoint).dot(forward);
    if (seen->depthBehind(hit) == -kInfinity) continue;  // holes have their own test
    for (const double depth : {-3.0, -0.5, -0.1, 0.1, 0.5, 3.0})
      EXPECT_NEAR(seen->depthBehind(hit + depth * ray), depth, kPixelDepth);
  }
  const Eigen::Vector3d across = kViewpoint.unitOrthogonal();
  for (const double distance : {1.2, 2.0, 50.0}) {
    EXPECT_EQ(seen->depthBehind(distance * across), -kInfinity) << distance;
    EXPECT_EQ(seen->depthBehind(-distance * across), -kInfinity) << distance;
  }
  EXPECT_EQ(seen->depthBehind(2.0 * kViewpoint), kInfinity) << "behind the viewer";
  EXPECT_LT((seen->viewpoint() - kViewpoint).norm(), 1e-12);
  const Eigen::Vector3d center(0.3, -2.0, 7.0);
  EXPECT_LT((seen->normalized(center, 3.5).viewpoint() - (kViewpoint - center) / 3.5).norm(), 1e-12);
}

TEST(Visibility, ASurfaceHasNoHoles) {
  // Points of a curved surface are not spread evenly over the picture: where they are sparse there are no holes either.
  const Eigen::Vector3d forward = -kViewpoint.normalized(), u = forward.unitOrthogonal(), v = forward.cross(u);
  for (const int num_points : {2000, 20'000, 100'000}) {
    const Points points = spherePoints(num_points);
    const auto seen = Visibility::fromPoints(facing(points, kViewpoint), kViewpoint);
    ASSERT_TRUE(seen);
    int num_rays = 0, num_through = 0;
    for (double a = -0.8; a <= 0.8; a += 0.02)
      for (double b = -0.8; b <= 0.8; b += 0.02) {
        if (std::hypot(a, b) > 0.8) continue;
        ++num_rays;
        num_through += seen->depthBehind(a * u + b * v) == -kInfinity ? 1 : 0;
      }
    EXPECT_LT(num_through, 0.002 * num_rays) << num_points << " points: rays that pass through the sphere";
  }
}

TEST(Visibility, SeesNothingFromInsideAndOfNoPoints) {
  EXPECT_FALSE(Visibility::fromPoints(spherePoints(), Eigen::Vector3d::Zero()));
  EXPECT_FALSE(Visibility::fromPoints(spherePoints(), Eigen::Vector3d(0.5, 0.2, 0.1)));
  EXPECT_FALSE(Visibility::fromPoints(spherePoints(), Eigen::Vector3d(0.99, 0.0, 0.0)));
  // From a distance of 1.02 a sphere is seen within asin(1 / 1.02) = 79 degrees, from 1.05 within 72.
  EXPECT_FALSE(Visibility::fromPoints(spherePoints(), Eigen::Vector3d(1.02, 0.0, 0.0)));
  EXPECT_TRUE(Visibility::fromPoints(spherePoints(), Eigen::Vector3d(1.05, 0.0, 0.0)));
  EXPECT_FALSE(Visibility::fromPoints(Points(3, 0), Eigen::Vector3d::Ones()));
  EXPECT_FALSE(spaceSeenFrom(Points(3, 0), Eigen::Vector3d::Ones()));
  Points points = sphereScan();
  points(0, 1) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(Visibility::fromPoints(points, kViewpoint));
}

TEST(Visibility, OnePointIsOnePixel) {
  const Points point = Points::Constant(3, 1, 1.0f);
  EXPECT_FALSE(Visibility::fromPoints(point, Eigen::Vector3d::Ones())) << "from the point itself";
  const auto seen = Visibility::fromPoints(point, Eigen::Vector3d::Zero());
  ASSERT_TRUE(seen);
  EXPECT_LT(seen->depthBehind(Eigen::Vector3d::Constant(0.9)), 0.0);
  EXPECT_GT(seen->depthBehind(Eigen::Vector3d::Constant(1.1)), 0.0);
  EXPECT_TRUE(Visibility::fromPoints(Points::Constant(3, 100, 1.0f), Eigen::Vector3d::Zero()));
}

TEST(Visibility, UnknownRaysSayNothing) {
  Visibility::Projection projection = Visibility::Projection::Identity();  // looks along z from the origin
  const Visibility seen(projection, 3, 1, {Visibility::kNoRay, 2.0f, Visibility::kBackground});
  EXPECT_EQ(seen.depthBehind({0.0, 0.0, 1.0}), kInfinity);
  EXPECT_EQ(seen.depthBehind({0.0, 0.0, 100.0}), kInfinity);
  EXPECT_DOUBLE_EQ(seen.depthBehind({1.5, 0.0, 1.5}), -0.5);
  EXPECT_DOUBLE_EQ(seen.depthBehind({3.0, 0.0, 3.0}), 1.0);
  EXPECT_EQ(seen.depthBehind({20.0, 0.0, 10.0}), -kInfinity);
  EXPECT_EQ(seen.depthBehind({0.0, 5.0, 1.0}), kInfinity) << "beyond the picture";
  const Visibility wide(projection, 1, 1, {2.0f}, Visibility::kBackground);
  EXPECT_EQ(wide.depthBehind({0.0, 5.0, 1.0}), -kInfinity);
}

TEST(Visibility, RefusesAPictureThatDoesNotFit) {
  const Visibility::Projection projection = Visibility::Projection::Identity();
  EXPECT_THROW(Visibility(projection, 0, 0, {}), std::invalid_argument);
  EXPECT_THROW(Visibility(projection, 2, 2, {1.0f, 1.0f, 1.0f}), std::invalid_argument);
  EXPECT_THROW(Visibility(projection, -1, -1, {1.0f}), std::invalid_argument);
}

TEST(Visibility, HiddenShareTellsAScanFromAWhole) {
  const Points half = sphereScan(), whole = spherePoints();
  // A pixel 0.05 wide is deeper than that where the surface slants by more than 63 degrees, on the outer 0.37 of the
  // half sphere: 0.10 was measured with pixels of 4 points.
  EXPECT_LT(Visibility::fromPoints(half, kViewpoint)->hiddenShare(half, 0.1), 0.12);
  // Of a sphere half lies behind, all of it but a rim of height 0.1 or so: 0.45.
  const double hidden = Visibility::fromPoints(whole, kViewpoint)->hiddenShare(whole, 0.1);
  EXPECT_GT(hidden, 0.3);
  EXPECT_LT(hidden, 0.6);
}

TEST(Visibility, OutsideThePictureOfASceneNothingIsKnown) {
  const Table table;
  const auto scene = Visibility::ofScene(table.scan.cloud(), table.scan.viewpoint);
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->numPictures(), 1u);
  for (const Eigen::Vector3d& x :
       {Eigen::Vector3d(3.0, 0.0, 0.0), Eigen::Vector3d(-3.0, 0.0, 0.5), Eigen::Vector3d(0.0, 0.0, 9.0)})
    EXPECT_EQ(scene->depthBehind(x), kInfinity);
  EXPECT_LT(scene->depthBehind({0.0, -0.8, 0.5}), 0.0) << "between the camera and the table";
}

TEST(Visibility, AScannerMayStandInTheMiddleOfItsScene) {
  const Points room = 3.0f * spherePoints();
  const Eigen::Vector3d viewpoint(0.3, -0.2, 0.1);
  const auto seen = Visibility::ofScene(room, viewpoint);
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->numPictures(), 6u);
  RandomStream random(4);
  int num_wrong = 0;
  constexpr int kTrials = 5000;
  for (int i = 0; i < kTrials; ++i) {
    const Eigen::Vector3d direction = randomDirection(random);
    num_wrong += seen->depthBehind(2.5 * direction) < 0.0 ? 0 : 1;
    num_wrong += seen->depthBehind(3.5 * direction) > 0.0 ? 0 : 1;
  }
  EXPECT_LT(num_wrong, 0.01 * 2 * kTrials) << "but at the rims of the pictures, where cells are cut";
}

TEST(Visibility, FreeIsWhatAnyScannerSawToBeFree) {
  const Table table;
  const Scan other = scan(table.blocks, {-0.3, 1.7, 0.9}, 0.0, 320, 240);
  const Visibility one = table.scan.visibility(), two = other.visibility(), both = Visibility::together({one, two});
  EXPECT_EQ(both.numPictures(), 2u);
  const Eigen::Vector3d center(0.1, 0.2, 0.3);
  const double scale = 2.5;
  const Visibility moved = both.normalized(center, scale);
  RandomStream random(5);
  int num_more = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d x = 0.6 * randomPoint(random);
    const bool is_free = both.depthBehind(x) < 0.0;
    EXPECT_EQ(is_free, one.depthBehind(x) < 0.0 || two.depthBehind(x) < 0.0);
    if (std::abs(both.depthBehind(x)) > 1e-5) {
      EXPECT_EQ(is_free, moved.depthBehind((x - center) / scale) < 0.0);
    }
    num_more += is_free && !(one.depthBehind(x) < 0.0) ? 1 : 0;
  }
  EXPECT_GT(num_more, 50) << "the second scanner sees behind the boxes";
  EXPECT_THROW(Visibility::together({}), std::invalid_argument);
}

TEST(Visibility, ASceneKeepsToItsPixels) {
  const Points points = spherePoints().colwise() + Eigen::Vector3f(0.0f, 0.0f, 5.0f);
  for (const std::size_t max_pixels : {std::size_t{16}, std::size_t{1000}, std::size_t{10'000}}) {
    const auto seen = Visibility::ofScene(points, Eigen::Vector3d::Zero(), max_pixels);
    ASSERT_TRUE(seen);
    EXPECT_LE(static_cast<std::size_t>(seen->width()) * static_cast<std::size_t>(seen->height()), max_pixels);
  }
  EXPECT_THROW(Visibility::ofScene(points, Eigen::Vector3d::Zero(), 15), std::invalid_argument);
  EXPECT_FALSE(Visibility::ofScene(Points(3, 0), Eigen::Vector3d::Zero()));
  EXPECT_FALSE(Visibility::ofScene(Points::Zero(3, 5), Eigen::Vector3d::Zero())) << "all points at the viewpoint";
}

TEST(Visibility, NoObjectReachesIntoItsTable) {
  const Table table;
  constexpr double kMargin = 0.01;
  const Visibility seen = table.scan.visibility();
  const Visibility on_table = seen.withSupport(Eigen::Vector4d::UnitZ(), kMargin);
  const Eigen::Vector3d center(0.2, -0.1, 0.4), below(0.0, 0.1, -0.1);
  EXPECT_GT(seen.depthBehind(below), 0.0) << "hidden by the table";
  EXPECT_NEAR(on_table.depthBehind(below), -0.1 + kMargin, 1e-12);
  EXPECT_NEAR(on_table.normalized(center, 2.0).depthBehind((below - center) / 2.0), (-0.1 + kMargin) / 2.0, 1e-12);
  const Eigen::Vector3d inside(0.0, 0.1, 0.1), at_foot(0.0, 0.1, -0.5 * kMargin);
  EXPECT_EQ(on_table.depthBehind(inside), seen.depthBehind(inside));
  EXPECT_EQ(on_table.depthBehind(at_foot), seen.depthBehind(at_foot));
}

/// What a scanner with rings sees of a round disc before a wall: it stands at the origin and looks along z.
struct RingScan {
  static constexpr double kColumn = 0.1 * M_PI / 180.0;  // radians between the rays of a ring
  static constexpr double kRadius = 0.4, kDisc = 2.0, kWall = 3.0;
  double ring;  // radians between rings
  Eigen::Matrix3d turned;
  Points points;

  /// \param roll of the rings about the direction of view, radians.
  RingScan(double ring_step, double roll)
      : ring(ring_step), turned(Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ())), points(3, 200'000) {
    constexpr double kAcross = 0.35, kUp = 0.23;
    Eigen::Index size = 0;
    for (double up = -kUp; up <= kUp; up += ring)
      for (double across = -kAcross; across <= kAcross; across += kColumn) {
        const Eigen::Vector3d ray(std::tan(across), std::tan(up) / std::cos(across), 1.0);
        points.col(size++) = (turned * (onDisc(ray) ? kDisc : kWall) * ray).cast<float>();
      }
    points.conservativeResize(3, size);
  }

  static bool onDisc(const Eigen::Vector3d& ray) { return kDisc * ray.head<2>().norm() < kRadius; }
};

TEST(Visibility, RingsLeaveNoHolesBetweenThem) {
  for (const double ring_step : {0.4, 1.8}) {  // degrees: 64 and 16 rings on a car
    for (const double roll : {0.0, 0.4}) {
      const RingScan rings(ring_step * M_PI / 180.0, roll);
      const auto seen = Visibility::ofScene(rings.points, Eigen::Vector3d::Zero());
      ASSERT_TRUE(seen);
      RandomStream random(6);
      for (int i = 0; i < 5000; ++i) {
        // Rings cover 0.23 up and down, and 0.15 (cos 0.4 + sin 0.4) = 0.197.
        const Eigen::Vector3d ray(0.15 * symmetric(random), 0.15 * symmetric(random), 1.0);
        EXPECT_GT(seen->depthBehind(1.01 * RingScan::kWall * ray), 0.0) << "behind the wall";
        EXPECT_LT(seen->depthBehind(0.99 * RingScan::kDisc * ray), 0.0) << "in front of both";
        const double off = RingScan::kDisc * ray.head<2>().norm() - RingScan::kRadius;
        if (std::abs(off) <= 2.0 * rings.ring * RingScan::kDisc) continue;
        EXPECT_GT(seen->depthBehind(2.5 * ray) * (off < 0.0 ? 1.0 : -1.0), 0.0) << "behind the disc, or beside it";
      }
    }
  }
}

TEST(Visibility, OfManyPointsIsThatOfEach) {
  const Visibility one = *Visibility::fromPoints(sphereScan(), kViewpoint);
  const Visibility two = Visibility::together({one, *Visibility::fromPoints(sphereScan(-kViewpoint), -kViewpoint)});
  RandomStream random(6);
  const Eigen::Matrix3Xd points = Eigen::Matrix3Xd::NullaryExpr(3, 500, [&] { return 6.0 * symmetric(random); });
  for (const Visibility& visibility :
       {one, two, one.withSupport(Eigen::Vector4d(0.0, 0.0, 1.0, 1.0), 0.1), one.normalized({1.0, 2.0, 3.0}, 2.0)}) {
    const std::vector<char> are_free = visibility.areFree(points);
    for (Eigen::Index i = 0; i < points.cols(); ++i)
      EXPECT_EQ(are_free[static_cast<std::size_t>(i)] != 0, visibility.depthBehind(points.col(i)) < 0.0) << i;
    EXPECT_GT(meanOf(are_free), 0.1);
    EXPECT_LT(meanOf(are_free), 1.0);
  }
}

}  // namespace
