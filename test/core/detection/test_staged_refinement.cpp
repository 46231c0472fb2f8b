/// From maxima to exact planes in three stages.
#include "core/detection/plane_fit.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/base/constants.h"
#include "shapes/judged_cloud.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;

/// A box, and what refines its planes.
struct RefinedBox : test::JudgedShape {
  RefinedBox() : JudgedShape(test::box({1.0, 0.7, 0.4}, 5000, test::Sampling::Random, 1).cloud()) {}

  Candidate candidate(const Eigen::Vector3d& normal, double offset) const {
    return {normalized(normal.normalized(), offset)};
  }

  const StagedRefinement refinement{cloud, *fit, options};
};

TEST(StagedRefinement, EachStageComesNearer) {
  const RefinedBox box;
  const ReflectionPlane exact = box.normalized(Eigen::Vector3d::UnitX(), 0.0);
  std::vector<Candidate> candidates{box.candidate({1.0, 0.06, -0.04}, 0.03)};
  const double at_start = candidates[0].plane.angleTo(exact);
  candidates =
      box.refinement.refineCoarsely(candidates, PlaneGrid(box.options.expert, box.edt.center(), box.edt.radius()));
  ASSERT_EQ(candidates.size(), 1u);
  const double after_coarse = candidates[0].plane.angleTo(exact);
  EXPECT_LT(after_coarse, 0.3 * at_start);
  candidates = box.refinement.refineFully(box.refinement.refineClosely(candidates));
  ASSERT_EQ(candidates.size(), 1u);
  EXPECT_LT(candidates[0].plane.angleTo(exact), 0.1 * kDegree);
  EXPECT_GT(candidates[0].merit, kDetection.stages.symmetric_merit);
}

TEST(StagedRefinement, DistinctKeepsTheBestOfLikePlanes) {
  const RefinedBox box;
  std::vector<Candidate> candidates{box.candidate({1.0, 0.0, 0.0}, 0.0), box.candidate({1.0, 0.01, 0.0}, 0.0),
                                    box.candidate({0.0, 1.0, 0.0}, 0.0)};
  candidates[0].merit = 0.5;
  candidates[1].merit = 0.6;
  candidates[2].merit = 0.55;
  const std::vector<Candidate> kept = box.refinement.distinct(candidates);
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept[0].merit, 0.6);
  EXPECT_EQ(kept[1].merit, 0.55);
  EXPECT_EQ(box.refinement.distinct(candidates, -1.0, 1).size(), 1u) << "none may be a symmetry";
}

}  // namespace
