#include "registration/pose_graph.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <numeric>

#include "core/base/small_motion.h"

namespace pcl_symmetry {

namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

constexpr int kSize = Vector6d::RowsAtCompileTime;  // parameters of the motion of a scan

void addBlock(Triplets& matrix, int row, int column, const Matrix6d& block) {
  for (int j = 0; j < kSize; ++j)
    for (int i = 0; i < kSize; ++i) matrix.emplace_back(kSize * row + i, kSize * column + j, block(i, j));
}

Vector6d smallMotionOf(const Eigen::Isometry3d& motion) {
  const Eigen::AngleAxisd rotation(motion.linear());
  Vector6d small;
  small << rotation.angle() * rotation.axis(), motion.translation();
  return small;
}

/// The weight of each answer, plus half the weight of each triangle that it closes with two others.
std::vector<double> votesOf(int num_scans, const std::vector<PairAnswer>& answers, const SamePose& same) {
  struct Other {
    int scan;
    Eigen::Isometry3d T_scan_other;
    double weight;
  };
  std::vector<std::vector<Other>> others(num_scans);
  for (const PairAnswer& answer : answers) {
    others[answer.target].push_back({answer.source, answer.T_target_source, answer.weight});
    others[answer.source].push_back({answer.target, answer.T_target_source.inverse(), answer.weight});
  }
  std::vector<double> votes;
  for (const PairAnswer& answer : answers) {
    double sum = answer.weight;
    for (const Other& a : others[answer.target])
      for (const Other& b : others[answer.source])
        if (a.scan == b.scan && same(answer.T_target_source, a.T_scan_other * b.T_scan_other.inverse()))
          sum += 0.5 * std::min(a.weight, b.weight);
    votes.push_back(answer.weight > 0.0 ? sum : 0.0);
  }
  return votes;
}

}  // namespace

void adjustPoses(const std::vector<PoseConstraint>& constraints, std::vector<Eigen::Isometry3d>& T_world_scan,
                 int num_steps) {
  constexpr double inertia = 1e-6;  // as a share of the mean stiffness; it keeps unconstrained directions at rest
  const int size = kSize * static_cast<int>(T_world_scan.size());
  for (int step = 0; step < num_steps && !constraints.empty(); ++step) {
    Triplets entries;
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(size);
    double stiffness = 0.0;
    for (const PoseConstraint& known : constraints) {
      const Eigen::Isometry3d T_target_world = T_world_scan[known.target].inverse();
      const Vector6d off = smallMotionOf(T_target_world * T_world_scan[known.source] * known.T_target_source.inverse());
      const Matrix6d to_target = adjoint(T_target_world);
      const Matrix6d pull = to_target.transpose() * known.information;
      const Matrix6d block = pull * to_target;
      addBlock(entries, known.source, known.source, block);
      addBlock(entries, known.target, known.target, block);
      addBlock(entries, known.source, known.target, -block);
      addBlock(entries, known.target, known.source, -block);
      gradient.segment<kSize>(kSize * known.source) += pull * off;
      gradient.segment<kSize>(kSize * known.target) -= pull * off;
      stiffness += block.trace() / (kSize * static_cast<double>(constraints.size()));
    }
    for (int i = 0; i < size; ++i) entries.emplace_back(i, i, inertia * stiffness);
    Eigen::SparseMatrix<double> hessian(size, size);
    hessian.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(hessian);
    const Eigen::VectorXd motion = solver.solve(gradient);
    if (solver.info() != Eigen::Success || !motion.allFinite()) return;
    for (std::size_t k = 0; k < T_world_scan.size(); ++k)
      T_world_scan[k] = motionBy(-motion.segment<kSize>(kSize * static_cast<Eigen::Index>(k))) * T_world_scan[k];
  }
}

bool SamePose::operator()(const Eigen::Isometry3d& T_a_b, const Eigen::Isometry3d& other) const {
  return (T_a_b.translation() - other.translation()).norm() <= distance &&
         Eigen::AngleAxisd(T_a_b.linear().transpose() * other.linear()).angle() <= angle;
}

bool ScanGroups::agrees(const PairAnswer& answer, const SamePose& same) const {
  return group[answer.source] == group[answer.target] &&
         same(answer.T_target_source, T_group_scan[answer.target].inverse() * T_group_scan[answer.source]);
}

ScanGroups joinScans(int num_scans, const std::vector<PairAnswer>& answers, const SamePose& same, double min_votes) {
  ScanGroups groups{std::vector<int>(num_scans),
                    std::vector<Eigen::Isometry3d>(num_scans, Eigen::Isometry3d::Identity())};
  std::iota(groups.group.begin(), groups.group.end(), 0);
  const std::vector<double> votes = votesOf(num_scans, answers, same);
  const auto groupsOf = [&](const PairAnswer& answer) {
    return std::minmax({groups.group[answer.source], groups.group[answer.target]});
  };
  while (true) {
    const PairAnswer* best = nullptr;
    double best_sum = min_votes;
    for (std::size_t e = 0; e < answers.size(); ++e) {
      const auto between = groupsOf(answers[e]);
      if (between.first == between.second || votes[e] == 0.0) continue;
      const Eigen::Isometry3d& T_target_source = answers[e].T_target_source;
      double sum = 0.0;
      for (std::size_t f = 0; f < answers.size(); ++f) {
        if (groupsOf(answers[f]) != between) continue;
        // The other answer, as a pose between the scans of this one.
        const bool reversed = groups.group[answers[f].target] != groups.group[answers[e].target];
        const PairAnswer& other = answers[f];
        const Eigen::Isometry3d T_group_group =
            groups.T_group_scan[other.target] * other.T_target_source * groups.T_group_scan[other.source].inverse();
        const Eigen::Isometry3d implied = groups.T_group_scan[answers[e].target].inverse() *
                                          (reversed ? T_group_group.inverse() : T_group_group) *
                                          groups.T_group_scan[answers[e].source];
        sum += (same(T_target_source, implied) ? 1.0 : -1.0) * votes[f];
      }
      if (sum >= best_sum && (!best || sum > best_sum)) {
        best = &answers[e];
        best_sum = sum;
      }
    }
    if (!best) break;
    const Eigen::Isometry3d T_group_other =
        groups.T_group_scan[best->target] * best->T_target_source * groups.T_group_scan[best->source].inverse();
    const int group = groups.group[best->target], other = groups.group[best->source];
    for (int k = 0; k < num_scans; ++k) {
      if (groups.group[k] != other) continue;
      groups.group[k] = group;
      groups.T_group_scan[k] = T_group_other * groups.T_group_scan[k];
    }
  }
  // Least deviation of an answer from its neighbors: the covariances of single pairs account only for noise.
  constexpr double min_deviation = 0.005;
  std::vector<PoseConstraint> constraints;
  for (const PairAnswer& answer : answers)
    if (answer.weight > 0.0 && groups.agrees(answer, {2.0 * same.angle, 2.0 * same.distance}))
      constraints.push_back(
          {answer.source, answer.target, answer.T_target_source,
           (answer.covariance + min_deviation * min_deviation * Matrix6d::Identity()).inverse() * answer.weight});
  adjustPoses(constraints, groups.T_group_scan, 3);
  return groups;
}

}  // namespace pcl_symmetry
