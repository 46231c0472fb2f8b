#include "pcl_symmetry/core/gaussian_edt_2d.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "shapes/contours.h"

namespace pcl_symmetry {
namespace {

using namespace test;

TEST(GaussianEdt2D, RefusesWhatItCannotUse) {
  EXPECT_THROW(GaussianEdt2D(Points2D(2, 0)), std::invalid_argument);
  EXPECT_THROW(GaussianEdt2D(Points2D::Constant(2, 9, 0.3f)), std::invalid_argument);
  Points2D broken = Points2D::Random(2, 5);
  broken(1, 3) = std::numeric_limits<float>::infinity();
  EXPECT_THROW(GaussianEdt2D{broken}, std::invalid_argument);
  GaussianEdt2DOptions options;
  options.num_cells = 4;
  EXPECT_THROW(options.validate(), std::invalid_argument);
}

TEST(GaussianEdt2D, IsTheGaussianOfTheDistance) {
  const Points2D contour = starfish(0.0, 1, 300);
  const GaussianEdt2D edt = GaussianEdt2D(contour);
  for (int i = 0; i < edt.numCells() * edt.numCells(); i += 11) {
    const Eigen::Vector2d x = edt.origin() + edt.cellSize() * Eigen::Vector2d(i % edt.numCells(), i / edt.numCells());
    const double sq_distance = (contour.cast<double>().colwise() - x).colwise().squaredNorm().minCoeff();
    const double f = std::exp(-sq_distance / (edt.sigma() * edt.sigma()));
    EXPECT_NEAR(edt.values()[i], f > 1.2e-3 ? f : 0.0, 1.2e-3);
  }
}

TEST(GaussianEdt2D, PointsFarOutsideTheDiskAreNoHarm) {
  Points2D points(2, 3);
  points << 0.0f, 3e9f, -1e30f, 0.0f, -3e9f, 0.0f;
  GaussianEdt2DOptions options;
  options.radius = 1.0;
  options.sigma = 0.1;
  EXPECT_EQ(GaussianEdt2D(points, options).values(), GaussianEdt2D(points.leftCols(1), options).values());
}

TEST(Flattened, GivesThePointsOfTheSheet) {
  Points flat = Points::Random(3, 50);
  flat.row(2).setConstant(4.0f);
  const Sheet kept = flattened(flat);
  EXPECT_TRUE(kept.points.isApprox(flat.topRows<2>()));
  const Points tilted = (randomPose(3) * flat.cast<double>()).cast<float>();
  const Sheet sheet = flattened(tilted);
  Eigen::Matrix3Xd embedded = Eigen::Matrix3Xd::Zero(3, 50);
  embedded.topRows<2>() = sheet.points.cast<double>();
  EXPECT_LT((sheet.T_input_sheet * embedded - tilted.cast<double>()).cwiseAbs().maxCoeff(), 1e-5);
}

}  // namespace
}  // namespace pcl_symmetry
