/// Poses are judged by the surface and by free space, and improved.
#include "core/registration/pose_scoring.h"

#include <gtest/gtest.h>

#include "shapes/posed_surfaces.h"
#include "shapes/scans.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

TEST(PoseScorer, TheTruePoseIsBestAndStandsStill) {
  const Shape shape = asymmetricBlob(4000, 1);
  const Eigen::Isometry3d T_model_scan = randomPose(4, 0.5);
  const PosedSurface model = surface(shape.cloud()), scan = surface(moved(shape, T_model_scan.inverse()).cloud());
  const PoseScorer scorer(scan, model);
  const PoseScorer::Detail detail{1000, 0.1, true};
  const PoseScore score = scorer.score(T_model_scan, detail);
  EXPECT_GT(score.support, 0.95);
  EXPECT_EQ(score.conflict, 0.0) << "nobody looked";
  EXPECT_LT(angleOf(scorer.step(T_model_scan, detail) * T_model_scan.inverse()), 0.01);
  for (const double angle : {0.2, 0.5}) {
    Eigen::Isometry3d turned = T_model_scan;
    turned.linear() = T_model_scan.linear() * Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 3).normalized());
    EXPECT_LT(scorer.score(turned, detail).merit(), score.merit() - 0.05) << angle;
  }
}

TEST(PoseScorer, FreeSpaceSpeaksAgainstAPose) {
  const BlockObject object = blockChair();
  const Scan scan = test::scan(object, {3.0, -6.0, 4.0});
  const PosedSurface seen = surface(scan.cloud(), scan.visibility()), unseen = surface(scan.cloud());
  // The chair upside down: what is then above the seat was seen to be empty.
  const Eigen::Isometry3d over(Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()));
  const PosedSurface model = surface(surfaceOf(object, 4000));
  const PoseScorer::Detail detail{1000, 0.1, true};
  EXPECT_EQ(PoseScorer(unseen, model).score(over, detail).conflict, 0.0);
  EXPECT_GT(PoseScorer(seen, model).score(over, detail).conflict, 0.1);
  EXPECT_LT(PoseScorer(seen, model).score(Eigen::Isometry3d::Identity(), detail).conflict, 0.02);
}

}  // namespace
