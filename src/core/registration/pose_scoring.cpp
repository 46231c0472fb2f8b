#include "core/registration/pose_scoring.h"

#include <algorithm>
#include <cmath>

#include "core/registration/pose_covariance.h"
#include "core/registration/registration_rules.h"

namespace pcl_symmetry {

namespace {

/// The first points of a surface in the frame of another, each with its closest point there.
struct Matches {
  Points positions, normals;
  std::vector<int> closest;
};

Matches match(const PosedSurface& from, const PosedSurface& to, const Eigen::Isometry3d& T_to_from,
              const PoseScorer::Detail& detail) {
  const auto size = std::min<Eigen::Index>(detail.num_points, from.points.cols());
  const Eigen::Matrix3f rotation = T_to_from.linear().cast<float>();
  const Eigen::Vector3f translation = T_to_from.translation().cast<float>();
  Matches matches{Points(3, size), Points(3, size), std::vector<int>(size)};
  for (Eigen::Index i = 0; i < size; ++i) {
    matches.positions.col(i) = rotation * from.points.col(from.order[i]) + translation;
    matches.normals.col(i) = rotation * from.normals.col(from.order[i]);
  }
  if (detail.exact) {
    std::vector<float> sq_distances;
    to.search->search(matches.positions, 1, matches.closest, sq_distances);
  } else {
    const ClosestPointGrid& grid = to.grid.get();
    for (Eigen::Index i = 0; i < size; ++i) matches.closest[i] = grid.closest(matches.positions.col(i));
  }
  return matches;
}

float gaussian(double distance, double width) {
  return static_cast<float>(std::exp(-distance * distance / (width * width)));
}

/// The Gaussian of the distance of a match from its closest point.
float nearness(const Matches& matches, Eigen::Index i, const PosedSurface& to, double width) {
  const float factor = static_cast<float>(-1.0 / (width * width));
  return std::exp(factor * (to.points.col(matches.closest[i]) - matches.positions.col(i)).squaredNorm());
}

/// The Gaussian of the distance of a match from the disc about its closest point: flat, as wide as points are apart.
float nearnessOfSurface(const Matches& matches, Eigen::Index i, const PosedSurface& to, double width) {
  const int j = matches.closest[i];
  const Eigen::Vector3f apart = matches.positions.col(i) - to.points.col(j);
  const float height = apart.dot(to.normals.col(j)), sq_height = height * height;
  const float across = std::sqrt(std::max(0.0f, apart.squaredNorm() - sq_height));
  const float beyond = std::max(0.0f, across - to.spacing[j]);
  return std::exp(static_cast<float>(-1.0 / (width * width)) * (sq_height + beyond * beyond));
}

/// Share of a point's support that its normal leaves it: 1 where it is parallel to that of the closest point.
float normalFactor(const Matches& matches, Eigen::Index i, const PosedSurface& to) {
  const float cosine = matches.normals.col(i).dot(to.normals.col(matches.closest[i]));
  return 1.0f - kRegistration.normal_share + kRegistration.normal_share * cosine * cosine;
}

/// Whether a scanner looked through the position of a match.
bool isInFreeSpace(const Matches& matches, Eigen::Index i, const PosedSurface& to) {
  return to.seen->depthBehind(matches.positions.col(i).cast<double>()) < 0.0;
}

}  // namespace

PoseScore PoseScorer::score(const Eigen::Isometry3d& T_model_scan, const Detail& detail) const {
  PoseScore score;
  const Matches on_model = match(scan_, model_, T_model_scan, detail);
  double unexplained = 0.0;
  for (Eigen::Index i = 0; i < on_model.positions.cols(); ++i) {
    const float near = detail.from_surface ? nearnessOfSurface(on_model, i, model_, detail.width)
                                           : nearness(on_model, i, model_, detail.width);
    score.support += detail.from_surface ? near : near * normalFactor(on_model, i, model_);
    if (model_.seen && isInFreeSpace(on_model, i, model_)) unexplained += 1.0 - near;
  }
  score.support /= static_cast<double>(on_model.positions.cols());
  score.conflict = unexplained / static_cast<double>(on_model.positions.cols());
  if (!scan_.seen) return score;
  const Matches on_scan = match(model_, scan_, T_model_scan.inverse(), detail);
  double conflict = 0.0, judged = kRegistration.min_judged * static_cast<double>(on_scan.positions.cols());
  for (Eigen::Index i = 0; i < on_scan.positions.cols(); ++i) {
    const double depth = scan_.seen->depthBehind(on_scan.positions.col(i).cast<double>());
    // Beside the scan there may be more that the scanner measured: a piece of the object that was cut off.
    const double on_surface = detail.from_surface ? std::max(nearnessOfSurface(on_scan, i, scan_, detail.width),
                                                             gaussian(depth, detail.width))
                                                  : nearness(on_scan, i, scan_, detail.width);
    conflict += depth < 0.0 ? 1.0 - on_surface : 0.0;
    judged += depth < 0.0 ? 1.0 : on_surface;
  }
  score.conflict += conflict / judged;
  return score;
}

Eigen::Isometry3d PoseScorer::step(const Eigen::Isometry3d& T_model_scan, const Detail& detail) const {
  MotionEquations equations(detail.unit);
  const Matches on_model = match(scan_, model_, T_model_scan, detail);
  for (Eigen::Index i = 0; i < on_model.positions.cols(); ++i) {
    const int j = on_model.closest[i];
    const double weight = nearness(on_model, i, model_, detail.width) * normalFactor(on_model, i, model_);
    const Eigen::Vector3d x = on_model.positions.col(i).cast<double>(), y = model_.points.col(j).cast<double>();
    equations.addPlane(x, y, model_.normals.col(j).cast<double>(), (1.0 - kRegistration.point_share) * weight);
    equations.addPoint(x, y, kRegistration.point_share * weight);
  }
  if (scan_.seen) {
    const Matches on_scan = match(model_, scan_, T_model_scan.inverse(), detail);
    const double share =
        kRegistration.silhouette_share * static_cast<double>(on_model.positions.cols()) / on_scan.positions.cols();
    for (Eigen::Index i = 0; i < on_scan.positions.cols(); ++i) {
      if (!isInFreeSpace(on_scan, i, scan_)) continue;
      const double weight = nearness(on_scan, i, scan_, detail.width);
      const Eigen::Vector3d moving = T_model_scan * scan_.points.col(on_scan.closest[i]).cast<double>();
      equations.addPoint(moving, model_.points.col(model_.order[i]).cast<double>(), share * weight);
    }
  }
  return equations.motion() * T_model_scan;
}

}  // namespace pcl_symmetry
