#include "core/normals/revolution_of_normals.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

namespace pcl_symmetry {

namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// Radians by which a normal may miss at half its weight. chosen: the error of normals of samples with noise of a third
// of their spacing; at half, good points lose their weight, at twice, handles keep theirs.
constexpr double kMiss = 0.1;
constexpr int kReweightings = 8;  // chosen: half leaves bodies with a base at the start, twice changes nothing
// Radii. chosen: the speed of points nearer than this to the axis does not divide; at half, single points decide.
constexpr double kLeastLever = 0.05;
// Share of the trace. chosen: only keeps the translation along a cylinder from growing without bound.
constexpr double kTranslationRidge = 1e-6;

double weightOf(double miss) {
  const double scaled = miss / kMiss, sum = 1.0 + scaled * scaled;
  return 1.0 / (sum * sum);
}

/// A motion of space: turn and shift, so that a point x moves by shift + turn x x.
struct Motion {
  Eigen::Vector3d turn, shift;

  Eigen::Vector3d velocityAt(const Eigen::Vector3d& x) const { return shift + turn.cross(x); }
};

/// The motion with a turn of length one that moves the samples the least along their normals.
Motion slowestAlongNormals(const Matrix6d& sum) {
  Eigen::Matrix3d shifts = sum.bottomRightCorner<3, 3>();
  shifts.diagonal().array() += kTranslationRidge * std::max(1e-12, shifts.trace());
  const Eigen::Matrix3d coupling = sum.topRightCorner<3, 3>();
  const Eigen::Matrix3d best_shifts = -shifts.ldlt().solve(coupling.transpose());
  const Eigen::Matrix3d turns = sum.topLeftCorner<3, 3>() + coupling * best_shifts;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(0.5 * (turns + turns.transpose()));
  const Eigen::Vector3d turn = solver.eigenvectors().col(0);
  const Eigen::Vector3d shift = best_shifts * turn;
  return {turn, shift - turn.dot(shift) * turn};  // without the translation along the axis
}

}  // namespace

Eigen::ParametrizedLine<double, 3> axisOfNormals(const Points& points, const Points& normals,
                                                 const std::vector<int>& samples) {
  std::vector<double> weights(samples.size(), 1.0);
  Motion motion{Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero()};
  for (int k = 0; k < kReweightings; ++k) {
    Matrix6d sum = Matrix6d::Zero();
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Eigen::Vector3d x = points.col(samples[i]).cast<double>(), n = normals.col(samples[i]).cast<double>();
      Vector6d along;  // of the normal, by turn and by shift
      along << x.cross(n), n;
      sum += weights[i] * along * along.transpose();
    }
    motion = slowestAlongNormals(sum);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Eigen::Vector3d x = points.col(samples[i]).cast<double>(), n = normals.col(samples[i]).cast<double>();
      const Eigen::Vector3d velocity = motion.velocityAt(x);
      const double lever = std::max(kLeastLever, velocity.norm());
      weights[i] = weightOf(velocity.dot(n) / lever) / (lever * lever);
    }
  }
  // The axis is where the motion stands still.
  return {motion.turn.cross(motion.shift), motion.turn};
}

Eigen::Vector3d centerOfNormals(const Points& points, const Points& normals, const std::vector<int>& samples) {
  std::vector<double> weights(samples.size(), 1.0);
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (int k = 0; k < kReweightings; ++k) {
    Eigen::Matrix3d sum = 1e-9 * Eigen::Matrix3d::Identity();
    Eigen::Vector3d pull = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Eigen::Vector3d x = points.col(samples[i]).cast<double>(), n = normals.col(samples[i]).cast<double>();
      const Eigen::Matrix3d across = weights[i] * (Eigen::Matrix3d::Identity() - n * n.transpose());
      sum += across;
      pull += across * x;
    }
    center = sum.ldlt().solve(pull);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Eigen::Vector3d d = points.col(samples[i]).cast<double>() - center;
      const double lever = std::max(kLeastLever, d.norm());
      weights[i] = weightOf(d.cross(normals.col(samples[i]).cast<double>()).norm() / lever) / (lever * lever);
    }
  }
  return center;
}

}  // namespace pcl_symmetry
