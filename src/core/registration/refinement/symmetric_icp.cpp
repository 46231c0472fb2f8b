#include "core/registration/refinement/symmetric_icp.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace pcl_symmetry {

namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr int kLeastPairs = 3;  // derived: as in pcl::Registration

/// The first points of a scan, and where a pose puts them.
class MovedScan {
public:
  MovedScan(const PosedSurface& scan, int num_points)
      : scan_(scan), places_(3, std::min<Eigen::Index>(num_points, scan.points.cols())), normals_(3, places_.cols()) {}

  void moveTo(const Eigen::Isometry3d& pose) {
    const Eigen::Matrix3f rotation = pose.linear().cast<float>();
    const Eigen::Vector3f translation = pose.translation().cast<float>();
    for (Eigen::Index i = 0; i < places_.cols(); ++i) {
      const int point = scan_.order[static_cast<std::size_t>(i)];
      places_.col(i) = rotation * scan_.points.col(point) + translation;
      normals_.col(i) = rotation * scan_.normals.col(point);
    }
  }

  const Points& places() const { return places_; }
  const Points& normals() const { return normals_; }

private:
  const PosedSurface& scan_;
  Points places_, normals_;
};

/// Least squares in half a rotation vector and a translation.
struct StepEquations {
  Eigen::Matrix3d turns = Eigen::Matrix3d::Zero(), mixed = turns, moves = turns;
  Eigen::Vector3d of_turn = Eigen::Vector3d::Zero(), of_move = of_turn;
  int num_pairs = 0;

  void add(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& normal) {
    const Eigen::Vector3d lever = (p + q).cross(normal);
    const double apart = (q - p).dot(normal);
    turns += lever * lever.transpose();
    mixed += normal * lever.transpose();
    moves += normal * normal.transpose();
    of_turn += apart * lever;
    of_move += apart * normal;
    ++num_pairs;
  }

  /// The motion: half of the turn, the translation, the other half.
  Eigen::Isometry3d motion() const {
    Eigen::Matrix<double, 6, 6> hessian;
    hessian << turns, mixed.transpose(), mixed, moves;
    Vector6d gradient;
    gradient << of_turn, of_move;
    const Vector6d step = hessian.selfadjointView<Eigen::Lower>().ldlt().solve(gradient);
    const Eigen::Quaterniond half = Eigen::AngleAxisd(step[2], Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(step[1], Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(step[0], Eigen::Vector3d::UnitX());
    return half * Eigen::Translation3d(step.tail<3>()) * half;
  }
};

StepEquations equationsOf(const MovedScan& scan, const PosedSurface& model, const std::vector<int>& closest) {
  StepEquations equations;
  for (std::size_t i = 0; i < closest.size(); ++i) {
    if (closest[i] < 0) continue;
    const auto at = static_cast<Eigen::Index>(i);
    const Eigen::Vector3d n = scan.normals().col(at).cast<double>(),
                          other = model.normals.col(closest[i]).cast<double>();
    equations.add(scan.places().col(at).cast<double>(), model.points.col(closest[i]).cast<double>(),
                  n.dot(other) >= 0.0 ? Eigen::Vector3d(n + other) : Eigen::Vector3d(n - other));
  }
  return equations;
}

}  // namespace

Eigen::Isometry3d refinedBySymmetricICP(const PosedSurface& scan, const PosedSurface& model,
                                        const Eigen::Isometry3d& start, const SymmetricICPOptions& options) {
  MovedScan moved(scan, options.num_points);
  std::vector<int> closest(static_cast<std::size_t>(moved.places().cols()), -1);
  std::vector<float> sq_distances;
  Eigen::Isometry3d pose = start;
  for (int i = 0; i < options.max_iterations; ++i) {
    moved.moveTo(pose);
    model.search->searchWithin(moved.places(), static_cast<float>(options.reach * options.reach), closest,
                               sq_distances);
    const StepEquations equations = equationsOf(moved, model, closest);
    if (equations.num_pairs < kLeastPairs) break;
    const Eigen::Isometry3d motion = equations.motion();
    if (!motion.matrix().allFinite()) return start;
    pose = motion * pose;
    if (motion.translation().squaredNorm() <= options.translation_epsilon &&
        0.5 * (motion.linear().trace() - 1.0) >= 1.0 - options.rotation_epsilon)
      break;
  }
  return pose;
}

}  // namespace pcl_symmetry
