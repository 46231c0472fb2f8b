#include "pcl_symmetry/viewpoint_selection.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "pcl_symmetry/core/visibility.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"

namespace pcl_symmetry {

namespace {

// Radians. chosen: half shows the object with less perspective from twice the distance, twice with more.
constexpr double kViewAngle = 25.0 * kPi / 180.0;
// Share of the best score. chosen: views this close to the best show as much. A smaller share takes views that show
// less, a larger one leaves the choice between mirrored views to rounding.
constexpr double kNearBest = 0.98;
// chosen: half is faster and misses small parts in the count of hidden points, twice is slower and changes little.
constexpr std::size_t kMaxPoints = 20'000;

/// \return the share of the points that others hide from a camera in this direction, in [0, 1].
double hiddenShare(const Points& points, const BoundingBall& ball, const Eigen::Vector3d& direction) {
  // Radii. chosen: a nearer camera sees less of the sides, a farther one sees the same.
  constexpr double kDistance = 5.0;
  // Radii. chosen: a smaller margin counts points on rough or slanted surfaces as hidden, a larger one misses thin
  // parts.
  constexpr double kMargin = 0.05;
  const auto seen = Visibility::fromPoints(points, ball.center + kDistance * ball.radius * direction);
  return seen ? seen->hiddenShare(points, kMargin * ball.radius) : 1.0;
}

/// \return the direction and its images under up to three reflections in a row.
std::vector<Eigen::Vector3d> mirrorImages(const Eigen::Vector3d& direction,
                                          const std::vector<Eigen::Vector3d>& normals) {
  constexpr int kReflections = 3;       // derived: gives all eight images in three perpendicular planes
  constexpr double kSame = 1.0 - 1e-6;  // cosine. chosen: far above rounding, far below the angle between two views
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

/// \return whether no direction has less than a fifth of the best score.
bool seenFromEverywhere(const std::vector<ViewPlane>& planes) {
  // Share of the best score. chosen: half leaves a mug without a plane across its axis, twice adds weak maxima to
  // boxes.
  constexpr double kLeast = 0.2;
  const std::vector<RankedView> best = bestViews(planes);
  return !best.empty() && worstView(planes).score >= kLeast * best[0].score;
}

SelectedView noView() {
  return {{Eigen::Vector3d::Zero(), 0.0}, Eigen::Affine3f::Identity()};
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
  // Planes. chosen: S varies about the axis by 1 - cos(pi / (2 kFan)) = 2 %; with half as many 8 %, with twice 0.5 %.
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
    constexpr double kAcross = 0.5;  // cosine of 60 degrees. chosen: smaller leaves gaps, larger repeats known planes
    const bool near = std::any_of(planes_.begin(), planes_.end(),
                                  [&](const ViewPlane& plane) { return std::abs(plane.normal.dot(n)) > kAcross; });
    if (!near) planes_.push_back({n, maximum.value});
  }
  std::stable_sort(planes_.begin(), planes_.end(), [](const auto& a, const auto& b) { return a.weight > b.weight; });
}

void ViewpointSelection::setInputCloud(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud) {
  points_ = cloud ? detail::selectPoints(*cloud, nullptr, kMaxPoints, 1).points : Points(3, 0);
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
  // Cosine. chosen: a smaller value misses perpendicular planes that were found with errors, a larger one takes planes
  // that are not perpendicular.
  constexpr double kAcross = 0.05;
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
  // An axis that is far from the given direction would tilt the object: the given direction is up then.
  // Cosine of 37 degrees. chosen: a smaller value tilts objects, a larger one leaves axes unused.
  constexpr double kFar = 0.8;
  return std::abs(best.dot(up_)) < kFar ? up_ : Eigen::Vector3d(std::copysign(1.0, best.dot(up_)) * best);
}

Eigen::Affine3f ViewpointSelection::computePose(const Eigen::Vector3d& direction) const {
  detail::withBadArguments([&] {
    check(direction.allFinite() && direction.norm() > 0.0, "direction", direction.transpose(), "finite and not zero");
  });
  const Eigen::Vector3d forward = -direction.normalized();
  Eigen::Vector3d up = getUpAxis();
  // Cosine of 11 degrees. chosen: a larger value lets cameras near the axis spin, a smaller one tilts oblique views.
  constexpr double kAlong = 0.98;
  if (std::abs(up.dot(forward)) > kAlong) {
    // From above or below: the strongest plane stands upright in the picture.
    const Eigen::Vector3d across = planes_.empty() ? up.unitOrthogonal() : Eigen::Vector3d(planes_[0].normal);
    const Eigen::Vector3d along = forward.cross(across);
    constexpr double kLeastAlong = 0.1;  // sine of 6 degrees. chosen: smaller amplifies errors of the normal
    up = along.norm() > kLeastAlong ? along : up.unitOrthogonal();
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
  // Sine of the elevation. chosen: level views have rounding to either side; a lower value counts views from below.
  constexpr double kAbove = -0.05;
  const Eigen::Vector3d up = getUpAxis();
  std::vector<RankedView> from_above;
  for (const RankedView& view : views)
    if (view.direction.dot(up) > kAbove) from_above.push_back(view);
  const std::vector<RankedView>& candidates = from_above.empty() ? views : from_above;
  std::vector<double> hidden;
  for (const RankedView& view : candidates) hidden.push_back(hiddenShare(points_, ball_, view.direction));
  return candidates[std::min_element(hidden.begin(), hidden.end()) - hidden.begin()];
}

bool ViewpointSelection::hasExtent() const {
  if (ball_.radius > 0.0) return true;
  detail::warnOfNoAnswer("ViewpointSelection", points_.cols() == 0 ? "input cloud: no finite point"
                                                                   : "input cloud: all points are at one place");
  return false;
}

SelectedView ViewpointSelection::getBestView() const {
  const std::vector<SelectedView> views = getGoodViews(1);
  return views.empty() ? noView() : views[0];
}

SelectedView ViewpointSelection::getWorstView() const {
  if (!hasExtent()) return noView();
  const RankedView worst = planes_.empty() ? RankedView{Eigen::Vector3d::UnitX(), 0.0} : worstView(planes_);
  const RankedView view = leastHidden({worst, {-worst.direction, worst.score}});
  return {view, computePose(view.direction)};
}

std::vector<SelectedView> ViewpointSelection::getGoodViews(int num_views) const {
  detail::withBadArguments([&] { check(num_views >= 1, "num_views", num_views, ">= 1"); });
  if (!hasExtent()) return {};
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
