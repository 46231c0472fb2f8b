#include "pcl_symmetry/impl/cloud_conversion.hpp"

#include <pcl/common/projection_matrix.h>
#include <pcl/console/print.h>
#include <pcl/point_types.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/geometry/answerable_points.h"
#include "core/geometry/point_samples.h"
#include "core/scan/depth_filter.h"
#include "core/scan/sensor_noise.h"
#include "core/scan/single_view.h"
#include "core/scan/viewpoint_inference.h"

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

namespace {

constexpr double largest_error = 0.7;  // pixels, root mean square; more are rows and columns that are no picture
constexpr double largest_skew =
    0.05;  // share of the focal length, also between the two: cameras that fit a flat cloud have no square pixels
constexpr std::size_t fewest_points = 50;    // fewer leave the 11 parameters of a projection to noise
constexpr std::size_t most_points = 20'000;  // that the 11 parameters gain from
constexpr double small_hole = 0.01;  // share of the picture; smaller ones are missing measurements, not background

/// Fills the pixels without a point: large regions and regions at the border are background, small regions are missing
/// measurements.
void fillEmptyPixels(int width, int height, std::vector<float>& depths) {
  const std::size_t size = depths.size();
  std::vector<char> visited(size, 0);
  std::vector<std::size_t> region;
  for (std::size_t start = 0; start < size; ++start) {
    if (visited[start] || !std::isnan(depths[start])) continue;
    region.assign(1, start);
    visited[start] = 1;
    bool at_border = false;
    for (std::size_t next = 0; next < region.size(); ++next) {
      const std::size_t at = region[next];
      const int u = static_cast<int>(at % width), v = static_cast<int>(at / width);
      at_border |= u == 0 || v == 0 || u + 1 == width || v + 1 == height;
      const auto visit = [&](bool inside, std::size_t to) {
        if (!inside || visited[to] || !std::isnan(depths[to])) return;
        visited[to] = 1;
        region.push_back(to);
      };
      visit(u > 0, at - 1);
      visit(u + 1 < width, at + 1);
      visit(v > 0, at - width);
      visit(v + 1 < height, at + width);
    }
    const bool background = at_border || static_cast<double>(region.size()) > small_hole * static_cast<double>(size);
    for (const std::size_t at : region) depths[at] = background ? Visibility::kBackground : Visibility::kNoRay;
  }
}

}  // namespace

