/// Single views are told from everything else by the points alone, and so is where they were taken from.
#include "core/scan/viewpoint_inference.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/scan/scan_density.h"
#include "core/scan/single_view.h"
#include "shapes/scans.h"

namespace pcl_symmetry {
namespace {

using namespace test;

const Eigen::Vector3d kElsewhere(0.1, 0.2, 0.3);  // among the points: explains none of the clouds

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::min(1.0, a.normalized().dot(b.normalized()))) / kDegree;
}

TEST(InferView, FindsTheViewpointOfAScanInAnyPose) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    RandomStream random(seed);
    const Eigen::Vector3d viewpoint = 4.0 * randomDirection(random);
    for (const BlockObject& object : {blockL(), blockChair()}) {
      const Eigen::Isometry3d pose = randomPose(seed, 3.0);
      const Points points = (pose * scan(object, viewpoint).cloud().cast<double>()).cast<float>();
      const auto view = inferView(points, kElsewhere);
      ASSERT_TRUE(view) << seed;
      EXPECT_FALSE(view->as_stored);
      const Eigen::Vector3d center = boundingBall(points).center;
      // Measured: at most 11 degrees with three directions of the surface, 1 in the middle for curved objects.
      EXPECT_LT(angleBetween(view->position - center, pose * viewpoint - center), 15.0) << seed;
      EXPECT_LT((view->seen.viewpoint() - view->position).norm(), 1e-9) << seed;
    }
  }
}

TEST(InferView, PrefersTheStoredViewpointWhereItIsTrue) {
  const Eigen::Vector3d viewpoint(2.5, -3.0, 2.0);
  const auto view = inferView(scan(blockL(), viewpoint).cloud(), viewpoint);
  ASSERT_TRUE(view);
  EXPECT_TRUE(view->as_stored);
  EXPECT_EQ(view->position, viewpoint);
}

TEST(InferView, FindsNoneForWires) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    RandomStream random(seed);
    Points wire(3, 40 + 40 * static_cast<int>(seed));
    for (Eigen::Index i = 0; i < wire.cols(); ++i) {
      const double t = random.uniform(), angle = 5.0 * t;
      wire.col(i) =
          Eigen::Vector3d((0.3 + t) * std::cos(angle), (0.3 + t) * std::sin(angle), t + 0.003 * gaussian(random))
              .cast<float>();
    }
    EXPECT_FALSE(inferView(wire, kElsewhere)) << seed;
  }
}

