#include "pcl_symmetry/viewpoint_selection.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "pcl_symmetry/core/visibility.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"

namespace pcl_symmetry {

namespace {

constexpr double view_angle = 25.0 * kPi / 180.0;  // radians
constexpr double near_best = 0.98;                 // share of the best score: views as close to it show as much
constexpr std::size_t max_points = 20'000;         // for the count of hidden points

/// \return the share of the points that others hide from a camera in this direction, in [0, 1].
double hiddenShare(const Points& points, const BoundingBall& ball, const Eigen::Vector3d& direction) {
  constexpr double distance = 5.0;  // radii
  constexpr double margin = 0.05;   // radii; points on rough or slanted surfaces are not hidden by their neighbors
  const auto seen = Visibility::fromPoints(points, ball.center + distance * ball.radius * direction);
  return seen ? seen->hiddenShare(points, margin * ball.radius) : 1.0;
}

/// \return the direction and its images under up to three reflections in a row.
std::vector<Eigen::Vector3d> mirrorImages(const Eigen::Vector3d& direction,
                                          const std::vector<Eigen::Vector3d>& normals) {
  constexpr int num_reflections = 3;   // give all eight images in three perpendicular planes
  constexpr double same = 1.0 - 1e-6;  // cosine
  std::vector<Eigen::Vector3d> images{direction};
  std::size_t first = 0;
  for (int round = 0; round < num_reflections; ++round) {
    const std::size_t last = images.size();
    for (std::size_t i = first; i < last; ++i) {
      for (const Eigen::Vector3d& n : normals) {
        const Eigen::Vector3d image = images[i] - 2.0 * images[i].dot(n) * n;
        const bool known =
            std::any_of(images.begin(), images.end(), [&](const auto& d) { return d.dot(image) > same; });
        if (!known) images.push_back(image);
      }
    }
    first = last;
  }
  return images;
}

/// \return whether no direction has less than a fifth of the best score.
bool seenFromEverywhere(const std::vector<ViewPlane>& planes) {
  constexpr double least = 0.2;  // share of the best score; a mug has a plane across its axis with that
  const std::vector<RankedView> best = bestViews(planes);
  return !best.empty() && worstView(planes).score >= least * best[0].score;
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
  constexpr int num_planes_of_axis = 8;  // S varies about the axis by 1 - cos(pi / 16) = 2 %
  for (const SymmetryAxis& axis : axes) {
    const Eigen::Vector3d u = axis.direction.unitOrthogonal(), v = axis.direction.cross(u);
    for (int k = 0; k < num_planes_of_axis; ++k) {
      const double angle = kPi * k / num_planes_of_axis;
      planes_.push_back({std::cos(angle) * u + std::sin(angle) * v, 2.0 * axis.score / num_planes_of_axis});
    }
  }
  for (const LocalMaximum& maximum : maxima) {
    if (seenFromEverywhere(planes_)) break;
    const Eigen::Vector3d n = maximum.plane.normal();
    constexpr double across_cosine = 0.5;
    const bool near = std::any_of(planes_.begin(), planes_.end(), [&](const ViewPlane& plane) {
      return std::abs(plane.normal.dot(n)) > across_cosine;
    });
    if (!near) planes_.push_back({n, maximum.value});
  }
  std::stable_sort(planes_.begin(), planes_.end(), [](const auto& a, const auto& b) { return a.weight > b.weight; });
}

void ViewpointSelection::setInputCloud(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud) {
  points_ = cloud ? detail::selectPoints(*cloud, nullptr, max_points, 1).points : Points(3, 0);
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
  constexpr double across_cosine = 0.05;
  const auto second = std::find_if(planes_.begin(), planes_.end(), [&](const ViewPlane& plane) {
    return std::abs(plane.normal.dot(first)) < across_cosine;
  });
  Eigen::Vector3d best = first;
  const auto consider = [&](const Eigen::Vector3d& axis) {
    if (std::abs(axis.dot(up_)) > std::abs(best.dot(up_))) best = axis;
  };
  const Eigen::Vector3d in_plane = up_ - up_.dot(first) * first;
  if (second != planes_.end()) {
    const Eigen::Vector3d across = (second->normal - second->normal.dot(first) * first).normalized();
    consider(across);
    consider(first.cross(across));
  } else if (in_plane.norm() > across_cosine) {
    consider(in_plane.normalized());
  }
  constexpr double far = 0.8;  // cosine of 37 degrees: an axis farther from the given direction would tilt the object
  return std::abs(best.dot(up_)) < far ? up_ : Eigen::Vector3d(std::copysign(1.0, best.dot(up_)) * best);
}

Eigen::Affine3f ViewpointSelection::computePose(const Eigen::Vector3d& direction) const {
  detail::withBadArguments([&] {
    check(direction.allFinite() && direction.norm() > 0.0, "direction", direction.transpose(), "finite and not zero");
  });
  const Eigen::Vector3d forward = -direction.normalized();
  Eigen::Vector3d up = getUpAxis();
  constexpr double along_cosine = 0.98;  // of 11 degrees: cameras near the axis would spin
  if (std::abs(up.dot(forward)) > along_cosine) {
    // From above or below: the strongest plane stands upright in the picture.
    const Eigen::Vector3d across = planes_.empty() ? up.unitOrthogonal() : Eigen::Vector3d(planes_[0].normal);
    const Eigen::Vector3d along = forward.cross(across);
    constexpr double least_along = 0.1;  // sine of 6 degrees
    up = along.norm() > least_along ? along : up.unitOrthogonal();
  }
  const Eigen::Vector3d right = forward.cross(up).normalized();
  Eigen::Matrix3d axes;
  axes << right, forward.cross(right), forward;
  const double distance = ball_.radius / std::sin(0.5 * view_angle);
  Eigen::Affine3d pose = Eigen::Affine3d::Identity();
  pose.linear() = axes;
  pose.translation() = ball_.center - distance * forward;
  return pose.cast<float>();
}

RankedView ViewpointSelection::leastHidden(const std::vector<RankedView>& views) const {
  constexpr double above = -0.05;  // sine of the elevation: level views have rounding to either side
  const Eigen::Vector3d up = getUpAxis();
  std::vector<RankedView> from_above;
  for (const RankedView& view : views)
    if (view.direction.dot(up) > above) from_above.push_back(view);
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
      if (view.score >= near_best * remaining[0].score) equal.push_back(view);
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
