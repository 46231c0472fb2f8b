#include "registration/prepared_cloud.h"

#include <stdexcept>

#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

namespace {

constexpr Eigen::Index kLeastPoints = 3;  // points that determine a rotation

BoundingBall ballOf(const std::string& name, const Points& points) {
  const BoundingBall ball = boundingBall(points);
  if (points.cols() < kLeastPoints || !(ball.radius > 0.0))
    throw std::invalid_argument(name + ": no extent, must have three different finite points");
  return ball;
}

}  // namespace

PreparedCloud::PreparedCloud(const std::string& name, const Points& points, const std::optional<Visibility>& seen,
                             const CloudRegistrationOptions& options)
    : points_(withoutStrayPoints(points)), seen_(seen), options_(options), ball_(ballOf(name, points_)) {}

const std::shared_ptr<const PosedSurface>& PreparedCloud::surfaceIn(double unit) const {
  if (surface_ && unit == unit_) return surface_;
  const auto seen = seen_ ? std::optional(seen_->normalized(ball_.center, unit)) : std::nullopt;
  surface_ = std::make_shared<const PosedSurface>(normalizePoints(points_, ball_.center, unit), seen, options_.seed,
                                                  options_.num_threads);
  frame_.reset();
  unit_ = unit;
  return surface_;
}

std::shared_ptr<const PosedSurface> PreparedCloud::surface(double unit) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return surfaceIn(unit);
}

std::shared_ptr<const SymmetryFrame> PreparedCloud::frame(double unit) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const PosedSurface& surface = *surfaceIn(unit);
  if (frame_) return frame_;
  FrameOptions options = options_.frame;
  options.probabilities = options.refined = false;
  options.num_threads = options_.num_threads;
  options.seed = options_.seed;
  options.rotations = false;
  const Visibility* seen = surface.seen ? &*surface.seen : nullptr;
  return frame_ = std::make_shared<const SymmetryFrame>(symmetryFrame(surface.points, options, seen));
}

}  // namespace pcl_symmetry