SeenSpace seenFrom(const Points& points, const Viewpoint& viewpoint, const StoredPose& stored) {
  if (viewpoint.mode == Viewpoint::Mode::None) return {};
  if (viewpoint.mode == Viewpoint::Mode::Given) {
    std::optional<Visibility> seen = Visibility::fromPoints(points, viewpoint.position);
    if (!seen)
      throw std::invalid_argument("viewpoint: among the points, must see them within 75 degrees of one direction");
    return {std::move(*seen), ViewpointSource::Given};
  }
  if (!stored.is_default)
    if (std::optional<Visibility> seen = spaceSeenFrom(points, stored.origin))
      return {std::move(*seen), ViewpointSource::Stored};
  std::optional<InferredView> view = inferView(points, stored.origin);
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

pcl::PointCloud<pcl::PointXYZ>::Ptr cloudOf(const ScannerOutput& scanned) {
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>(scanned.width, scanned.height);
  for (std::size_t i = 0; i < cloud->size(); ++i)
    (*cloud)[i].getVector3fMap() = scanned.pixels.col(static_cast<Eigen::Index>(i));
  return cloud;
}

std::optional<Visibility> seenByOrganizedCloud(const Points& pixels, int width, int height) {
  pcl::Indices finite;
  for (Eigen::Index i = 0; i < pixels.cols(); ++i)
    if (pixels.col(i).allFinite()) finite.push_back(static_cast<pcl::index_t>(i));
  if (finite.size() < fewest_points) return std::nullopt;
  const std::size_t stride = 1 + finite.size() / most_points;
  pcl::Indices used;
  for (std::size_t i = 0; i < finite.size(); i += stride) used.push_back(finite[i]);
  Points points(3, static_cast<Eigen::Index>(used.size()));
  for (std::size_t i = 0; i < used.size(); ++i) points.col(i) = pixels.col(used[i]);
  const BoundingBall ball = boundingBall(points);
  if (!(ball.radius > 0.0)) return std::nullopt;

  // The estimate depends on the units: it is made from coordinates near 1.
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>(width, height);
  const Points normalized = normalizePoints(points, ball.center, ball.radius);
  for (std::size_t i = 0; i < used.size(); ++i) (*cloud)[used[i]].getVector3fMap() = normalized.col(i);
  Eigen::Matrix<float, 3, 4, Eigen::RowMajor> estimate;
  // The residual that it returns may be slightly negative. The error in pixels decides, below.
  pcl::estimateProjectionMatrix<pcl::PointXYZ>(cloud, estimate, used);
  if (!estimate.allFinite()) return std::nullopt;
  Visibility::Projection projection = estimate.cast<double>();
  const double length = projection.block<1, 3>(2, 0).norm();
  if (!(length > 0.0)) return std::nullopt;
  const Eigen::Vector4d first = normalized.col(0).cast<double>().homogeneous();
  projection *= (projection.row(2).dot(first) < 0.0 ? -1.0 : 1.0) / length;

  double sq_error = 0.0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const Eigen::Vector3d image = projection * Eigen::Vector4d(normalized.col(i).cast<double>().homogeneous());
    if (!(image.z() > 0.0)) return std::nullopt;
    const Eigen::Vector2d pixel(used[i] % width, used[i] / width);
    sq_error += (image.head<2>() / image.z() - pixel).squaredNorm();
  }
  if (!(sq_error <= largest_error * largest_error * static_cast<double>(used.size()))) return std::nullopt;
  // A flat cloud fits cameras that do not exist. The pixels of real ones are square.
  const Eigen::Vector3d across = projection.block<1, 3>(0, 0), down = projection.block<1, 3>(1, 0),
                        forward = projection.block<1, 3>(2, 0);
  const Eigen::Vector3d x = across - across.dot(forward) * forward, y = down - down.dot(forward) * forward;
  const double focal = std::max(x.norm(), y.norm());
  if (!(std::abs(x.norm() - y.norm()) <= largest_skew * focal && std::abs(x.dot(y)) <= largest_skew * focal * focal))
    return std::nullopt;

  // Back to the input frame; depths are in its units.
  projection.col(3) = projection.col(3) * ball.radius - projection.leftCols<3>() * ball.center;
  std::vector<float> depths(pixels.cols(), std::numeric_limits<float>::quiet_NaN());
  for (const pcl::index_t i : finite)
    depths[i] = static_cast<float>(projection.row(2).dot(Eigen::Vector4d(pixels.col(i).cast<double>().homogeneous())));
  const DepthImage image{width, height, depths, 1.0 / focal};
  fillEmptyPixels(width, height, depths);
  return Visibility(projection, width, height, std::move(depths)).withDepthErrors(sensorError(image));
}

}  // namespace pcl_symmetry::detail

namespace pcl_symmetry {

namespace {

Points finiteOf(const Points& pixels) {
  Points points(3, pixels.cols());
  Eigen::Index size = 0;
  for (Eigen::Index i = 0; i < pixels.cols(); ++i)
    if (pixels.col(i).allFinite()) points.col(size++) = pixels.col(i);
  points.conservativeResize(3, size);
  return points;
}

SeenSpace spaceOfScene(const detail::ScannerOutput& scene, const Viewpoint& viewpoint, std::size_t max_pixels) {
  const bool asks_data = viewpoint.mode == Viewpoint::Mode::Auto;
  if (asks_data && scene.height > 1 && scene.width > 1)
    if (auto seen = detail::seenByOrganizedCloud(scene.pixels, scene.width, scene.height))
      return {std::move(*seen), ViewpointSource::Rays};
  const Points points = finiteOf(scene.pixels);
  if (points.cols() == 0) return {};
  if (!asks_data) {
    auto seen = Visibility::ofScene(points, viewpoint.position, max_pixels);
    if (!seen) throw std::invalid_argument("viewpoint: at all points of the scene, must see one");
    return {std::move(*seen), ViewpointSource::Given};
  }
  // A default origin in the middle of a whole object would be seen once all around.
  if (auto seen = sceneSeenFrom(points, scene.stored.origin, max_pixels))
    if (!scene.stored.is_default || seen->numPictures() == 1) return {std::move(*seen), ViewpointSource::Stored};
  const std::optional<InferredView> view = inferView(points, scene.stored.origin);
  if (!view) return {};
  return {*Visibility::ofScene(points, view->position, max_pixels), ViewpointSource::Inferred};
}

}  // namespace

SeenSpace::SeenSpace(const detail::ScannerOutput& scene, const Viewpoint& viewpoint, std::size_t max_pixels) {
  if (viewpoint.mode == Viewpoint::Mode::None) return;
  *this = detail::withBadArguments([&] { return spaceOfScene(scene, viewpoint, max_pixels); });
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
