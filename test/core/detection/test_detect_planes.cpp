/// From points to planes: shapes whose planes are known, moved, scaled, disturbed and flat.
#include "pcl_symmetry/core/detect_planes.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

/// How the planes that were found compare with those that are there.
struct Comparison {
  std::size_t num_matched = 0;  ///< planes of the shape with a found plane within 3 degrees
  double worst_angle = 0.0;     ///< radians, of those
  double worst_offset = 0.0;    ///< of the points' center, divided by the diagonal
};

Comparison compare(const Detection& detection, const Shape& shape) {
  const Points cloud = shape.cloud();
  const Eigen::Vector3d center = centerOfMass(cloud);
  const double size = diagonal(cloud);
  Comparison comparison;
  for (const ReflectionPlane& expected : shape.planes) {
    PlaneError nearest{10.0, 0.0};
    for (const ReflectionPlane& found : detection.planes) {
      const PlaneError error = planeError(found, expected, center);
      if (error.angle < nearest.angle) nearest = error;
    }
    if (nearest.angle > 3.0 * kDegree) continue;
    ++comparison.num_matched;
    comparison.worst_angle = std::max(comparison.worst_angle, nearest.angle);
    comparison.worst_offset = std::max(comparison.worst_offset, nearest.offset / size);
  }
  return comparison;
}

struct NamedShape {
  std::string name;
  Shape shape;
};

std::vector<NamedShape> symmetricShapes(int num_points, Sampling sampling) {
  std::vector<NamedShape> shapes = {{"box", box(num_points, sampling, 1)}, {"cube", cube(num_points, sampling, 2)}};
  for (const int n : {3, 4, 5, 6, 8, 12})
    shapes.push_back({"prism of " + std::to_string(n), prism(n, num_points, sampling, 10 + n)});
  return shapes;
}

void expectConsistent(const Detection& detection, const Points& cloud) {
  for (std::size_t i = 0; i < detection.planes.size(); ++i) {
    const SymmetryPlane& plane = detection.planes[i];
    EXPECT_NEAR(plane.normal().norm(), 1.0, 1e-12);
    EXPECT_EQ(plane.normal(), plane.canonical().normal());
    EXPECT_TRUE(std::isfinite(plane.offset()));
    EXPECT_GE(plane.score, 0.0);
    EXPECT_LE(plane.score, 1.0);
    EXPECT_GE(plane.residual, 0.0);
    EXPECT_GE(plane.iterations, 1);
    ASSERT_EQ(plane.point_support.size(), static_cast<std::size_t>(cloud.cols()));
    double sum = 0.0;
    for (const float support : plane.point_support) {
      EXPECT_GE(support, 0.0f);
      EXPECT_LE(support, 1.0f);
      sum += support;
    }
    // Divided by what sampling lets a symmetry have.
    EXPECT_GE(plane.support, sum / static_cast<double>(cloud.cols()) - 1e-6);
    EXPECT_LE(plane.support, 1.0);
    EXPECT_GE(plane.seen, 0.0);
    EXPECT_LE(plane.seen, 1.0);
    EXPECT_GE(plane.confidence, 0.0);
    EXPECT_LE(plane.confidence, 1.0);
    if (i > 0) {
      const SymmetryPlane& before = detection.planes[i - 1];
      EXPECT_GE(plane.kind, before.kind);
      if (plane.kind == PlaneKind::Symmetry) {
        EXPECT_LE(plane.confidence, before.confidence);
      }
    }
  }
}

