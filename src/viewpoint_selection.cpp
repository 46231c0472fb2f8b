#include "pcl_symmetry/viewpoint_selection.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/lists.h"
#include "pcl_symmetry/core/visibility.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"

namespace pcl_symmetry {

namespace {

struct ViewRules {
  double view_angle = 25.0 * kDegree;  // angle of view of the camera, radians
  double near_best = 0.98;             // share of the best score, for views that show as much
  // Distance of the camera for hidden points, radii: from farther away, the same points are hidden.
  double camera_distance = 5.0;
  double hidden_margin = 0.05;  // depth behind others at which a point is hidden, radii
  double perpendicular = 0.05;  // greatest cosine between two perpendicular planes, which were found with errors
  double near_up = 0.8;         // least cosine of an axis to the given direction: others would tilt the object
  double from_above = 0.98;     // cosine between the direction of a view and up, from which on it is a view from above
  double level = -0.05;         // sine of the elevation of the lowest view from above
};
constexpr ViewRules kView;

/// \return the share of the points that others hide from a camera in this direction, in [0, 1].
double hiddenShare(const Points& points, const BoundingBall& ball, const Eigen::Vector3d& direction) {
  const auto seen = Visibility::fromPoints(points, ball.center + kView.camera_distance * ball.radius * direction);
  return seen ? seen->hiddenShare(points, kView.hidden_margin * ball.radius) : 1.0;
}

/// \return the direction and its images under up to three reflections in a row: with three perpendicular
/// planes, all eight.
std::vector<Eigen::Vector3d> mirrorImages(const Eigen::Vector3d& direction,
                                          const std::vector<Eigen::Vector3d>& normals) {
  std::vector<Eigen::Vector3d> images{direction};
  std::size_t first = 0;
  for (int round = 0; round < 3; ++round) {
    const std::size_t last = images.size();
    for (std::size_t i = first; i < last; ++i) {
      for (const Eigen::Vector3d& n : normals) {
        const Eigen::Vector3d image = images[i] - 2.0 * images[i].dot(n) * n;
        const bool known =
            std::any_of(images.begin(), images.end(), [&](const auto& d) { return d.dot(image) > 1.0 - 1e-6; });
        if (!known) images.push_back(image);
      }
    }
    first = last;
  }
  return images;
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
  std::vector<ViewPlane> lines, across;
  for (const SymmetryAxis& axis : axes) lines.push_back({axis.direction, axis.score});
  for (const LocalMaximum& maximum : maxima) across.push_back({maximum.plane.normal(), maximum.value});
  planes_ = viewPlanes(std::move(planes_), lines, across);
}

void ViewpointSelection::setInputCloud(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud) {
  points_ = cloud ? detail::selectPoints(*cloud, nullptr, 20'000, 1).points : Points(3, 0);
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
  const auto second = std::find_if(planes_.begin(), planes_.end(), [&](const ViewPlane& plane) {
    return std::abs(plane.normal.dot(first)) < kView.perpendicular;
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
  } else if (in_plane.norm() > kView.perpendicular) {
    consider(in_plane.normalized());
  }
  return std::abs(best.dot(up_)) < kView.near_up ? up_ : Eigen::Vector3d(std::copysign(1.0, best.dot(up_)) * best);
}

Eigen::Affine3f ViewpointSelection::computePose(const Eigen::Vector3d& direction) const {
  detail::withBadArguments([&] {
    check(direction.allFinite() && direction.norm() > 0.0, "direction", direction.transpose(), "finite and not zero");
  });
  const Eigen::Vector3d forward = -direction.normalized();
  Eigen::Vector3d up = getUpAxis();
  if (std::abs(up.dot(forward)) > kView.from_above) {
    // From above or below: the strongest plane stands upright in the image.
    const Eigen::Vector3d across = planes_.empty() ? up.unitOrthogonal() : Eigen::Vector3d(planes_[0].normal);
    const Eigen::Vector3d along = forward.cross(across);
    up = along.norm() > 0.1 ? along : up.unitOrthogonal();
  }
  const Eigen::Vector3d right = forward.cross(up).normalized();
  Eigen::Matrix3d axes;
  axes << right, forward.cross(right), forward;
  const double distance = ball_.radius / std::sin(0.5 * kView.view_angle);
  Eigen::Affine3d pose = Eigen::Affine3d::Identity();
  pose.linear() = axes;
  pose.translation() = ball_.center - distance * forward;
  return pose.cast<float>();
}

RankedView ViewpointSelection::leastHidden(const std::vector<RankedView>& views) const {
  const Eigen::Vector3d up = getUpAxis();
  std::vector<RankedView> from_above;
  for (const RankedView& view : views)
    if (view.direction.dot(up) > kView.level) from_above.push_back(view);
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
  const Eigen::Vector3d up = getUpAxis();
  // Each with its opposite of equal score, one of which is from below.
  std::vector<RankedView> remaining = bestViews(planes_);
  eraseIf(remaining, [&](const RankedView& view) { return view.direction.dot(up) <= kView.level; });
  if (remaining.empty()) {
    const Eigen::Vector3d side = up.unitOrthogonal();
    remaining.push_back({(up + 2.0 * side + side.cross(up)).normalized(), 0.0});
  }
  std::vector<SelectedView> views;
  // A view that hides less may be preferred to one of a greater score: continue until no other view can be among the
  // best.
  const auto goes_on = [&] {
    return !remaining.empty() && std::count_if(views.begin(), views.end(), [&](const SelectedView& view) {
                                   return view.score >= remaining[0].score;
                                 }) < num_views;
  };
  while (goes_on()) {
    std::vector<RankedView> equal;
    for (const RankedView& view : remaining)
      if (view.score >= kView.near_best * remaining[0].score) equal.push_back(view);
    const RankedView view = leastHidden(equal);
    views.push_back({view, computePose(view.direction)});
    const std::vector<Eigen::Vector3d> shown = mirrorImages(view.direction, symmetries_);
    const auto taken = [&](const RankedView& other) {
      return other.direction == view.direction || std::any_of(shown.begin(), shown.end(), [&](const auto& direction) {
               return direction.dot(other.direction) > std::cos(separation_);
             });
    };
    eraseIf(remaining, taken);
  }
  sortDescending(views, &SelectedView::score);
  if (views.size() > static_cast<std::size_t>(num_views)) views.resize(num_views);
  return views;
}

}  // namespace pcl_symmetry
