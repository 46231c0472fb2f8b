#include "core/registration/pose_evidence.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/constants.h"
#include "core/base/small_motion.h"
#include "core/base/statistics.h"
#include "core/base/symmetric_solvers.h"
#include "core/registration/registration_rules.h"

namespace pcl_symmetry {

namespace {

/// Point-to-plane distances at a pose.
struct Residuals {
  double sum_squares = 0.0;
  int count = 0;
  Matrix6d hessian = Matrix6d::Zero();
  /// Gain of the Hessian per squared radian of normal error.
  Matrix6d gain_of_noise = Matrix6d::Zero();
  std::vector<double> sq_sines;  ///< between the normals of corresponding points
};

Residuals residualsAt(const PosedSurface& scan, const PosedSurface& model, const Eigen::Isometry3d& T_model_scan,
                      int num_points, double reach) {
  const Landing landing = land(scan, model, T_model_scan, num_points);
  Residuals residuals;
  for (Eigen::Index i = 0; i < landing.images.cols(); ++i) {
    if (landing.sq_distances[i] > reach * reach) continue;
    const int j = landing.closest[i];
    const Eigen::Vector3d x = landing.images.col(i).cast<double>(), n = model.normals.col(j).cast<double>();
    const Eigen::Vector3d rotated = T_model_scan.linear() * scan.normals.col(scan.order[i]).cast<double>();
    Eigen::Matrix<double, WeightedProducts::kLast, 3> lever;
    lever << crossMatrix(x), Eigen::Matrix3d::Identity();
    const Vector6d row = lever * n;
    const double distance = n.dot(x - model.points.col(j).cast<double>());
    residuals.hessian += row * row.transpose();
    // A normal has errors in the two directions perpendicular to it, with half of the squared error in each.
    residuals.gain_of_noise += 0.5 * lever * (Eigen::Matrix3d::Identity() - n * n.transpose()) * lever.transpose();
    residuals.sum_squares += distance * distance;
    residuals.sq_sines.push_back(n.cross(rotated).squaredNorm());
    ++residuals.count;
  }
  return residuals;
}

/// The Hessian of the residuals without the part due to noise of the normals, which would constrain directions along
/// which the surface slides on itself.
Matrix6d hessianWithoutNoise(Residuals residuals) {
  // The squares of errors in two directions have an exponential distribution; its mean is the median over
  // log 2.
  const double sq_noise = median(std::move(residuals.sq_sines)) / std::log(2.0);
  const SymmetricEigen<Matrix6d> solver(residuals.hessian - sq_noise * residuals.gain_of_noise);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace

Matrix6d poseCovariance(const PosedSurface& scan, const PosedSurface& model, const Eigen::Isometry3d& T_model_scan,
                        int num_points, double reach) {
  // The variance of an angle that is uniform in (-pi, pi), and a translation by the radius of the model.
  const double sq_angle = kPi * kPi / 3.0, sq_way = 1.0;
  Matrix6d information = Matrix6d::Zero();
  information.diagonal().head<3>().setConstant(1.0 / sq_angle);
  information.diagonal().tail<3>().setConstant(1.0 / sq_way);
  Residuals residuals = residualsAt(scan, model, T_model_scan, num_points, reach);
  if (residuals.count > WeightedProducts::kLast) {
    const double variance = residuals.sum_squares / (residuals.count - WeightedProducts::kLast);
    information += hessianWithoutNoise(std::move(residuals)) /
                   std::max(kRegistration.min_deviation * kRegistration.min_deviation, variance);
  }
  return information.inverse();
}

}  // namespace pcl_symmetry