TEST(DetectPlanes, MirroredSamplesGiveExactlyThePlanes) {
  for (const auto& [name, shape] : symmetricShapes(10'000, Sampling::Mirrored)) {
    for (std::uint64_t pose = 1; pose <= 4; ++pose) {
      const Shape posed = moved(shape, randomPose(pose));
      const Points cloud = posed.cloud();
      const Detection detection = detectPlanes(cloud);
      const Comparison comparison = compare(detection, posed);
      EXPECT_EQ(detection.planes.size(), posed.planes.size()) << name << ", pose " << pose;
      EXPECT_EQ(comparison.num_matched, posed.planes.size()) << name << ", pose " << pose;
      EXPECT_LT(comparison.worst_angle, 0.001 * kDegree) << name << ", pose " << pose;
      EXPECT_LT(comparison.worst_offset, 1e-5) << name << ", pose " << pose;
      expectConsistent(detection, cloud);
    }
  }
}

TEST(DetectPlanes, RandomSamplesGiveThePlanesToTheirNoise) {
  // Faces are flat, so that only samples within a spacing h of an edge have residuals: a tenth of the 10^4 samples of
  // each shape. A residual is uniform over h, times the sine of half the turn of the normal at the edge.
  // Offsets: 0.29 h sin 45 degrees = 0.01 (h = 0.049, cube) for 0.1 * 10^4 samples, halved by the reflection, leaves
  // 0.5 * 0.01 sqrt(0.1 / 10^4) = 1.5e-5, or 4.4e-6 of the diagonal. Four and a half standard errors are allowed.
  // Angles: a prism of 12 hardly resists turns about its axis. Reflected points of a side move across it by 2 t per
  // radian, t = 0.15 on average and 0.26 at an edge; 960 samples near edges have residuals of 0.29 h sin 15 degrees =
  // 0.003, so that the error is 0.52 * 0.003 sqrt(960) / (6200 * 0.3^2) = 8.7e-5 radians. Five of these are allowed.
  for (const auto& [name, shape] : symmetricShapes(10'000, Sampling::Random)) {
    for (std::uint64_t pose = 1; pose <= 2; ++pose) {
      const Shape posed = moved(shape, randomPose(pose));
      const Detection detection = detectPlanes(posed.cloud());
      const Comparison comparison = compare(detection, posed);
      EXPECT_EQ(detection.planes.size(), posed.planes.size()) << name << ", pose " << pose;
      EXPECT_EQ(comparison.num_matched, posed.planes.size()) << name << ", pose " << pose;
      EXPECT_LT(comparison.worst_angle, 5.0 * 8.7e-5) << name << ", pose " << pose;
      EXPECT_LT(comparison.worst_offset, 2e-5) << name << ", pose " << pose;
    }
  }
}

TEST(DetectPlanes, ApproximateOnesComeWhenAskedFor) {
  DetectionOptions options;
  options.approximate = true;
  const Detection detection = detectPlanes(scaleneTetrahedron(5000, 1).cloud(), options);
  ASSERT_FALSE(detection.planes.empty());
  for (const SymmetryPlane& plane : detection.planes) {
    EXPECT_NE(plane.kind, PlaneKind::Symmetry);
    EXPECT_LT(plane.confidence, options.min_confidence);
  }
  for (const SymmetryPlane& plane : detectPlanes(box(5000, Sampling::Random, 1).cloud()).planes)
    EXPECT_EQ(plane.kind, PlaneKind::Symmetry);
}

TEST(DetectPlanes, PlanesOfAFamilyAreNotSymmetriesOfParts) {
  DetectionOptions options;
  options.approximate = true;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Detection detection = detectPlanes(cylinder(3000, seed).cloud(), options);
    ASSERT_EQ(detection.axes.size(), 1u);
    for (const SymmetryPlane& plane : detection.planes)
      EXPECT_FALSE(plane.kind == PlaneKind::Local && plane.confidence >= options.min_confidence) << seed;
  }
}

TEST(DetectPlanes, ACylinderHasOneAxisAndThePlaneAcross) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Eigen::Isometry3d pose = randomPose(4 + seed);
    const Eigen::Vector3d direction = pose.linear().col(2), center = pose.translation();
    const Detection detection = detectPlanes(moved(cylinder(5000, seed), pose).cloud());
    EXPECT_TRUE(detection.centers.empty());
    ASSERT_EQ(detection.axes.size(), 1u);
    const SymmetryAxis& axis = detection.axes[0];
    EXPECT_NEAR(axis.direction.norm(), 1.0, 1e-12);
    EXPECT_GT(std::abs(axis.direction.dot(direction)), std::cos(0.5 * kDegree));
    EXPECT_LT((center - axis.point).cross(axis.direction).norm(), 0.01);
    EXPECT_LT((center - axis.point).norm(), 0.05) << "the point of the axis is the one in the middle";
    EXPECT_GE(axis.confidence, 0.5);
    EXPECT_LE(axis.confidence, 1.0);
    EXPECT_GT(axis.support, 0.95);
    EXPECT_GT(axis.score, 0.9);
    ASSERT_EQ(detection.planes.size(), 1u);
    const PlaneError error = planeError(detection.planes[0], ReflectionPlane(direction, direction.dot(center)), center);
    EXPECT_LT(error.angle, 0.5 * kDegree);
    EXPECT_LT(error.offset, 0.01);
  }
}

TEST(DetectPlanes, ASphereHasOneCenter) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Eigen::Isometry3d pose = randomPose(4 + seed);
    const Detection detection = detectPlanes(moved(sphere(5000, seed), pose).cloud());
    EXPECT_TRUE(detection.planes.empty());
    EXPECT_TRUE(detection.axes.empty());
    ASSERT_EQ(detection.centers.size(), 1u);
    EXPECT_LT((detection.centers[0].point - pose.translation()).norm(), 0.01);
    EXPECT_GE(detection.centers[0].confidence, 0.5);
    EXPECT_GT(detection.centers[0].support, 0.95);
  }
}

