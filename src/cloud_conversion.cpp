#include "pcl_symmetry/impl/cloud_conversion.hpp"

#include <pcl/console/print.h>
#include <pcl/point_types.h>

#include <algorithm>

#include "core/base/check.h"
#include "core/geometry/answerable_points.h"
#include "core/geometry/point_samples.h"
#include "core/scan/single_view.h"

namespace pcl_symmetry::detail {

namespace {

/// pcl::BadArgumentException puts " : " before its text.
class PlainBadArgument : public pcl::BadArgumentException {
public:
  explicit PlainBadArgument(const std::string& message) : pcl::BadArgumentException(message), message_(message) {}
  const char* what() const noexcept override { return message_.c_str(); }

private:
  std::string message_;
};

}  // namespace

void throwBadArgument(const std::string& message) {
  throw PlainBadArgument(message);
}

void checkAtLeast(const char* field, std::int64_t value, std::int64_t least) {
  const std::string rule = ">= " + std::to_string(least);
  withBadArguments([&] { check(value >= least, field, value, rule.c_str()); });
}

std::string reasonForNoAnswer(const Points& points, const std::string& input, int min_points) {
  std::string reason = points.cols() == 0 ? "no finite point" : whyUnanswerable(points);
  if (reason.empty() && points.cols() < min_points)
    reason = std::to_string(points.cols()) + " points, must be at least " + std::to_string(min_points);
  return reason.empty() ? reason : input + ": " + reason;
}

void warnOfNoAnswer(const std::string& source, const std::string& reason) {
  PCL_WARN("[pcl_symmetry::%s] %s.\n", source.c_str(), reason.c_str());
}

std::vector<std::size_t> drawOneOfEachRun(std::size_t num_points, std::size_t max_points, std::uint64_t seed) {
  return oneOfEachRun(num_points, max_points, seed);
}

SeenSpace seenFrom(const Points& points, const Viewpoint& viewpoint, const Eigen::Vector3d& stored, bool is_default) {
  if (viewpoint.mode == Viewpoint::Mode::None) return {};
  if (viewpoint.mode == Viewpoint::Mode::Given) {
    std::optional<Visibility> seen = Visibility::fromPoints(points, viewpoint.position);
    if (!seen)
      throw std::invalid_argument("viewpoint: among the points, must see them within 75 degrees of one direction");
    return {std::move(*seen), ViewpointSource::Given};
  }
  if (!is_default)
    if (std::optional<Visibility> seen = spaceSeenFrom(points, stored))
      return {std::move(*seen), ViewpointSource::Stored};
  std::optional<InferredView> view = inferView(points, stored);
  if (!view) return {};
  return {std::move(view->seen), view->as_stored ? ViewpointSource::Stored : ViewpointSource::Inferred};
}

Eigen::Vector4d unitPlane(const Eigen::Vector4d& coefficients) {
  const double length = coefficients.head<3>().norm();
  if (!(length > 0.0) || !coefficients.allFinite())
    throwBadArgument("ground: must be four finite numbers A,B,C,D, not all of A, B, C zero");
  return coefficients / length;
}

SeenSpace standingOn(const SeenSpace& seen, const Eigen::Vector4d& ground, const Points& points, double tolerance) {
  if (!seen.visibility()) return seen;
  const double sign = ground.dot(seen.visibility()->viewpoint().homogeneous()) < 0.0 ? -1.0 : 1.0;
  const double diagonal = (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).cast<double>().norm();
  return seen.withSupport(sign * ground, tolerance * diagonal);
}

}  // namespace pcl_symmetry::detail

namespace pcl_symmetry {

namespace {

SeenSpace spaceOfScene(const pcl::PointCloud<pcl::PointXYZ>& scene, const Viewpoint& viewpoint,
                       std::size_t max_pixels) {
  const bool asks_data = viewpoint.mode == Viewpoint::Mode::Auto;
  if (asks_data && scene.isOrganized() && scene.width > 1)
    if (auto seen = detail::seenByOrganizedCloud(scene)) return {std::move(*seen), ViewpointSource::Rays};
  const Points points = detail::selectPoints(scene, nullptr, scene.size(), 0).points;
  if (points.cols() == 0) return {};
  if (!asks_data) {
    auto seen = Visibility::ofScene(points, viewpoint.position, max_pixels);
    if (!seen) throw std::invalid_argument("viewpoint: at all points of the scene, must see one");
    return {std::move(*seen), ViewpointSource::Given};
  }
  // A default origin in the middle of a whole object would be seen once all around.
  const Eigen::Vector3d stored = scene.sensor_origin_.head<3>().cast<double>();
  if (auto seen = sceneSeenFrom(points, stored, max_pixels))
    if (!detail::hasDefaultSensor(scene) || seen->numPictures() == 1)
      return {std::move(*seen), ViewpointSource::Stored};
  const std::optional<InferredView> view = inferView(points, stored);
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

}  // namespace pcl_symmetry
