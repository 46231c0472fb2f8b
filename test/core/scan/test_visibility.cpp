/// Free, seen and unknown space, and what it makes of the transform.
#include "core/distance_transform/free_space.h"
#include "core/transform/sampled_transform.h"
#include "pcl_symmetry/core/scan/visibility.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "pcl_symmetry/core/transform/planar_transform.h"
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
  return facing(spherePoints(), spherePoints(), viewpoint);
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
}

TEST(Visibility, ASurfaceHasNoHoles) {
  // Points of a curved surface are not spread evenly over the picture: where they are sparse there are no holes either.
  const Eigen::Vector3d forward = -kViewpoint.normalized(), u = forward.unitOrthogonal(), v = forward.cross(u);
  for (const int num_points : {2000, 20'000, 100'000}) {
    const Points points = spherePoints(num_points);
    const auto seen = Visibility::fromPoints(facing(points, points, kViewpoint), kViewpoint);
    ASSERT_TRUE(seen);
    int num_rays = 0, num_through = 0;
    for (double a = -0.8; a <= 0.8; a += 0.02) {
      for (double b = -0.8; b <= 0.8; b += 0.02) {
        if (std::hypot(a, b) > 0.8) continue;
        ++num_rays;
        num_through += seen->depthBehind(a * u + b * v) == -kInfinity ? 1 : 0;
      }
    }
    EXPECT_LT(num_through, 0.002 * num_rays) << num_points << " points: rays that pass through the sphere";
  }
}

TEST(Visibility, IsTheSameInNormalizedCoordinates) {
  const Points points = sphereScan();
  const auto seen = Visibility::fromPoints(points, kViewpoint);
  ASSERT_TRUE(seen);
  const Eigen::Vector3d center(0.3, -2.0, 7.0);
  const double scale = 3.5;
  const Visibility other = seen->normalized(center, scale);
  EXPECT_EQ(other.width(), seen->width());
  EXPECT_EQ(other.height(), seen->height());
  RandomStream random(2);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d x = 1.5 * Eigen::Vector3d(symmetric(random), symmetric(random), symmetric(random));
    const double expected = seen->depthBehind(x), found = other.depthBehind((x - center) / scale) * scale;
    if (std::isfinite(expected)) {
      EXPECT_NEAR(found, expected, 5e-6);  // depths of 5 in floats: 5 * 6e-8, twice, and room
    } else {
      EXPECT_EQ(found, expected);
    }
  }
}