TEST(DetectPlanes, ScalesWithThePoints) {
  const Shape shape = moved(box(4000, Sampling::Mirrored, 7), randomPose(7));
  for (const double scale : {1e-12, 1e-9, 1e-3, 1.0, 1e3, 1e9, 1e12}) {
    const Shape expected = scaled(shape, scale);
    const Points cloud = expected.cloud();
    const Detection detection = detectPlanes(cloud);
    const Comparison comparison = compare(detection, expected);
    EXPECT_EQ(detection.planes.size(), 3u) << scale;
    EXPECT_EQ(comparison.num_matched, 3u) << scale;
    EXPECT_LT(comparison.worst_angle, 0.001 * kDegree) << scale;
    EXPECT_LT(comparison.worst_offset, 1e-5) << scale;
    for (const SymmetryPlane& plane : detection.planes) EXPECT_LT(plane.residual, 1e-4 * diagonal(cloud)) << scale;
  }
}

TEST(DetectPlanes, SurvivesAFarOrigin) {
  // At 1e6, floats lie 1/16 apart: a box of 200 units keeps its planes to a fraction of that.
  Shape shape = scaled(box(10'000, Sampling::Mirrored, 9), 100.0);
  shape = moved(shape, Eigen::Translation3d(1e6, -1e6, 5e5) * Eigen::Isometry3d::Identity());
  const Comparison comparison = compare(detectPlanes(shape.cloud()), shape);
  EXPECT_EQ(comparison.num_matched, 3u);
  EXPECT_LT(comparison.worst_angle * 100.0, 1.0 / 16.0);
  EXPECT_LT(comparison.worst_offset * diagonal(shape.cloud()), 1.0 / 16.0);
}

TEST(DetectPlanes, SmallNoiseMovesAPlaneALittle) {
  const Shape shape = moved(box(10'000, Sampling::Mirrored, 10), randomPose(10));
  const double size = diagonal(shape.cloud());
  for (const double noise : {1e-5, 1e-4, 1e-3, 5e-3}) {
    Shape noisy = shape;
    RandomStream random(11);
    for (Eigen::Index i = 0; i < noisy.points.size(); ++i) noisy.points.data()[i] += noise * size * gaussian(random);
    const Comparison comparison = compare(detectPlanes(noisy.cloud()), noisy);
    EXPECT_EQ(comparison.num_matched, 3u) << noise;
    // Averaged over 10^4 points the noise moves a plane by noise / 100; wrong pairs and edges make it worse. Ten times
    // that is asked for, in radians and in diagonals.
    EXPECT_LT(comparison.worst_angle, 0.001 * kDegree + 0.3 * noise) << noise;
    EXPECT_LT(comparison.worst_offset, 1e-5 + 0.1 * noise) << noise;
  }
}

Shape withNoise(Shape shape, double of_diagonal, std::uint64_t seed) {
  const double size = diagonal(shape.cloud());
  RandomStream random(seed, 11);
  for (Eigen::Index i = 0; i < shape.points.size(); ++i)
    shape.points.data()[i] += of_diagonal * size * gaussian(random);
  return shape;
}

TEST(DetectPlanes, NoiseBeyondTheSpacingLeavesTheSymmetries) {
  // 2 % of the diagonal is 0.052; 10^4 points on the box lie 0.034 apart, so that they resolve no surface.
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Shape shape = moved(withNoise(box(10'000, Sampling::Random, seed), 0.02, seed), randomPose(30 + seed));
    const Detection detection = detectPlanes(shape.cloud());
    const Comparison comparison = compare(detection, shape);
    EXPECT_EQ(detection.planes.size(), 3u) << seed;
    EXPECT_EQ(comparison.num_matched, 3u) << seed;
    // 0.30 degrees and 4.9e-4 of the diagonal were measured.
    EXPECT_LT(comparison.worst_angle, 1.5 * kDegree) << seed;
    EXPECT_LT(comparison.worst_offset, 0.002) << seed;
    // The noise is twice the tolerance: not every plane can be decided.
    ASSERT_FALSE(detection.planes.empty()) << seed;
    EXPECT_EQ(detection.planes.front().kind, PlaneKind::Symmetry) << seed;
  }
}

TEST(DetectPlanes, NoiseMakesNoSymmetry) {
  for (const double noise : {0.0, 0.005, 0.01, 0.02}) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      EXPECT_TRUE(detectPlanes(withNoise(scaleneTetrahedron(10'000, seed), noise, seed).cloud()).planes.empty())
          << noise << ", tetrahedron " << seed;
      EXPECT_TRUE(detectPlanes(withNoise(asymmetricBlob(10'000, seed), noise, seed).cloud()).planes.empty())
          << noise << ", blob " << seed;
    }
  }
}

TEST(DetectPlanes, OnePointRepeatedChangesNothing) {
  const Shape shape = moved(box(4000, Sampling::Mirrored, 12), randomPose(12));
  const Points once = shape.cloud();
  Points cloud(3, once.cols() + 3000);
  cloud << once, once.col(17).replicate(1, 3000);
  const Detection detection = detectPlanes(cloud);
  EXPECT_EQ(detection.planes.size(), 3u);
  const Comparison comparison = compare(detection, shape);
  EXPECT_EQ(comparison.num_matched, 3u);
  EXPECT_LT(comparison.worst_angle, 0.001 * kDegree);
  EXPECT_LT(comparison.worst_offset, 1e-5);
  for (const SymmetryPlane& plane : detection.planes) {
    ASSERT_EQ(plane.point_support.size(), static_cast<std::size_t>(cloud.cols()));
    for (std::size_t i = 4000; i < plane.point_support.size(); ++i)
      EXPECT_EQ(plane.point_support[i], plane.point_support[17]);
  }
}

TEST(DetectPlanes, SameBytesForAnyNumberOfThreads) {
  const Points cloud = moved(prism(5, 4000, Sampling::Random, 13), randomPose(13)).cloud();
  const auto detect = [&](int num_threads) {
    DetectionOptions options;
    options.num_threads = num_threads;
    return detectPlanes(cloud, options);
  };
  const Detection one = detect(1);
  EXPECT_EQ(one.planes.size(), 6u);
  for (const int num_threads : {2, 8}) {
    const Detection many = detect(num_threads);
    EXPECT_EQ(many.map.values, one.map.values);
    ASSERT_EQ(many.planes.size(), one.planes.size());
    for (std::size_t i = 0; i < one.planes.size(); ++i) {
      EXPECT_EQ(many.planes[i].coefficients(), one.planes[i].coefficients());
      EXPECT_EQ(many.planes[i].score, one.planes[i].score);
      EXPECT_EQ(many.planes[i].support, one.planes[i].support);
      EXPECT_EQ(many.planes[i].point_support, one.planes[i].point_support);
      EXPECT_EQ(many.planes[i].residual, one.planes[i].residual);
      EXPECT_EQ(many.planes[i].iterations, one.planes[i].iterations);
    }
  }
}

TEST(DetectPlanes, NeedsNoPrincipalAxes) {
  const Shape shape = moved(box(10'000, Sampling::Mirrored, 15), randomPose(15));
  DetectionOptions options;
  options.expert.principal_planes = false;
  EXPECT_EQ(compare(detectPlanes(shape.cloud(), options), shape).num_matched, 3u);
}

TEST(DetectPlanes, MaxPlanesKeepsTheBest) {
  const Points cloud = cube(5000, Sampling::Random, 16).cloud();
  DetectionOptions options;
  const Detection all = detectPlanes(cloud, options);
  ASSERT_EQ(all.planes.size(), 9u);
  options.max_planes = 2;
  const Detection two = detectPlanes(cloud, options);
  ASSERT_EQ(two.planes.size(), 2u);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(two.planes[i].coefficients(), all.planes[i].coefficients());
}

TEST(DetectPlanes, AFlatRectangleHasThree) {
  const Shape flat = moved(box({1.0, 0.6, 0.0}, 4000, Sampling::Mirrored, 21), randomPose(21));
  const Points cloud = flat.cloud();
  const Detection detection = detectPlanes(cloud);
  expectConsistent(detection, cloud);
  const Comparison comparison = compare(detection, flat);
  EXPECT_EQ(detection.planes.size(), 3u);
  EXPECT_EQ(comparison.num_matched, 3u);
  EXPECT_LT(comparison.worst_angle, 0.001 * kDegree);
  EXPECT_LT(comparison.worst_offset, 1e-5);
  ASSERT_TRUE(detection.flat) << "its own plane is named";
  double farthest = 0.0;
  for (Eigen::Index i = 0; i < cloud.cols(); ++i)
    farthest = std::max(farthest, std::abs(detection.flat->signedDistance(cloud.col(i).cast<double>())));
  EXPECT_LT(farthest, 1e-4);
}

TEST(DetectPlanes, ADiscIsNamedFlatAndABoxIsNot) {
  const Shape disc = moved(prism(24, 4000, Sampling::Random, 22, 0.002), randomPose(22));
  EXPECT_TRUE(detectPlanes(disc.cloud()).flat);
  EXPECT_FALSE(detectPlanes(moved(box(3000, Sampling::Random, 23), randomPose(23)).cloud()).flat);
}

}  // namespace
