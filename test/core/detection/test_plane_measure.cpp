/// What is measured of a plane before anything is decided.
#include "core/detection/plane_measure.h"

#include <gtest/gtest.h>

#include <memory>

#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;

/// A cloud, and the measure of its planes.
struct MeasuredCloud {
  explicit MeasuredCloud(const Points& points, const DetectionOptions& given = {})
      : options(given),
        edt(points),
        cloud(points, edt, nullptr, nullptr, 1),
        fit(makePlaneFit(cloud, options)),
        measure(cloud, *fit, options) {}

  double shareOf(const ReflectionPlane& plane) const {
    return measure.of(cloud.toNormalized(plane), measure.samples()).evidence.share;
  }

  const DetectionOptions options;
  const GaussianEdt edt;
  const NormalizedCloud cloud;
  const std::unique_ptr<PlaneFit> fit;
  const PlaneMeasure measure;
};

TEST(PlaneMeasure, ShareFallsWithTheDistanceFromASymmetry) {
  const MeasuredCloud box(test::box({1.0, 0.7, 0.4}, 5000, test::Sampling::Random, 1).cloud());
  EXPECT_GT(box.shareOf({Eigen::Vector3d::UnitX(), 0.0}), 0.99);
  double last = 1.0;
  for (const double offset : {0.02, 0.1, 0.3}) {
    const double share = box.shareOf({Eigen::Vector3d::UnitX(), offset});
    EXPECT_LT(share, last) << offset;
    last = share;
  }
  EXPECT_LT(last, 0.7) << "a third of the box reaches beyond its other side";
}

TEST(PlaneMeasure, ToleranceIsAShareOfTheExtentOrInInputUnits) {
  const Points points = test::box({1.0, 0.7, 0.4}, 5000, test::Sampling::Random, 1).cloud();
  const MeasuredCloud usual(points);
  EXPECT_NEAR(usual.measure.tolerance(), 0.01 * usual.cloud.extent, 1e-9);
  DetectionOptions options;
  options.absolute_tolerance = 0.05;
  const MeasuredCloud given(points, options);
  EXPECT_NEAR(given.measure.tolerance() * given.cloud.scale, 0.05, 1e-9);
}

TEST(PlaneMeasure, TheOwnPlaneOfASheetMovesNothing) {
  const MeasuredCloud sheet(test::flatSquare(2000, 1));
  EXPECT_EQ(sheet.measure.thinness(), Thinness::Sheet);
  const Eigen::Matrix3d axes = sheet.cloud.principal_axes.axes;
  EXPECT_EQ(sheet.measure.movedShare({axes.col(2), axes.col(2).dot(sheet.cloud.principal_axes.center)}), 0.0);
  EXPECT_GT(sheet.measure.movedShare({axes.col(0), axes.col(0).dot(sheet.cloud.principal_axes.center)}), 0.9);
}

}  // namespace
