/// From points to planes: shapes whose planes are known, moved, scaled, disturbed and flat.
#include "pcl_symmetry/core/detect_planes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "shapes/found_planes.h"
#include "shapes/threads.h"

namespace pcl_symmetry {
namespace {

using namespace test;

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

/// Expects the planes of a shape and no other.
void expectPlanes(const Detection& detection, const Shape& shape, double worst_angle, double worst_offset) {
  const Comparison comparison = compare(detection, shape);
  EXPECT_EQ(detection.planes.size(), shape.planes.size());
  EXPECT_EQ(comparison.num_matched, shape.planes.size());
  EXPECT_LT(comparison.worst_angle, worst_angle);
  EXPECT_LT(comparison.worst_offset, worst_offset);
}

std::vector<std::pair<std::string, Shape>> symmetricShapes(int num_points, Sampling sampling) {
  std::vector<std::pair<std::string, Shape>> shapes = {{"box", box(num_points, sampling, 1)},
                                                       {"cube", cube(num_points, sampling, 2)}};
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
      SCOPED_TRACE(name + ", pose " + std::to_string(pose));
      expectPlanes(detection, posed, 0.001 * kDegree, 1e-5);
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
      SCOPED_TRACE(name + ", pose " + std::to_string(pose));
      expectPlanes(detectPlanes(posed.cloud()), posed, 5.0 * 8.7e-5, 2e-5);
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
    SCOPED_TRACE(scale);
    expectPlanes(detection, expected, 0.001 * kDegree, 1e-5);
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

Shape withNoise(Shape shape, double of_diagonal, std::uint64_t seed) {
  const double size = diagonal(shape.cloud());
  RandomStream random(seed, 11);
  for (Eigen::Index i = 0; i < shape.points.size(); ++i)
    shape.points.data()[i] += of_diagonal * size * gaussian(random);
  return shape;
}

TEST(DetectPlanes, SmallNoiseMovesAPlaneALittle) {
  const Shape shape = moved(box(10'000, Sampling::Mirrored, 10), randomPose(10));
  for (const double noise : {1e-5, 1e-4, 1e-3, 5e-3}) {
    const Shape noisy = withNoise(shape, noise, 11);
    const Comparison comparison = compare(detectPlanes(noisy.cloud()), noisy);
    EXPECT_EQ(comparison.num_matched, 3u) << noise;
    // Averaged over 10^4 points the noise moves a plane by noise / 100; wrong pairs and edges make it worse. Ten times
    // that is asked for, in radians and in diagonals.
    EXPECT_LT(comparison.worst_angle, 0.001 * kDegree + 0.3 * noise) << noise;
    EXPECT_LT(comparison.worst_offset, 1e-5 + 0.1 * noise) << noise;
  }
}

TEST(DetectPlanes, NoiseBeyondTheSpacingLeavesTheSymmetries) {
  // 2 % of the diagonal is 0.052; 10^4 points on the box lie 0.034 apart, so that they resolve no surface.
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Shape shape = moved(withNoise(box(10'000, Sampling::Random, seed), 0.02, seed), randomPose(30 + seed));
    const Detection detection = detectPlanes(shape.cloud());
    SCOPED_TRACE(seed);
    // 0.30 degrees and 4.9e-4 of the diagonal were measured.
    expectPlanes(detection, shape, 1.5 * kDegree, 0.002);
    // The noise is twice the tolerance: not every plane can be decided.
    ASSERT_FALSE(detection.planes.empty());
    EXPECT_EQ(detection.planes.front().kind, PlaneKind::Symmetry);
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
  expectPlanes(detection, shape, 0.001 * kDegree, 1e-5);
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
  compareThreads(detect, [](const Detection& many, const Detection& one) {
    EXPECT_EQ(one.planes.size(), 6u);
    EXPECT_EQ(many.map.values, one.map.values);
    expectSamePlanes(many.planes, one.planes);
  });
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
  expectPlanes(detection, flat, 0.001 * kDegree, 1e-5);
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

/// Fewer candidates and samples than by default: the same steps in a third of the time.
DetectionOptions sweepOptions() {
  DetectionOptions options;
  options.expert.num_phi = 64;
  options.expert.max_candidates = 16;
  options.expert.num_refine_samples = 3000;
  return options;
}

/// Everything at once, drawn from a seed.
struct Change {
  Eigen::Isometry3d pose;
  double scale;
  std::vector<Eigen::Index> order;  ///< of the points that are left, some of them several times

  Change(std::uint64_t seed, Eigen::Index num_points) : pose(randomPose(seed)) {
    RandomStream random(seed, 5);
    scale = std::pow(10.0, 12.0 * random.uniform() - 6.0);
    const double share = 0.6 + 0.4 * random.uniform(), copies = 0.3 * random.uniform();
    for (Eigen::Index i = 0; i < num_points; ++i) {
      if (random.uniform() > share) continue;
      order.push_back(i);
      if (random.uniform() < copies) order.push_back(i);
    }
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  }

  Shape of(const Shape& shape) const {
    Shape result = scaled(moved(shape, pose), scale);
    result.points = Eigen::Matrix3Xd(result.points(Eigen::all, order));
    return result;
  }
};

TEST(Invariance, PlanesStayWhateverIsDoneToThePoints) {
  const std::vector<std::pair<std::string, Shape>> shapes = {{"box", box(5000, Sampling::Random, 1)},
                                                             {"prism of 5", prism(5, 5000, Sampling::Random, 2)},
                                                             {"prism of 3", prism(3, 5000, Sampling::Random, 3)}};
  for (const auto& [name, shape] : shapes) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const Change change(seed, shape.points.cols());
      const Shape changed = change.of(shape);
      const Points cloud = changed.cloud();
      const Detection detection = detectPlanes(cloud, sweepOptions());
      SCOPED_TRACE(name + ", seed " + std::to_string(seed) + ", scale " + std::to_string(change.scale));
      EXPECT_EQ(std::count_if(detection.planes.begin(), detection.planes.end(),
                              [](const SymmetryPlane& plane) { return plane.kind == PlaneKind::Symmetry; }),
                static_cast<std::ptrdiff_t>(shape.planes.size()));
      EXPECT_EQ(numFound(changed, detection.planes, kDegree, 0.01 * diagonal(cloud)),
                static_cast<int>(shape.planes.size()));
    }
  }
}

TEST(Invariance, NothingMakesAnAsymmetricShapeSymmetric) {
  const Shape shapes[] = {scaleneTetrahedron(5000, 4), asymmetricBlob(5000, 5)};
  for (const Shape& shape : shapes)
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const Detection detection = detectPlanes(Change(seed, shape.points.cols()).of(shape).cloud(), sweepOptions());
      for (const SymmetryPlane& plane : detection.planes)
        EXPECT_NE(plane.kind, PlaneKind::Symmetry) << "seed " << seed << ": " << plane.normal().transpose();
    }
}

}  // namespace
}  // namespace pcl_symmetry
