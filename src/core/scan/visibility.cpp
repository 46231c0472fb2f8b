#include "pcl_symmetry/core/visibility.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/geometry/directions.h"
#include "core/scan/range_image.h"

namespace pcl_symmetry {

namespace {

/// Maps points of the input frame to the frame of a camera.
Visibility::Projection cameraAt(const Eigen::Vector3d& viewpoint, const Eigen::Matrix3d& R_camera_input) {
  Visibility::Projection projection;
  projection.leftCols<3>() = R_camera_input;
  projection.col(3) = -R_camera_input * viewpoint;
  return projection;
}

/// Rays from a viewpoint to points.
struct Rays {
  Eigen::Index count = 0;  ///< number of rays; points at the viewpoint have none
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
};

Rays raysTo(const PointsRef& points, const Eigen::Vector3d& viewpoint) {
  Rays rays;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d ray = points.col(i).cast<double>() - viewpoint;
    if (!(ray.norm() > 0.0)) continue;
    rays.mean += ray.normalized();
    ++rays.count;
  }
  if (rays.count > 0) rays.mean /= static_cast<double>(rays.count);
  return rays;
}

/// The six directions of a cube, as rotations of a camera that looks in the first one.
std::vector<Eigen::Matrix3d> cubeFaces() {
  std::vector<Eigen::Matrix3d> faces;
  for (int quarter = 0; quarter < 4; ++quarter)
    faces.push_back(Eigen::AngleAxisd(0.5 * kPi * quarter, Eigen::Vector3d::UnitY()).toRotationMatrix());
  for (const double side : {-1.0, 1.0})
    faces.push_back(Eigen::AngleAxisd(0.5 * kPi * side, Eigen::Vector3d::UnitX()).toRotationMatrix());
  return faces;
}

/// The view of points from a camera; nothing if it sees no point, or fewer than required.
std::optional<Visibility> viewFrom(const PointsRef& points, const Eigen::Vector3d& viewpoint,
                                   const Eigen::Matrix3d& R_camera_input, FieldOfView field, std::size_t max_pixels,
                                   Eigen::Index min_seen) {
  const SeenPositions seen = positionsSeen(points, viewpoint, R_camera_input, field);
  if (seen.positions.empty() || static_cast<Eigen::Index>(seen.positions.size()) < min_seen) return std::nullopt;
  RangeImage image = sceneRangeImage(seen, max_pixels);
  return Visibility(image.grid.toPixels() * cameraAt(viewpoint, R_camera_input), image.grid.width, image.grid.height,
                    std::move(image.depths), Visibility::kNoRay);
}

}  // namespace

Visibility::Visibility(const Projection& projection, int width, int height, std::vector<float> depths, float outside) {
  if (width < 1 || height < 1 || depths.size() != static_cast<std::size_t>(width) * height)
    throw std::invalid_argument("depths: size " + std::to_string(depths.size()) + ", must be width * height > 0");
  auto shared_depths = std::make_shared<const std::vector<float>>(std::move(depths));
  depth_views_.push_back({projection, width, height, std::move(shared_depths), outside, 1.0, 0.0, false, {}});
}

std::optional<Visibility> Visibility::fromPoints(const PointsRef& points, const Eigen::Vector3d& viewpoint) {
  if (points.cols() == 0) return std::nullopt;
  const Eigen::Vector3d forward = (boundingBall(points).center - viewpoint).normalized();
  if (!forward.allFinite() || forward.norm() < 0.5) return std::nullopt;
  const Eigen::Matrix3d R_camera_input = viewingFrame(forward);
  const SeenPositions seen = positionsSeen(points, viewpoint, R_camera_input, FieldOfView::Cone);
  if (static_cast<Eigen::Index>(seen.positions.size()) < points.cols()) return std::nullopt;
  RangeImage image = rangeImage(seen, kMaxPixels);
  // Rays beside the object met no surface: their space is free, as far as the image reaches.
  Visibility visibility(image.grid.toPixels() * cameraAt(viewpoint, R_camera_input), image.grid.width,
                        image.grid.height, std::move(image.depths), kBackground);
  visibility.depth_views_.front().is_of_points = true;
  const Eigen::Matrix3d to_positions = image.grid.toPixels().inverse();
  for (const FrameSide& side : frameSides(seen.positions))
    visibility.depth_views_.front().sides.emplace_back(to_positions.transpose() *
                                                       Eigen::Vector3d(side.normal.x(), side.normal.y(), -side.offset));
  return visibility;
}

std::optional<Visibility> Visibility::ofScene(const PointsRef& points, const Eigen::Vector3d& viewpoint,
                                              std::size_t max_pixels) {
  check(max_pixels >= std::size_t{16}, "max_pixels", max_pixels, ">= 16");
  const Rays rays = raysTo(points, viewpoint);
  if (rays.count == 0) return std::nullopt;
  const Eigen::Vector3d forward =
      rays.mean.norm() > 1e-6 ? Eigen::Vector3d(rays.mean.normalized()) : Eigen::Vector3d::UnitX();
  const Eigen::Matrix3d ahead = viewingFrame(forward);
  std::vector<Visibility> views;
  if (auto one = viewFrom(points, viewpoint, ahead, FieldOfView::Cone, max_pixels, rays.count)) {
    views.push_back(std::move(*one));
  } else {
    for (const Eigen::Matrix3d& rotation : cubeFaces())
      if (auto face = viewFrom(points, viewpoint, rotation * ahead, FieldOfView::CubeFace, max_pixels, 1))
        views.push_back(std::move(*face));
  }
  Visibility all = together(views);
  for (DepthView& view : all.depth_views_) view.is_of_points = true;
  return all;
}