TEST(Visibility, SeesNothingFromInside) {
  EXPECT_FALSE(Visibility::fromPoints(spherePoints(), Eigen::Vector3d::Zero()));
  EXPECT_FALSE(Visibility::fromPoints(spherePoints(), Eigen::Vector3d(0.5, 0.2, 0.1)));
  EXPECT_FALSE(Visibility::fromPoints(spherePoints(), Eigen::Vector3d(0.99, 0.0, 0.0)));
  // From a distance of 1.02 a sphere is seen within asin(1 / 1.02) = 79 degrees, from 1.05 within 72.
  EXPECT_FALSE(Visibility::fromPoints(spherePoints(), Eigen::Vector3d(1.02, 0.0, 0.0)));
  EXPECT_TRUE(Visibility::fromPoints(spherePoints(), Eigen::Vector3d(1.05, 0.0, 0.0)));
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

TEST(Visibility, ScaleOfTheUnitsDoesNotMatter) {
  const Points points = sphereScan();
  const auto one = Visibility::fromPoints(points, kViewpoint);
  const auto other = Visibility::fromPoints(points * 1024.0f, kViewpoint * 1024.0);
  ASSERT_TRUE(one && other);
  ASSERT_EQ(one->width(), other->width());
  ASSERT_EQ(one->height(), other->height());
  for (int v = 0; v < one->height(); ++v)
    for (int u = 0; u < one->width(); ++u) EXPECT_EQ(one->depth(u, v) * 1024.0f, other->depth(u, v));
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

TEST(FreeSpace, IsFreeInFrontAndBesideAndNothingBehind) {
  const Points points = sphereScan();
  const auto seen = Visibility::fromPoints(points, kViewpoint);
  ASSERT_TRUE(seen);
  const GaussianEdt edt(points);
  const std::vector<float> free = freeSpace(edt, *seen);
  ASSERT_EQ(free.size(), edt.values().size());
  const Eigen::Vector3d forward = -kViewpoint.normalized();
  int num_front = 0, num_behind = 0, num_lost = 0, num_wrong = 0;
  for (std::size_t i = 0; i < free.size(); ++i) {
    ASSERT_GE(free[i], 0.0f);
    ASSERT_LE(free[i], 1.0f - edt.values()[i]) << "on the surface nothing is free";
    const Eigen::Vector3d x = edt.cellCenter(i);
    // The picture is exact to a pixel: cells that lie farther than that from the surface and the silhouette are clear.
    const double across = (x - x.dot(forward) * forward).norm(), before = -x.dot(forward);
    if (before > 0.3 && x.norm() > 1.1) {
      ++num_front;
      num_lost += free[i] != 1.0f - edt.values()[i] ? 1 : 0;
    } else if (across < 0.8 && (x.norm() < 0.9 || before < 0.0)) {
      ++num_behind;
      num_wrong += free[i] != 0.0f ? 1 : 0;
    }
  }
  EXPECT_GT(num_front, 1000);
  EXPECT_GT(num_behind, 1000);
  EXPECT_EQ(num_lost, 0) << "of " << num_front << " cells in front";
  EXPECT_EQ(num_wrong, 0) << "of " << num_behind << " cells within the sphere and in its shadow";
  for (const int num_threads : {1, 2, 8}) EXPECT_EQ(freeSpace(edt, *seen, num_threads), free) << num_threads;
}

TEST(SeenSymmetry, HasTheLimitsThatItShould) {
  EXPECT_EQ(seenSymmetry(1.0, 0.0), 1.0);
  EXPECT_EQ(seenSymmetry(0.0, 0.0), 0.0) << "what nobody could see has no merit";
  EXPECT_EQ(seenSymmetry(0.0, 1.0), 0.0);
  for (double d = 0.0; d < 1.0; d += 0.1) {
    for (double f = 0.0; f < 1.0; f += 0.1) {
      EXPECT_GE(seenSymmetry(d, f), 0.0);
      EXPECT_LE(seenSymmetry(d, f), 1.0);
      EXPECT_GT(seenSymmetry(d + 0.1, f), seenSymmetry(d, f));
      if (d > 0.0) {
        EXPECT_LT(seenSymmetry(d, f + 0.1), seenSymmetry(d, f));
      }
    }
  }
}

class TransformWithFreeSpace : public testing::Test {
protected:
  const Scan scan_ = scan(blockBox(), {2.5, -3.0, 2.0});
  const Points points_ = scan_.cloud();
  const GaussianEdt edt_{points_};
  const PlaneGrid grid_{16, 32, 32, edt_.center(), edt_.radius()};
  const std::vector<float> free_ = freeSpace(edt_, scan_.visibility());
};

TEST_F(TransformWithFreeSpace, IsSeenSymmetryOfTheTwoMeans) {
  SampledTransformOptions options;
  options.num_samples = 300;
  const SymmetryMap both = sampledTransform(edt_, grid_, options, free_);
  const SymmetryMap d = sampledTransform(edt_, grid_, options);
  const std::vector<float> f = freeOverlap(edt_, grid_, free_, options);
  ASSERT_EQ(both.values.size(), grid_.size());
  ASSERT_EQ(f.size(), grid_.size());
  SymmetryMap weighed = d;
  weighSeen(weighed, f);
  EXPECT_EQ(weighed.values, both.values);
  std::size_t num_weighed = 0;
  for (std::size_t i = 0; i < grid_.size(); ++i) {
    EXPECT_GE(f[i], 0.0f);
    EXPECT_EQ(both.values[i], static_cast<float>(seenSymmetry(d.values[i], f[i])));
    num_weighed += f[i] > 0.01f ? 1 : 0;
  }
  EXPECT_GT(num_weighed, grid_.size() / 10) << "free space is met by many planes";
}

TEST_F(TransformWithFreeSpace, SameBytesForAnyNumberOfThreads) {
  SampledTransformOptions options;
  options.num_threads = 1;
  const SymmetryMap one = sampledTransform(edt_, grid_, options, free_);
  for (const int num_threads : {2, 8}) {
    options.num_threads = num_threads;
    EXPECT_EQ(sampledTransform(edt_, grid_, options, free_).values, one.values) << num_threads;
  }
  for (const Simd simd : {Simd::Scalar, Simd::Avx2, Simd::Avx512}) {
    if (!simdSupported(simd)) continue;
    options.simd = simd;
    EXPECT_EQ(sampledTransform(edt_, grid_, options, free_).values, one.values) << static_cast<int>(simd);
  }
}

TEST_F(TransformWithFreeSpace, EveryMethodGivesTheSameMap) {
  PlanarTransformOptions options;
  options.sampled.num_samples = 5000;
  options.voting.num_pairs = 5'000'000;
  const auto map = [&](TransformMethod method) {
    options.method = method;
    return planarTransform(edt_, grid_, centerOfMass(points_), options, free_);
  };
  const SymmetryMap sampled = map(TransformMethod::Sampled);
  const auto rms = [&](const SymmetryMap& other) {
    double sum = 0.0;
    for (std::size_t i = 0; i < grid_.size(); ++i) sum += std::pow(other.values[i] - sampled.values[i], 2);
    return std::sqrt(sum / static_cast<double>(grid_.size()));
  };
  const double convolution = rms(map(TransformMethod::Convolution)), voting = rms(map(TransformMethod::Voting));
  std::printf("against sampling: convolution %.4f, voting %.4f\n", convolution, voting);
  // 0.0053 and 0.0199 were measured: the noise of 5000 samples, and bins in place of their centers.
  EXPECT_LT(convolution, 0.01);
  EXPECT_LT(voting, 0.04);
}

TEST_F(TransformWithFreeSpace, RefusesFreeSpaceOfAnotherGrid) {
  const std::vector<float> wrong(100, 0.0f);
  EXPECT_THROW(sampledTransform(edt_, grid_, {}, wrong), std::invalid_argument);
  EXPECT_THROW(freeOverlap(edt_, grid_, wrong), std::invalid_argument);
}

}  // namespace
