/// Eigenvectors of symmetric matrices and equations with them.
#include "core/base/symmetric_solvers.h"

#include <gtest/gtest.h>

namespace pcl_symmetry {
namespace {

Eigen::Matrix3d stretched() {
  Eigen::Matrix3d matrix;
  matrix << 4.0, 1.0, 0.5, 1.0, 3.0, -0.2, 0.5, -0.2, 2.0;
  return matrix;
}

TEST(SymmetricSolvers, EigenvectorsGiveTheMatrixBack) {
  const Eigen::Matrix3d a = stretched();
  const SymmetricEigen<Eigen::Matrix3d> eigen(a);
  EXPECT_LT(eigen.eigenvalues()[0], eigen.eigenvalues()[1]);
  EXPECT_LT(eigen.eigenvalues()[1], eigen.eigenvalues()[2]);
  const Eigen::Matrix3d product =
      eigen.eigenvectors() * eigen.eigenvalues().asDiagonal() * eigen.eigenvectors().transpose();
  EXPECT_TRUE(product.isApprox(a, 1e-12));
  const SymmetricEigen<Eigen::Matrix3f> quick(a.cast<float>());
  EXPECT_TRUE(quick.eigenvalues().isApprox(eigen.eigenvalues().cast<float>(), 1e-5f));
}

TEST(SymmetricSolvers, SolutionsSolve) {
  const Eigen::Vector3d x(1.0, -2.0, 0.5), b = stretched() * x;
  EXPECT_TRUE(solveSymmetric(stretched(), b).isApprox(x, 1e-12));
  EXPECT_TRUE(SymmetricEigen<Eigen::Matrix3d>(stretched()).solve(b, 1e-9).isApprox(x, 1e-12));
}

TEST(SymmetricSolvers, DirectionsThatNothingFixesStay) {
  const Eigen::Vector3d n = Eigen::Vector3d(1.0, 2.0, 2.0) / 3.0;
  const Eigen::Matrix3d along = 5.0 * n * n.transpose();
  EXPECT_TRUE(SymmetricEigen<Eigen::Matrix3d>(along).solve(Eigen::Vector3d(10.0 * n), 1e-9).isApprox(2.0 * n, 1e-12));
  EXPECT_TRUE(SymmetricEigen<Eigen::Matrix3d>(Eigen::Matrix3d::Zero()).solve(n, 1e-9).isZero());
}

}  // namespace
}  // namespace pcl_symmetry