Visibility Visibility::together(const std::vector<Visibility>& views) {
  if (views.empty()) throw std::invalid_argument("number of views = 0, must be >= 1");
  Visibility all;
  for (const Visibility& view : views)
    all.depth_views_.insert(all.depth_views_.end(), view.depth_views_.begin(), view.depth_views_.end());
  for (const Visibility& view : views)
    all.supports_.insert(all.supports_.end(), view.supports_.begin(), view.supports_.end());
  return all;
}

Visibility Visibility::withSupport(const Eigen::Vector4d& support, double margin) const {
  Visibility result = *this;
  result.supports_.push_back(support);
  result.supports_.back()[3] += margin;
  return result;
}

Visibility Visibility::withDepthErrors(double inverse_depth_error) const {
  Visibility result = *this;
  for (DepthView& view : result.depth_views_) view.inverse_depth_error = inverse_depth_error / view.unit;
  return result;
}

double Visibility::depthError(const Eigen::Vector3d& x) const {
  // Because d(1 / z) = dz / z^2.
  const DepthView& view = depth_views_.front();
  const double depth = view.projection.row(2).dot(x.homogeneous());
  return view.inverse_depth_error * view.unit * depth * depth;
}

double Visibility::resolvedTolerance(const PointsRef& points) const {
  // 97 % of a normal distribution lie within 2.17 standard deviations; the difference of two errors has sqrt(2) times
  // the standard deviation of one.
  const double deviations = 2.17 * std::sqrt(2.0);
  const Eigen::Vector3d middle = points.cast<double>().rowwise().mean();
  return deviations * depthError(middle);
}

double Visibility::DepthView::depthBehind(const Eigen::Vector3d& image) const {
  if (!(image.z() > 0.0)) return std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& side : sides)
    if (side.dot(image) > 0.0) return std::numeric_limits<double>::infinity();
  const double u = image.x() / image.z() + 0.5, v = image.y() / image.z() + 0.5;
  const bool inside = u >= 0.0 && v >= 0.0 && u < width && v < height;
  return image.z() - static_cast<double>(inside ? depth(static_cast<int>(u), static_cast<int>(v)) : outside);
}

double Visibility::depthBehind(const Eigen::Vector3d& x) const {
  double behind = std::numeric_limits<double>::infinity();
  for (const DepthView& view : depth_views_)
    behind = std::min(behind, view.depthBehind(view.projection.leftCols<3>() * x + view.projection.col(3)));
  for (const Eigen::Vector4d& support : supports_) {
    const double height = support.head<3>().dot(x) + support[3];
    if (height < 0.0) behind = std::min(behind, height);
  }
  return behind;
}

bool Visibility::isInPicture(const Eigen::Vector3d& x) const {
  return std::any_of(depth_views_.begin(), depth_views_.end(), [&](const DepthView& view) {
    const Eigen::Vector3d image = view.projection * x.homogeneous();
    const Eigen::Array2d pixel = image.head<2>().array() / image.z() + 0.5;
    const bool has_pixel = (pixel >= 0.0).all() && pixel.x() < view.width && pixel.y() < view.height;
    return image.z() > 0.0 && (has_pixel || view.is_of_points);
  });
}

std::vector<char> Visibility::areFree(const Eigen::Matrix3Xd& points) const {
  std::vector<char> is_free(points.cols(), 0);
  const auto addWhere = [&](const auto& isFree) {
    for (std::size_t i = 0; i < is_free.size(); ++i) is_free[i] |= isFree(static_cast<Eigen::Index>(i));
  };
  for (const DepthView& view : depth_views_)
    addWhere([&](Eigen::Index i) { return view.depthBehind(view.projection * points.col(i).homogeneous()) < 0.0; });
  for (const Eigen::Vector4d& support : supports_)
    addWhere([&](Eigen::Index i) { return support.head<3>().dot(points.col(i)) + support[3] < 0.0; });
  return is_free;
}

Eigen::Vector3d Visibility::viewpoint() const {
  const Projection& projection = depth_views_.front().projection;
  return -projection.leftCols<3>().inverse() * projection.col(3);
}

double Visibility::hiddenShare(const PointsRef& points, double margin) const {
  std::size_t num_hidden = 0;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    num_hidden += depthBehind(points.col(i).cast<double>()) > margin ? 1 : 0;
  return static_cast<double>(num_hidden) / static_cast<double>(points.cols());
}

Visibility Visibility::normalized(const Eigen::Vector3d& center, double scale) const {
  Visibility result = *this;
  for (DepthView& view : result.depth_views_) {
    const Projection& input = view.projection;
    view.projection.col(3) = ((input.leftCols<3>() * center + input.col(3)) / scale).eval();
    view.unit *= scale;
  }
  for (Eigen::Vector4d& support : result.supports_) support[3] = (support.head<3>().dot(center) + support[3]) / scale;
  return result;
}

}  // namespace pcl_symmetry
