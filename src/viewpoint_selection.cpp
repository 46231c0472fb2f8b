#include "pcl_symmetry/viewpoint_selection.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "pcl_symmetry/core/scan/visibility.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"

namespace pcl_symmetry {

namespace {

constexpr double kViewAngle = 25.0 * kPi / 180.0;
constexpr double kNearBest = 0.98;
constexpr std::size_t kMaxPoints = 20'000;

/// How many of the points others hide from a camera there, in [0, 1].
double hiddenShare(const Points& points, const BoundingBall& ball, const Eigen::Vector3d& direction) {
  constexpr double kDistance = 5.0, kMargin = 0.05;  // radii
  const auto seen = Visibility::fromPoints(points, ball.center + kDistance * ball.radius * direction);
  return seen ? seen->hiddenShare(points, kMargin * ball.radius) : 1.0;
}

/// The direction and all that reflections make of it, up to three in a row.
std::vector<Eigen::Vector3d> mirrorImages(const Eigen::Vector3d& direction,
                                          const std::vector<Eigen::Vector3d>& normals) {
  constexpr int kReflections = 3;
  constexpr double kSame = 1.0 - 1e-6;
  std::vector<Eigen::Vector3d> images{direction};
  std::size_t first = 0;
  for (int round = 0; round < kReflections; ++round) {
    const std::size_t last = images.size();
    for (std::size_t i = first; i < last; ++i) {
      for (const Eigen::Vector3d& n : normals) {
        const Eigen::Vector3d image = images[i] - 2.0 * images[i].dot(n) * n;
        const bool known =
            std::any_of(images.begin(), images.end(), [&](const auto& d) { return d.dot(image) > kSame; });
        if (!known) images.push_back(image);
      }
    }
    first = last;
  }
  return images;
}

/// Whether there is no direction with less than a fifth of the best score.
bool seenFromEverywhere(const std::vector<ViewPlane>& planes) {
  constexpr double kLeast = 0.2;
  const std::vector<RankedView> best = bestViews(planes);
  return !best.empty() && worstView(planes).score >= kLeast * best[0].score;
}

}  // namespace

void ViewpointSelection::setPlanes(const std::vector<SymmetryPlane>& planes, const std::vector<SymmetryAxis>& axes,
                                   const std::vector<LocalMaximum>& maxima) {
  planes_.clear();
  symmetries_.clear();
  for (const SymmetryPlane& plane : planes) {
    planes_.push_back({plane.normal(), plane.score});
    if (plane.kind == PlaneKind::Symmetry) symmetries_.push_back(plane.normal());
  }
  constexpr int kFan = 8;
  for (const SymmetryAxis& axis : axes) {
    const Eigen::Vector3d u = axis.direction.unitOrthogonal(), v = axis.direction.cross(u);
    for (int k = 0; k < kFan; ++k) {
      const double angle = kPi * k / kFan;
      planes_.push_back({std::cos(angle) * u + std::sin(angle) * v, 2.0 * axis.score / kFan});
    }
  }
  for (const LocalMaximum& maximum : maxima) {
    if (seenFromEverywhere(planes_)) break;
    const Eigen::Vector3d n = maximum.plane.normal();
    constexpr double kAcross = 0.5;  // cosine
    const bool near = std::any_of(planes_.begin(), planes_.end(),
                                  [&](const ViewPlane& plane) { return std::abs(plane.normal.dot(n)) > kAcross; });
    if (!near) planes_.push_back({n, maximum.value});
  }
  std::stable_sort(planes_.begin(), planes_.end(), [](const auto& a, const auto& b) { return a.weight > b.weight; });
}

void ViewpointSelection::setInputCloud(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud) {
  points_ = cloud ? detail::selectPoints(*cloud, nullptr, kMaxPoints, 1).points : Points();
  ball_ = boundingBall(points_);
}

void ViewpointSelection::setUp(const Eigen::Vector3d& up) {
  detail::withBadArguments(
      [&] { check(up.allFinite() && up.norm() > 0.0, "up", up.transpose(), "finite and not zero"); });
  up_ = up.normalized();
}

void ViewpointSelection::setSeparation(double separation) {
  detail::withBadArguments(
      [&] { check(separation >= 0.0 && separation <= kPi, "separation", separation, "in [0, pi]"); });
  separation_ = separation;
}

Eigen::Vector3d ViewpointSelection::getUpAxis() const {
  if (planes_.empty()) return up_;
  const Eigen::Vector3d first = planes_[0].normal;
  constexpr double kAcross = 0.05;  // cosine
  const auto second = std::find_if(planes_.begin(), planes_.end(),
                                   [&](const ViewPlane& plane) { return std::abs(plane.normal.dot(first)) < kAcross; });
  Eigen::Vector3d best = first;
  const auto consider = [&](const Eigen::Vector3d& axis) {
    if (std::abs(axis.dot(up_)) > std::abs(best.dot(up_))) best = axis;
  };
  const Eigen::Vector3d in_plane = up_ - up_.dot(first) * first;
  if (second != planes_.end()) {
    const Eigen::Vector3d across = (second->normal - second->normal.dot(first) * first).normalized();
    consider(across);
    consider(first.cross(across));
  } else if (in_plane.norm() > kAcross) {
    consider(in_plane.normalized());
  }
  // A far-off axis would tilt the object: up is as it was said then.
  constexpr double kFar = 0.8;
  return std::abs(best.dot(up_)) < kFar ? up_ : Eigen::Vector3d(std::copysign(1.0, best.dot(up_)) * best);
}

Eigen::Affine3f ViewpointSelection::computePose(const Eigen::Vector3d& direction) const {
  if (points_.cols() == 0) detail::throwBadArgument("input cloud: holds no finite point");
  const Eigen::Vector3d forward = -direction.normalized();
  Eigen::Vector3d up = getUpAxis();
  constexpr double kAlong = 0.98;  // cosine
  if (std::abs(up.dot(forward)) > kAlong) {
    // From above or below: the strongest plane stands upright in the picture.
    const Eigen::Vector3d across = planes_.empty() ? up.unitOrthogonal() : Eigen::Vector3d(planes_[0].normal);
    const Eigen::Vector3d along = forward.cross(across);
    up = along.norm() > 0.1 ? along : up.unitOrthogonal();
  }
  const Eigen::Vector3d right = forward.cross(up).normalized();
  Eigen::Matrix3d axes;
  axes << right, forward.cross(right), forward;
  const double distance = ball_.radius / std::sin(0.5 * kViewAngle);
  Eigen::Affine3d pose = Eigen::Affine3d::Identity();
  pose.linear() = axes;
  pose.translation() = ball_.center - distance * forward;
  return pose.cast<float>();
}

RankedView ViewpointSelection::leastHidden(const std::vector<RankedView>& views) const {
  constexpr double kAbove = -0.05;  // sine of the elevation; level views have rounding to either side
  const Eigen::Vector3d up = getUpAxis();
  std::vector<RankedView> from_above;
  for (const RankedView& view : views)
    if (view.direction.dot(up) > kAbove) from_above.push_back(view);
  const std::vector<RankedView>& candidates = from_above.empty() ? views : from_above;
  std::vector<double> hidden;
  for (const RankedView& view : candidates) hidden.push_back(hiddenShare(points_, ball_, view.direction));
  return candidates[std::min_element(hidden.begin(), hidden.end()) - hidden.begin()];
}

SelectedView ViewpointSelection::getBestView() const {
  return getGoodViews(1)[0];
}

SelectedView ViewpointSelection::getWorstView() const {
  const RankedView worst = planes_.empty() ? RankedView{Eigen::Vector3d::UnitX(), 0.0} : worstView(planes_);
  const RankedView view = leastHidden({worst, {-worst.direction, worst.score}});
  return {view, computePose(view.direction)};
}

std::vector<SelectedView> ViewpointSelection::getGoodViews(int num_views) const {
  detail::withBadArguments([&] { check(num_views >= 1, "num_views", num_views, ">= 1"); });
  std::vector<RankedView> remaining = bestViews(planes_);
  if (remaining.empty()) {
    const Eigen::Vector3d up = getUpAxis(), side = up.unitOrthogonal();
    remaining.push_back({(up + 2.0 * side + side.cross(up)).normalized(), 0.0});
  }
  std::vector<SelectedView> views;
  while (!remaining.empty() && static_cast<int>(views.size()) < num_views) {
    std::vector<RankedView> equal;
    for (const RankedView& view : remaining)
      if (view.score >= kNearBest * remaining[0].score) equal.push_back(view);
    const RankedView view = leastHidden(equal);
    views.push_back({view, computePose(view.direction)});
    const std::vector<Eigen::Vector3d> shown = mirrorImages(view.direction, symmetries_);
    const auto taken = [&](const RankedView& other) {
      return other.direction == view.direction || std::any_of(shown.begin(), shown.end(), [&](const auto& direction) {
               return direction.dot(other.direction) > std::cos(separation_);
             });
    };
    remaining.erase(std::remove_if(remaining.begin(), remaining.end(), taken), remaining.end());
  }
  return views;
}

}  // namespace pcl_symmetry
