/// What detection takes: data that hold no answer, values and options that are refused, many clouds in one call.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/detect_planes.h"
#include "shapes/counting_search.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

TEST(DetectionInput, AGivenSearchIsAskedForEveryKindOfCloud) {
  const Points one = moved(box(3000, Sampling::Random, 4), randomPose(2)).cloud();
  const Points large = moved(box(30'000, Sampling::Random, 5), randomPose(3)).cloud();
  Points twice(3, 2 * one.cols());
  twice << one, one;
  for (const auto& [points, num_used] : {std::pair(one, 3000), std::pair(twice, 3000), std::pair(large, 20'000)}) {
    AskedSearch asked;
    PlaneInput input(points);
    input.make_search = asked.make();
    const Detection expected = detectPlanes(points), found = detectPlanes(input);
    EXPECT_EQ(asked.num_made, 1);
    EXPECT_EQ(asked.num_points, num_used);
    EXPECT_GT(asked.num_queries, 2 * num_used) << "more than the neighbors of each point";
    ASSERT_EQ(found.planes.size(), expected.planes.size());
    for (std::size_t i = 0; i < found.planes.size(); ++i) {
      EXPECT_LT(found.planes[i].angleTo(expected.planes[i]), 1e-3);
      EXPECT_EQ(found.planes[i].point_support.size(), static_cast<std::size_t>(points.cols()));
    }
    AskedSearch asked_with_map;
    const GaussianEdt edt(points);
    input.make_search = asked_with_map.make();
    input.edt = &edt;
    input.map = &expected.map;
    detectPlanes(input);
    EXPECT_GT(asked_with_map.num_queries, 2 * num_used);
  }
}

/// Distance of the sum of four uniform numbers from its mean, with a standard deviation of 1.
double noise(RandomStream& random) {
  return std::sqrt(3.0) * (random.uniform() + random.uniform() + random.uniform() + random.uniform() - 2.0);
}

TEST(DetectPlanes, BentWiresHaveNoSymmetryByWhatIsMissing) {
  // All of a wire is an open border, and each viewpoint sees it once: neither excuses what has no counterpart.
  int num_called = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RandomStream random(seed);
    const double opening = 0.3 + random.uniform(), climb = 0.3 + random.uniform(), width = 0.01 * random.uniform();
    Points wire(3, 60 + 20 * static_cast<int>(seed));
    for (Eigen::Index i = 0; i < wire.cols(); ++i) {
      const double t = random.uniform(), angle = 7.0 * t, radius = 0.2 + opening * t * t;
      const Eigen::Vector3d off(noise(random), noise(random), noise(random));
      wire.col(i) =
          (Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), climb * t) + width * off).cast<float>();
    }
    const Detection detection = detectPlanes(wire);
    for (const SymmetryPlane& plane : detection.planes) num_called += plane.kind == PlaneKind::Symmetry ? 1 : 0;
    EXPECT_TRUE(detection.axes.empty()) << seed;
    EXPECT_TRUE(detection.centers.empty()) << seed;
  }
  EXPECT_EQ(num_called, 0);
}

TEST(DetectPlanes, OfANoisyLineNothingIsASymmetryButItsAxis) {
  // Noise of 0.9 % of the length along each axis across the line: 97 % of the points lie within 2.4 %, and their
  // spacing is 1.3 to 3 %. The cross-section is not resolved.
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    RandomStream random(seed);
    Points line(3, 60 + 25 * static_cast<int>(seed));
    for (Eigen::Index i = 0; i < line.cols(); ++i)
      line.col(i) = Eigen::Vector3d(random.uniform(), 0.009 * noise(random), 0.009 * noise(random)).cast<float>();
    const Detection detection = detectPlanes(line);
    for (const SymmetryPlane& plane : detection.planes) EXPECT_NE(plane.kind, PlaneKind::Symmetry) << seed;
    for (const SymmetryAxis& axis : detection.axes) EXPECT_GT(std::abs(axis.direction.x()), 0.998) << seed;
    EXPECT_TRUE(detection.centers.empty()) << seed;
  }
}

