/// What a scan tells of its scanner: where it stood, which errors its depths have, and which sides its picture cuts.
#include "core/scan/viewpoint_inference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "core/scan/depth_filter.h"
#include "core/scan/range_image.h"
#include "core/scan/scan_density.h"
#include "pcl_symmetry/core/visibility.h"
#include "shapes/scans.h"
#include "shapes/threads.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

const Eigen::Vector3d kElsewhere(0.1, 0.2, 0.3);  // among the points: explains none of the clouds

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::min(1.0, a.normalized().dot(b.normalized()))) / kDegree;
}

TEST(InferView, FindsTheViewpointOfAScanInAnyPose) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    RandomStream random(seed);
    const Eigen::Vector3d viewpoint = 4.0 * randomDirection(random);
    for (const BlockObject& object : {blockL(), blockChair()}) {
      const Eigen::Isometry3d pose = randomPose(seed, 3.0);
      const Points points = moved(scan(object, viewpoint).cloud(), pose);
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

// A half pipe, bent so that its ends come toward the scanner: parallel rays leave the same density from behind.
TEST(InferView, ParallelRaysCameFromTheSideThatTheSurfaceBulgesTo) {
  constexpr int kRows = 41, kColumns = 121;
  Points points(3, kRows * kColumns);
  for (int i = 0; i < kRows * kColumns; ++i) {
    const double x = 0.045 * (i % kColumns - 60), y = 0.045 * (i / kColumns - 20);
    points.col(i) = Eigen::Vector3d(x, y, std::sqrt(1.0 - y * y) + 0.03 * x * x).cast<float>();
  }
  for (const double side : {1.0, -1.0}) {
    Points turned = points;
    turned.bottomRows<2>() *= static_cast<float>(side);
    const auto view = inferView(turned, kElsewhere);
    ASSERT_TRUE(view);
    EXPECT_LT(angleBetween(view->position, {0.0, 0.0, side}), 15.0);
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
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    RandomStream random(seed);
    const Eigen::Vector3d viewpoint = 4.0 * randomDirection(random);
    for (const BlockObject& object : {blockBox(), blockL(), blockChair()})
      EXPECT_TRUE(spaceSeenFrom(scan(object, viewpoint).cloud(), viewpoint)) << seed;
  }
}

TEST(SpaceSeenFrom, RefusesWholeObjectsFromAnywhere) {
  for (const Shape& shape : {box(3000, Sampling::Random, 1), sphere(3000, 2), scaleneTetrahedron(3000, 3),
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
  const auto cutAt = [](int first, bool is_of_points = false) {
    Visibility::Projection projection = Visibility::Projection::Identity();
    projection.leftCols<3>() << 100.0, 0.0, 49.5, 0.0, 100.0, 49.5, 0.0, 0.0, 1.0;
    std::vector<float> depths(100 * 100, Visibility::kNoRay);
    Points points(3, 40 * 40);
    for (int i = 0; i < 1600; ++i) {
      const int u = first + i % 40, v = first + i / 40;
      depths[100 * v + u] = 1.0f;
      points.col(i) << (static_cast<float>(u) - 49.5f) / 100.0f, (static_cast<float>(v) - 49.5f) / 100.0f, 1.0f;
    }
    if (is_of_points) return cutShare(points, *Visibility::ofScene(points, Eigen::Vector3d::Zero()));
    return cutShare(points, Visibility(projection, 100, 100, depths));
  };
  EXPECT_EQ(cutAt(30), 0.0);
  EXPECT_NEAR(cutAt(0), 0.5, 0.1);
  EXPECT_EQ(cutAt(0, true), 0.0) << "the points end, not the picture";
}

TEST(LayeredShare, CountsLayers) {
  Points points = flatSquare(4000, 6);
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
    const Eigen::Vector3d center = density.ball().center;
    EXPECT_TRUE(std::any_of(found.begin(), found.end(),
                            [&](const Eigen::Vector3d& position) {
                              return angleBetween(position - center, viewpoint - center) <
                                     15.0;  // measured: at most 9 degrees
                            }))
        << seed << ": " << found.size();
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

constexpr int kWidth = 80, kHeight = 60;
constexpr double kPixelAngle = 1.0 / 500.0;
constexpr double kError = 1.5e-3;  // of inverse depths, per meter: 1.5 mm at 1 m, as of structured light

using DepthOf = std::function<double(int u, int v)>;

DepthImage depthImage(const DepthOf& depth_of) {
  DepthImage image{kWidth, kHeight, {}, kPixelAngle};
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u) image.depths.push_back(static_cast<float>(depth_of(u, v)));
  return image;
}

DepthImage noisy(DepthImage image) {
  RandomStream random(7);
  for (float& depth : image.depths) depth = static_cast<float>(1.0 / (1.0 / depth + kError * gaussian(random)));
  return image;
}

/// A floor that rises toward the back: its inverse depths grow evenly.
double slanted(int, int v) {
  return 1.0 / (0.8 + 0.004 * v);
}

/// Two walls, one 10 cm before the other.
double step(int u, int) {
  return u < kWidth / 2 ? 0.9 : 1.0;
}

double rootMeanSquare(const std::vector<float>& depths, const DepthOf& truth) {
  std::vector<double> sq_errors;
  for (int i = 0; i < kWidth * kHeight; ++i)
    if (!std::isnan(depths[i])) sq_errors.push_back(std::pow(depths[i] - truth(i % kWidth, i / kWidth), 2.0));
  return std::sqrt(meanOf(sq_errors));
}

TEST(DepthFilter, FindsTheErrorsOfTheCameraOnSlantedPlanes) {
  EXPECT_NEAR(inverseDepthError(noisy(depthImage(slanted))), kError, 0.1 * kError) << "4600 second differences";
  EXPECT_NEAR(inverseDepthError(noisy(depthImage(step))), kError, 0.1 * kError) << "an edge is no error";
  EXPECT_LT(inverseDepthError(depthImage(slanted)), 1e-5) << "rounding to float";
  const DepthImage round = depthImage([](int u, int v) { return 1.0 + 1e-3 * (u * u + v * v); });
  EXPECT_EQ(inverseDepthError(round), 0.0) << "a shape bends more over more pixels";
}

TEST(DepthFilter, LeavesAThirdOfTheErrors) {
  // The mean of 25 pixels has a fifth of the error; weights and the ends of the picture cost some of it.
  for (const DepthOf& truth : {DepthOf(slanted), DepthOf(step)}) {
    const DepthImage image = noisy(depthImage(truth));
    const FilteredDepths filtered = filterDepths(image, 2, 1);
    EXPECT_LT(rootMeanSquare(filtered.depths, truth), rootMeanSquare(image.depths, truth) / 3.0);
    EXPECT_LT(static_cast<double>(filtered.num_flying), 0.03 * kWidth * kHeight)
        << "1.2 % of normal errors are as great";
  }
}

TEST(DepthFilter, TakesFlyingPixelsOut) {
  DepthImage image = noisy(depthImage(step));
  RandomStream random(3);
  for (int i = kWidth / 2; i < kWidth * kHeight; i += kWidth)
    image.depths[i] = static_cast<float>(0.93 + 0.04 * random.uniform());
  const FilteredDepths filtered = filterDepths(image, 2, 1);
  int num_left = 0;
  for (int i = kWidth / 2; i < kWidth * kHeight; i += kWidth) num_left += std::isnan(filtered.depths[i]) ? 0 : 1;
  EXPECT_LE(num_left, 0.1 * kHeight);
}

TEST(DepthFilter, PixelsWithoutAPointHaveNone) {
  DepthImage image = noisy(depthImage(slanted));
  image.depths[5] = std::numeric_limits<float>::quiet_NaN();
  image.depths[6] = std::numeric_limits<float>::infinity();
  image.depths[7] = -1.0f;
  const FilteredDepths filtered = filterDepths(image, 2, 1);
  for (const std::size_t i : {5u, 6u, 7u}) EXPECT_TRUE(std::isnan(filtered.depths[i])) << i;
  const DepthImage empty = depthImage([](int, int) { return std::numeric_limits<double>::quiet_NaN(); });
  EXPECT_EQ(filterDepths(empty, 2, 1).inverse_error, 0.0);
  EXPECT_EQ(inverseDepthError({1, 1, {1.0f}, kPixelAngle}), 0.0);
}

TEST(SensorNoise, NeighborsShareErrors) {
  // Means of three by three pixels have a third of the error, which pixels that are six apart do not share.
  DepthImage image = noisy(depthImage(slanted)), shared = image;
  for (int v = 1; v + 1 < kHeight; ++v)
    for (int u = 1; u + 1 < kWidth; ++u) {
      double sum = 0.0;
      for (int dv = -1; dv <= 1; ++dv)
        for (int du = -1; du <= 1; ++du) sum += 1.0 / image.depths[(v + dv) * kWidth + u + du];
      shared.depths[v * kWidth + u] = static_cast<float>(9.0 / sum);
    }
  EXPECT_LT(inverseDepthError(shared), 0.7 * kError / 3.0);
  EXPECT_NEAR(sensorError(shared), kError / 3.0, 0.15 * kError / 3.0);
}

TEST(SensorNoise, ResolvesWhatItsErrorsLeave) {
  const double error = sensorError(noisy(depthImage(slanted)));
  EXPECT_NEAR(error, kError, 0.1 * kError) << "each pixel has its own";
  Visibility::Projection projection = Visibility::Projection::Zero();
  projection.leftCols<3>() = Eigen::Matrix3d::Identity();
  const Visibility seen = Visibility(projection, 1, 1, {1.0f}).withDepthErrors(error);
  Points near(3, 2), far(3, 2);
  near << 0.0f, 0.1f, 0.0f, 0.0f, 1.0f, 1.0f;
  far = 2.0f * near;
  EXPECT_NEAR(seen.resolvedTolerance(near), 2.17 * std::sqrt(2.0) * error, 1e-9);
  EXPECT_NEAR(seen.resolvedTolerance(far), 4.0 * seen.resolvedTolerance(near), 1e-9);
}

TEST(DepthFilter, IsTheSameForAnyNumberOfThreads) {
  const DepthImage image = noisy(depthImage(slanted));
  compareThreads([&](int num_threads) { return rootMeanSquare(filterDepths(image, 2, num_threads).depths, slanted); });
}

constexpr double kPixel = 0.01, kRoll = 0.3;

Eigen::Array2d turned(double x, double y, double roll = kRoll) {
  return {std::cos(roll) * x - std::sin(roll) * y, std::sin(roll) * x + std::cos(roll) * y};
}

/// Pixels of a disc of 40 pixels, at most \p right columns to the right of its middle and \p up rows above it.
std::vector<Eigen::Array2d> disc(int right, int up) {
  std::vector<Eigen::Array2d> positions;
  for (int v = -40; v <= up; ++v)
    for (int u = -40; u <= right; ++u)
      if (std::hypot(u, v) <= 40.3) positions.push_back(turned(kPixel * u, kPixel * v));
  return positions;
}

TEST(FrameSides, ARoundObjectThatIsSeenAsAWholeHasNone) {
  EXPECT_TRUE(frameSides(disc(40, 40)).empty());
}

TEST(FrameSides, AreWhereTheLastRowIsAsLongAsTheOnesBefore) {
  const std::vector<FrameSide> one = frameSides(disc(25, 40));
  ASSERT_EQ(one.size(), 1u);
  // The search turns a side by a quarter of a degree at a time, and a row of 60 pixels by that is a quarter of a pixel.
  EXPECT_NEAR(one[0].offset, 25.5 * kPixel, 0.5 * kPixel);
  EXPECT_NEAR(one[0].normal.dot(turned(1.0, 0.0).matrix()), 1.0, 1e-3);
  EXPECT_EQ(frameSides(disc(25, 30)).size(), 2u);
}

TEST(FrameSides, CutLegsAreEnough) {
  // Four bars of twelve pixels that leave the picture, below a disc.
  std::vector<Eigen::Array2d> positions = disc(40, 40);
  for (int bar = 0; bar < 4; ++bar)
    for (int v = -70; v < -20; ++v)
      for (int u = 0; u < 12; ++u) positions.push_back(turned(kPixel * (-33 + 18 * bar + u), kPixel * v));
  const std::vector<FrameSide> sides = frameSides(positions);
  ASSERT_EQ(sides.size(), 1u);
  EXPECT_NEAR(sides[0].normal.dot(turned(0.0, -1.0).matrix()), 1.0, 1e-3);
}

TEST(FrameSides, PlacesWithoutRowsHaveNone) {
  std::vector<Eigen::Array2d> positions;
  RandomStream random(1);
  for (int i = 0; i < 5000; ++i)
    if (const Eigen::Array2d p(symmetric(random), symmetric(random)); p.matrix().norm() < 1.0 && p.x() < 0.6)
      positions.push_back(p);
  EXPECT_TRUE(frameSides(positions).empty());
  EXPECT_TRUE(frameSides({}).empty());
  EXPECT_TRUE(frameSides({{0.0, 0.0}}).empty());
  EXPECT_TRUE(frameSides(std::vector<Eigen::Array2d>(100, {1.0, 2.0})).empty());
}

TEST(FrameSides, BeyondThemNothingIsKnown) {
  // A unit sphere seen from a distance of 4, its picture cut off on the right.
  const double focal = 200.0;
  std::vector<Eigen::Vector3f> hits;
  for (int v = -60; v <= 60; ++v)
    for (int u = -60; u <= 20; ++u) {
      const Eigen::Vector3d ray = Eigen::Vector3d(u / focal, v / focal, 1.0).normalized();
      const double along = 4.0 * ray.z(), sq_half = 1.0 - 16.0 + along * along;
      if (sq_half > 0.0) hits.push_back(((along - std::sqrt(sq_half)) * ray).cast<float>());
    }
  const Eigen::Map<const Points> points(hits[0].data(), 3, static_cast<Eigen::Index>(hits.size()));
  const auto seen = Visibility::fromPoints(points, Eigen::Vector3d::Zero());
  ASSERT_TRUE(seen);
  constexpr double kFree = -std::numeric_limits<double>::infinity(), kUnknown = -kFree;
  for (const double depth : {3.0, 4.0, 9.0}) {
    const auto at = [&](double u, double v) {
      return seen->depthBehind(depth * Eigen::Vector3d(u / focal, v / focal, 1.0));
    };
    EXPECT_EQ(at(22.0, 0.0), kUnknown) << "right of the cut";
    EXPECT_EQ(at(80.0, 30.0), kUnknown);
    EXPECT_EQ(at(-60.0, 0.0), kFree) << "left of the sphere";
    EXPECT_EQ(at(0.0, 60.0), kFree);
    EXPECT_EQ(at(0.0, -60.0), kFree);
    // The same in other units and from another origin.
    const Visibility other = seen->normalized({1.0, -2.0, 3.0}, 2.5);
    const Eigen::Vector3d beyond = depth * Eigen::Vector3d(22.0 / focal, 0.0, 1.0);
    EXPECT_EQ(other.depthBehind((beyond - Eigen::Vector3d(1.0, -2.0, 3.0)) / 2.5), kUnknown);
  }
}

}  // namespace
