#include <stdexcept>
#include <utility>

#include "core/base/check.h"
#include "core/geometry/cloud_extent.h"
#include "core/geometry/point_samples.h"
#include "core/scan/range_image.h"
#include "core/scan/viewpoint_inference.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"

namespace pcl_symmetry {

namespace {

void checkViewpoint(const Eigen::Vector3d& position) {
  check(position.allFinite(), "viewpoint", position.transpose(), "finite");
}

SeenSpace spaceOfScene(const pcl::PointCloud<pcl::PointXYZ>& scene, const Viewpoint& viewpoint,
                       std::size_t max_pixels) {
  const bool asks_data = viewpoint.mode == Viewpoint::Mode::Auto;
  if (asks_data && scene.isOrganized() && scene.width > 1)
    if (auto seen = detail::seenByOrganizedCloud(scene)) return {std::move(*seen), ViewpointSource::Rays};
  if (!asks_data) checkViewpoint(viewpoint.position);
  const Points points = detail::selectPoints(scene, nullptr, scene.size(), 0).points;
  if (points.cols() == 0) return {};
  if (!asks_data) {
    auto seen = Visibility::ofScene(points, viewpoint.position, max_pixels);
    if (!seen) throw std::invalid_argument("viewpoint: at all points of the scene, must see one");
    return {std::move(*seen), ViewpointSource::Given};
  }
  // A default origin in the middle of a whole object would look like a viewpoint that sees it once, all around.
  const Eigen::Vector3d stored = scene.sensor_origin_.head<3>().cast<double>();
  if (auto seen = sceneSeenFrom(points, stored, max_pixels))
    if (!detail::hasDefaultSensor(scene) || seen->numPictures() == 1)
      return {std::move(*seen), ViewpointSource::Stored};
  const std::optional<InferredView> view = inferView(withoutStrayPoints(points), stored);
  if (!view) return {};
  return {*Visibility::ofScene(points, view->position, max_pixels), ViewpointSource::Inferred};
}

}  // namespace

SeenSpace SeenSpace::ofScene(const pcl::PointCloud<pcl::PointXYZ>& scene, const Viewpoint& viewpoint,
                             std::size_t max_pixels) {
  if (viewpoint.mode == Viewpoint::Mode::None) return {};
  return detail::withBadArguments([&] { return spaceOfScene(scene, viewpoint, max_pixels); });
}

SeenSpace SeenSpace::together(const std::vector<SeenSpace>& spaces) {
  std::vector<Visibility> views;
  SeenSpace all;
  for (const SeenSpace& space : spaces) {
    if (!space.visibility_) continue;
    if (views.empty()) all.source_ = space.source_;
    all.asks_for_support_ = all.asks_for_support_ && space.asks_for_support_;
    views.push_back(*space.visibility_);
  }
  if (!views.empty()) all.visibility_ = Visibility::together(views);
  return all;
}

SeenSpace SeenSpace::withSupport(const Eigen::Vector4d& support, double margin) const {
  SeenSpace result = withoutSupport();
  if (visibility_) result.visibility_ = visibility_->withSupport(support, margin);
  return result;
}

SeenSpace SeenSpace::withoutSupport() const {
  SeenSpace result = *this;
  result.asks_for_support_ = false;
  return result;
}

namespace detail {

const Viewpoint& checkedViewpoint(const Viewpoint& viewpoint) {
  if (viewpoint.mode == Viewpoint::Mode::Given) withBadArguments([&] { checkViewpoint(viewpoint.position); });
  return viewpoint;
}

SeenSpace seenFrom(const Points& all, const Viewpoint& viewpoint, const Eigen::Vector3d& stored, bool is_default) {
  if (viewpoint.mode == Viewpoint::Mode::None) return {};
  const Points points = withoutStrayPoints(all);
  if (viewpoint.mode == Viewpoint::Mode::Given) {
    checkViewpoint(viewpoint.position);
    std::optional<Visibility> seen = Visibility::fromPoints(points, viewpoint.position);
    if (!seen)
      throw std::invalid_argument("viewpoint: among the points, must see them within 75 degrees of one direction");
    return {std::move(*seen), ViewpointSource::Given};
  }
  std::optional<InferredView> view = inferView(points, stored, is_default);
  if (!view) return {};
  return {std::move(view->seen), view->as_stored ? ViewpointSource::Stored : ViewpointSource::Inferred};
}

SeenSpace standingOn(const SeenSpace& seen, const Eigen::Vector4d& ground, const Points& points, double tolerance) {
  if (!seen.visibility()) return seen;
  const double sign = ground.dot(seen.visibility()->viewpoint().homogeneous()) < 0.0 ? -1.0 : 1.0;
  return seen.withSupport(sign * ground, tolerance * boxDiagonal(points));
}

}  // namespace detail

}  // namespace pcl_symmetry