TEST(InferView, FindsNoneForWholeObjects) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    for (const int count : {1000, 10'000})
      for (const Shape& shape : {box(count, Sampling::Random, seed), sphere(count, seed), cylinder(count, seed),
                                 scaleneTetrahedron(count, seed)}) {
        const Points cloud = shape.cloud();
        EXPECT_FALSE(inferView(cloud, Eigen::Vector3d::Zero())) << seed << ", " << count;
        EXPECT_FALSE(inferView(cloud, {3.0, 1.0, 2.0})) << seed << ", " << count;
      }
}

TEST(InferView, FindsNoneForOpenShellsAndSheets) {
  // Half a sphere and a sheet are seen once from many positions. Their even density is not that of a scan.
  const Points whole = sphere(20'000, 1).cloud();
  EXPECT_FALSE(inferView(facing(whole, {0.0, 0.0, 100.0}), {0.0, 0.0, 4.0}));
  RandomStream random(6);
  Points sheet(3, 4000);
  for (Eigen::Index i = 0; i < sheet.cols(); ++i)
    sheet.col(i) = Eigen::Vector3d(symmetric(random), symmetric(random), 0.0).cast<float>();
  EXPECT_FALSE(inferView(sheet, {0.0, 0.0, 4.0}));
}

TEST(InferView, FindsNoneForTwoViewsPutTogether) {
  for (const Eigen::Vector3d& second : {Eigen::Vector3d(-2.5, -3.0, 2.0), Eigen::Vector3d(-2.5, 3.0, -2.0)}) {
    for (const BlockObject& object : {blockBox(), blockL(), blockChair()}) {
      const Points a = scan(object, {2.5, -3.0, 2.0}).cloud(), b = scan(object, second).cloud();
      Points both(3, a.cols() + b.cols());
      both << a, b;
      EXPECT_FALSE(inferView(both, kElsewhere)) << second.transpose();
    }
  }
}

TEST(InferView, FewOrDegeneratePointsHaveNone) {
  EXPECT_FALSE(inferView(Points(3, 0), kElsewhere));
  EXPECT_FALSE(inferView(Points::Ones(3, 100), kElsewhere));
  EXPECT_FALSE(inferView(Points::Random(3, 19), kElsewhere));
}

TEST(SpaceSeenFrom, AcceptsTheTrueOneOfAScan) {
  const Points whole = sphere(20'000, 1).cloud();  // its normals are the points
  const Eigen::Vector3d far(0.5, -1.0, -5.0);
  EXPECT_TRUE(spaceSeenFrom(facing(whole, far), far));
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    RandomStream random(seed);
    const Eigen::Vector3d viewpoint = 4.0 * randomDirection(random);
    for (const BlockObject& object : {blockBox(), blockL(), blockChair()})
      EXPECT_TRUE(spaceSeenFrom(scan(object, viewpoint).cloud(), viewpoint)) << seed;
  }
}

TEST(SpaceSeenFrom, RefusesWholeObjectsFromAnywhere) {
  for (const Shape& shape : {box(10'000, Sampling::Random, 1), sphere(10'000, 2), scaleneTetrahedron(10'000, 3),
                             prism(6, 1000, Sampling::Random, 4)}) {
    const Points cloud = shape.cloud();
    EXPECT_FALSE(spaceSeenFrom(cloud, Eigen::Vector3d::Zero()));
    EXPECT_FALSE(spaceSeenFrom(cloud, centerOfMass(cloud)));
    for (const double distance : {0.3, 1.5, 3.0, 30.0, 1000.0}) {
      RandomStream random(7);
      for (int i = 0; i < 5; ++i)
        EXPECT_FALSE(spaceSeenFrom(cloud, centerOfMass(cloud) + distance * randomDirection(random)))
            << distance << ", " << i;
    }
  }
}

TEST(SpaceSeenFrom, RefusesThinObjectsFromAnywhere) {
  // 0.06 thick, a twentieth of the radius: less than hiddenShare() would notice. The points are 0.026 apart.
  const Points plate = box({1.0, 0.8, 0.03}, 10'000, Sampling::Random, 5).cloud();
  RandomStream random(3);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d viewpoint = 3.0 * randomDirection(random);
    EXPECT_FALSE(spaceSeenFrom(plate, viewpoint)) << i;
    EXPECT_FALSE(spaceSeenFrom(plate * 1e6f, viewpoint * 1e6)) << i;
  }
}

TEST(SpaceSeenFrom, AcceptsNoisyScans) {
  const Eigen::Vector3d viewpoint(2.0, -3.0, 1.5);
  Points points = scan(blockChair(), viewpoint).cloud();
  RandomStream random(4);
  const double sigma = 0.005 * diagonal(points);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d ray = (points.col(i).cast<double>() - viewpoint).normalized();
    points.col(i) += (sigma * gaussian(random) * ray).cast<float>();
  }
  EXPECT_TRUE(spaceSeenFrom(points, viewpoint));
}

TEST(CutShare, IsOfTheOutlineBesideWhichThePictureEnds) {
  // A square of 40 x 40 pixels, one unit away, in a picture without other depths.
  const auto cutAt = [](int first) {
    Visibility::Projection projection = Visibility::Projection::Identity();
    projection.leftCols<3>() << 100.0, 0.0, 49.5, 0.0, 100.0, 49.5, 0.0, 0.0, 1.0;
    std::vector<float> depths(100 * 100, Visibility::kNoRay);
    Points points(3, 40 * 40);
    for (int i = 0; i < 1600; ++i) {
      const int u = first + i % 40, v = first + i / 40;
      depths[100 * v + u] = 1.0f;
      points.col(i) << (static_cast<float>(u) - 49.5f) / 100.0f, (static_cast<float>(v) - 49.5f) / 100.0f, 1.0f;
    }
    return cutShare(points, Visibility(projection, 100, 100, depths), 0.1);
  };
  EXPECT_EQ(cutAt(30), 0.0);
  EXPECT_NEAR(cutAt(0), 0.5, 0.1);
}

TEST(LayeredShare, CountsLayers) {
  RandomStream random(6);
  Points points(3, 4000);
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    points.col(i) = Eigen::Vector3d(symmetric(random), symmetric(random), 0.0).cast<float>();
  const Eigen::Vector3d viewpoint(0.1, 0.2, 50.0);
  EXPECT_EQ(layeredShare(points, viewpoint), 0.0) << "a flat sheet";
  for (Eigen::Index i = 0; i < points.cols(); i += 2) points(2, i) = -0.5f;
  // Two layers of equal density: the next point in the picture is of the other one every second time. Its error is
  // that of 2000 throws, 0.011, and neighbors in pairs.
  EXPECT_NEAR(layeredShare(points, viewpoint), 0.5, 0.05);
  EXPECT_EQ(layeredShare(Points::Ones(3, 1), viewpoint), 0.0);
  EXPECT_EQ(layeredShare(Points::Ones(3, 10), viewpoint), 0.0) << "no extent";
}

TEST(ScanDensity, FallsWithSlantAndDistance) {
  const Eigen::Vector3d viewpoint(2.5, -3.0, 2.0);
  const ScanDensity density(scan(blockBox(), viewpoint).cloud());
  // The three faces slant by 50 degrees on average and differ by a factor of 1.5 in cos a / d^2.
  EXPECT_GT(density.variance(), 0.01);
  EXPECT_LT(density.unexplained(viewpoint), 0.1 * density.variance());
  EXPECT_LT(density.unexplainedByPatches(viewpoint), 0.005);
  EXPECT_GT(density.unexplained(-viewpoint), 10.0 * density.unexplained(viewpoint)) << "from behind";
  EXPECT_GT(density.unexplained(0.6 * viewpoint), 2.0 * density.unexplained(viewpoint)) << "from too near";
}

TEST(ScanDensity, TwoFlatFacesAreAsDenseFromSeveralPlaces) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    RandomStream random(seed);
    Eigen::Vector3d along = randomDirection(random);
    along.z() = 0.0;  // level with the box: it shows two faces
    const Eigen::Vector3d viewpoint = 4.0 * along.normalized();
    const ScanDensity density(scan(blockBox(), viewpoint).cloud());
    const std::vector<Eigen::Vector3d> found = density.viewpoints(density.unexplained(viewpoint) + 2e-3);
    double nearest = -1.0;
    for (const Eigen::Vector3d& position : found)
      nearest = std::max(
          nearest,
          (position - density.ball().center).normalized().dot((viewpoint - density.ball().center).normalized()));
    // Measured: at most 9 degrees.
    EXPECT_GT(nearest, std::cos(15.0 * kDegree)) << seed << ": " << found.size();
  }
  EXPECT_TRUE(ScanDensity(Points::Ones(3, 5)).viewpoints(1.0).empty());
}

