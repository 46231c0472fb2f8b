/// Functions on grids: interpolation, intensities that count, and the transform of what they give.
#include "pcl_symmetry/core/scalar_grid.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "pcl_symmetry/core/gaussian_edt.h"
#include "pcl_symmetry/core/local_symmetry.h"
#include "pcl_symmetry/core/planar_transform.h"
#include "shapes/complaint.h"

namespace {

using namespace pcl_symmetry;

/// 1 inside an ellipsoid about the middle of a cube of n^3 voxels of size 1, 0 outside, times a scale.
ScalarGrid ellipsoid(int n, double scale = 1.0) {
  std::vector<float> values;
  const double middle = 0.5 * (n - 1);
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const Eigen::Array3d p(x - middle, y - middle, z - middle);
        values.push_back(static_cast<float>(scale * ((p / Eigen::Array3d(0.4, 0.3, 0.22) / n).matrix().norm() < 1.0)));
      }
  return ScalarGrid({n, n, n}, Eigen::Affine3d::Identity(), std::move(values));
}

TEST(ScalarGrid, InterpolatesLinearFunctionsExactly) {
  std::vector<float> values;
  for (int z = 0; z < 3; ++z)
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 5; ++x) values.push_back(static_cast<float>(1.0 + 2.0 * x - y + 0.5 * z));
  const ScalarGrid grid({5, 4, 3}, Eigen::Affine3d::Identity(), values);
  EXPECT_NEAR(grid.at({3.25, 1.5, 1.75}), 1.0 + 6.5 - 1.5 + 0.875, 1e-6);
  EXPECT_NEAR(grid.at({4.0, 3.0, 2.0}), 1.0 + 8.0 - 3.0 + 1.0, 1e-6) << "the last voxel";
  EXPECT_TRUE(grid.contains({4.0, 3.0, 2.0}));
  EXPECT_FALSE(grid.contains({4.01, 3.0, 2.0}));
  EXPECT_FALSE(grid.contains({0.5, 1.5, 1.0}, Eigen::Vector3d(1.0, 0.0, 0.0)));
}

TEST(ScalarGrid, RefusesWhatDoesNotFit) {
  const Eigen::Affine3d unit = Eigen::Affine3d::Identity();
  EXPECT_THROW(ScalarGrid({2, 2, 2}, unit, std::vector<float>(7)), std::invalid_argument);
  EXPECT_THROW(ScalarGrid({0, 2, 2}, unit, {}), std::invalid_argument);
  Eigen::Affine3d flat = unit;
  flat.linear()(2, 2) = 0.0;
  EXPECT_THROW(ScalarGrid({2, 2, 2}, flat, std::vector<float>(8)), std::invalid_argument);
  EXPECT_THROW(ScalarGrid::placed({1.0, -1.0, 1.0}, Eigen::Vector3d::Zero()), std::invalid_argument);
  EXPECT_THROW((VolumeLevels{2.0, 1.0}.validate()), std::invalid_argument);
}

TEST(VolumeFunction, IsTheSameForAnyScaleOfTheIntensities) {
  const VolumeFunction once(ellipsoid(40), {}, 64'000), thousand(ellipsoid(40, 1000.0), {}, 64'000);
  EXPECT_NEAR(thousand.levels.high, 1000.0, 1e-3);
  ASSERT_EQ(once.f.values().size(), thousand.f.values().size());
  for (std::size_t i = 0; i < once.f.values().size(); ++i)
    ASSERT_NEAR(once.f.values()[i], thousand.f.values()[i], 1e-5);
  EXPECT_GT(once.body, 0.1);
  EXPECT_LT(once.body, 0.9);
}

TEST(VolumeFunction, AveragesUntilThereAreFewVoxelsAndKeepsTheirPlaces) {
  const VolumeFunction few(ellipsoid(64), {}, 40'000);
  EXPECT_LE(few.f.numVoxels(), 40'000u);
  const Points body = few.bodyPoints(false);
  EXPECT_LT((centerOfMass(body) - Eigen::Vector3d::Constant(31.5)).norm(), 0.2);
  const double voxel = few.f.spacing().prod();
  EXPECT_NEAR(body.cols() * voxel, 4.0 / 3.0 * 3.14159 * 0.4 * 0.3 * 0.22 * 64 * 64 * 64, 1000.0);
  EXPECT_LT(few.bodyPoints(true).cols(), body.cols());
}

TEST(VolumeFunction, TellsWhyThereIsNoAnswer) {
  const auto reason = [](const ScalarGrid& grid, const VolumeLevels& levels = {}) {
    return complaintOf<std::invalid_argument>([&] { VolumeFunction(grid, levels, 4096); });
  };
  const Eigen::Affine3d unit = Eigen::Affine3d::Identity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(reason(ScalarGrid({8, 8, 8}, unit, std::vector<float>(512))), "volume: all values are equal");
  EXPECT_EQ(reason(ScalarGrid({8, 8, 8}, unit, std::vector<float>(512, nan))), "volume: no finite value");
  EXPECT_EQ(reason(ScalarGrid({32, 16, 1}, unit, std::vector<float>(512))),
            "volume: slices along an axis = 1, must be >= 4");
  EXPECT_EQ(reason(ellipsoid(16), {5.0, 6.0}), "volume: all values are equal between the levels");
}

TEST(VolumeFunction, MakesTheTransformOfTheVolume) {
  const VolumeFunction volume(ellipsoid(64), {}, 262'144);
  const GaussianEdt edt(volume);
  EXPECT_LT((edt.center() - Eigen::Vector3d::Constant(31.5)).norm(), 3.0) << "of a ball a little larger than the least";
  const PlaneGrid grid(16, 32, 32, Eigen::Vector3d::Constant(31.5), edt.radius());
  ConvolutionTransformOptions exact;
  SampledTransformOptions sampled;
  sampled.num_samples = 4096;
  const SymmetryMap a = convolutionTransform(edt, grid, exact), b = sampledTransform(edt, grid, sampled);
  double sq_error = 0.0;
  for (std::size_t i = 0; i < grid.size(); ++i) sq_error += std::pow(a.prst(i) - b.prst(i), 2);
  EXPECT_LT(std::sqrt(sq_error / grid.size()), 0.01) << "the estimators take a volume as they take points";
  EXPECT_GT(a[a.strongest()], 0.95);

  // At a scale: through the middle of the ellipsoid, and where there is nothing.
  LocalSymmetryOptions local;
  local.scale = 0.6 * edt.radius();
  Points at = Points::Constant(3, 2, 31.5f);
  at(2, 1) += static_cast<float>(3.0 * edt.radius());
  const std::vector<float> values = localSymmetry(edt, at, local);
  EXPECT_GT(values[0], 0.95);
  EXPECT_EQ(values[1], 0.0f);
}

}  // namespace
