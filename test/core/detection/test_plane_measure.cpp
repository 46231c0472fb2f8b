/// What is measured of a plane before anything is decided.
#include "core/detection/plane_measure.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "core/geometry/point_samples.h"
#include "shapes/judged_cloud.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;

using test::JudgedShape;

TEST(PlaneMeasure, ShareFallsWithTheDistanceFromASymmetry) {
  const JudgedShape box(test::box({1.0, 0.7, 0.4}, 5000, test::Sampling::Random, 1).cloud());
  const auto shareAt = [&](double offset) {
    return box.measure.measured(box.normalized(Eigen::Vector3d::UnitX(), offset), box.measure.samples()).evidence.share;
  };
  EXPECT_GT(shareAt(0.0), 0.99);
  double last = 1.0;
  for (const double offset : {0.02, 0.1, 0.3}) {
    const double share = shareAt(offset);
    EXPECT_LT(share, last) << offset;
    last = share;
  }
  EXPECT_LT(last, 0.7) << "a third of the box reaches beyond its other side";
}

TEST(PlaneMeasure, MatchesOfOtherSamplesAreNotTaken) {
  const JudgedShape box(test::box({1.0, 0.7, 0.4}, 5000, test::Sampling::Random, 1).cloud());
  const auto drawn = [](std::uint64_t seed) { return drawSamples(5000, 500, seed); };
  Candidate candidate;
  candidate.plane = box.normalized(Eigen::Vector3d::UnitX(), 0.0);
  candidate.samples = std::make_shared<const std::vector<int>>(drawn(1));
  candidate.step = box.fit->matches(candidate.plane, *candidate.samples);
  EXPECT_EQ(box.measure.measured(candidate, drawn(2)).evidence.share,
            box.measure.measured(candidate.plane, drawn(2)).evidence.share);
}

TEST(CloudLimits, TheOwnPlaneOfASheetMovesNothing) {
  const JudgedShape sheet(test::flatSquare(2000, 1));
  const CloudLimits& limits = sheet.measure.limits();
  EXPECT_EQ(limits.thinness(), Thinness::Sheet);
  const PrincipalAxes& axes = sheet.cloud.principal_axes;
  const auto rulesOf = [&](int k) {
    return limits.rulesAgainst({axes.axes.col(k), axes.axes.col(k).dot(axes.center)}, sheet.cloud.points).size();
  };
  EXPECT_EQ(rulesOf(0), 0u);
  EXPECT_EQ(rulesOf(2), 1u);
}

TEST(CloudLimits, ASensorThatResolvesTooLittle) {
  const Points points = test::box({1.0, 0.7, 0.4}, 500, test::Sampling::Random, 1).cloud();
  const auto numRules = [&](double tolerance, double resolution) {
    const CloudLimits limits(points, principalAxes(points), CloudKind::Scan, nullptr,
                             {tolerance, resolution, 0.05, 1.0});
    return limits.rulesAgainst(ReflectionPlane(Eigen::Vector3d::UnitX(), 0.0), points).size();
  };
  EXPECT_EQ(numRules(0.01, 0.005), 0u);
  EXPECT_EQ(numRules(0.01, 0.02), 1u) << "the tolerance was given";
  EXPECT_EQ(numRules(0.03, 0.08), 0u);
  EXPECT_EQ(numRules(0.03, 0.1), 1u);
}

}  // namespace