TEST(DetectPlanes, ARodWhosePointsShowItsCrossSectionHasItsPlanes) {
  // Radius 2.5 % of the length, as some noisy lines; 5000 points, whose spacing is a quarter of the radius.
  RandomStream random(1);
  Points rod(3, 5000);
  for (Eigen::Index i = 0; i < rod.cols(); ++i) {
    const double angle = 2.0 * kPi * random.uniform();
    rod.col(i) = Eigen::Vector3d(random.uniform(), 0.025 * std::cos(angle), 0.025 * std::sin(angle)).cast<float>();
  }
  const Detection detection = detectPlanes(rod);
  EXPECT_TRUE(std::any_of(detection.planes.begin(), detection.planes.end(),
                          [](const SymmetryPlane& plane) { return plane.kind == PlaneKind::Symmetry; }));
  ASSERT_EQ(detection.axes.size(), 1u);
}

TEST(DetectPlanesOfMany, FindsTheSameBytesAsOneCloudAtATime) {
  const auto cloud = [](std::size_t i) {
    return moved(box({1.0, 0.7, 0.4}, 2000, Sampling::Mirrored, 30 + i), randomPose(static_cast<int>(i))).cloud();
  };
  constexpr std::size_t kNum = 6;
  for (const int num_threads : {1, 3}) {
    DetectionOptions options;
    options.num_threads = num_threads;
    std::vector<std::vector<SymmetryPlane>> planes(kNum);
    std::vector<int> num_calls(kNum, 0);
    const auto keep = [&](std::size_t i, Detection detection) {
      ++num_calls[i];
      planes[i] = std::move(detection.planes);
    };
    detectPlanesOfMany(kNum, cloud, keep, options);
    EXPECT_EQ(num_calls, std::vector<int>(kNum, 1));
    for (std::size_t i = 0; i < kNum; ++i) {
      const std::vector<SymmetryPlane> expected = detectPlanes(cloud(i)).planes;
      ASSERT_EQ(planes[i].size(), expected.size());
      EXPECT_GE(planes[i].size(), 1u);
      for (std::size_t k = 0; k < expected.size(); ++k) {
        EXPECT_EQ(planes[i][k].normal(), expected[k].normal());
        EXPECT_EQ(planes[i][k].offset(), expected[k].offset());
        EXPECT_EQ(planes[i][k].confidence, expected[k].confidence);
      }
    }
  }
}

TEST(DetectPlanesOfMany, HandsOnWhatFails) {
  const auto keep = [](std::size_t, const Detection&) {};
  const auto fails = [](std::size_t i) -> Points {
    if (i == 2) throw std::runtime_error("cloud 2 cannot be read");
    return box(100, Sampling::Random, 22).cloud();
  };
  EXPECT_THROW(detectPlanesOfMany(4, fails, keep), std::runtime_error);
  DetectionOptions bad;
  bad.num_threads = -1;
  EXPECT_THROW(detectPlanesOfMany(0, fails, keep, bad), std::invalid_argument);
  EXPECT_NO_THROW(detectPlanesOfMany(0, fails, keep));
}

TEST(DetectionOptions, RefusesBadOnes) {
  const Points cloud = box(100, Sampling::Random, 22).cloud();
  const auto refused = [&](auto&& change) {
    DetectionOptions options;
    change(options);
    EXPECT_THROW(detectPlanes(cloud, options), std::invalid_argument);
  };
  refused([](auto& o) { o.num_cells = 1; });
  refused([](auto& o) { o.expert.maxima.strength = 2.0; });
  refused([](auto& o) { o.expert.num_theta = 0; });
  refused([](auto& o) { o.expert.num_phi = 3; });
  refused([](auto& o) { o.expert.num_radius = 0; });
  refused([](auto& o) { o.expert.max_candidates = 0; });
  refused([](auto& o) { o.expert.max_drift = -1.0; });
  refused([](auto& o) { o.expert.num_coarse_samples = 9; });
  refused([](auto& o) { o.expert.num_refine_samples = 9; });
  refused([](auto& o) { o.expert.max_iterations = 0; });
  refused([](auto& o) { o.expert.merge_angle = -1.0; });
  refused([](auto& o) { o.expert.merge_offset = -1.0; });
  refused([](auto& o) { o.min_confidence = 1.5; });
  refused([](auto& o) { o.min_confidence = -0.1; });
  refused([](auto& o) { o.min_possible = -0.1; });
  refused([](auto& o) { o.min_possible = 1.1; });
  refused([](auto& o) { o.max_possible = 0; });
  refused([](auto& o) { o.max_planes = 0; });
  refused([](auto& o) { o.num_threads = -1; });
}

}  // namespace