TEST(ScanDensity, EvenPointsHaveNothingToExplain) {
  // The density of 16 neighbors of random points has a variance of 1 / 16, less without its tails.
  const ScanDensity density(box(10'000, Sampling::Random, 1).cloud());
  EXPECT_LT(density.variance(), 1.0 / 16.0);
  RandomStream random(4);
  for (int i = 0; i < 20; ++i)
    EXPECT_GT(density.unexplained(4.0 * randomDirection(random)), 0.9 * density.variance()) << i;
}

TEST(ScanDensity, TooFewPointsAndPointsWithoutExtentHaveNoViewpoint) {
  EXPECT_FALSE(ScanDensity(Points(3, 0)).bestViewpoint());
  EXPECT_FALSE(ScanDensity(Points::Random(3, 10)).bestViewpoint());
  EXPECT_FALSE(ScanDensity(Points::Ones(3, 500)).bestViewpoint());
  Points line = Points::Zero(3, 500);
  line.row(0).setLinSpaced(0.0f, 1.0f);
  EXPECT_FALSE(ScanDensity(line).bestViewpoint()) << "no surface";
  EXPECT_TRUE(std::isinf(ScanDensity(line).unexplained({5.0, 0.0, 0.0})));
}

}  // namespace
}  // namespace pcl_symmetry
