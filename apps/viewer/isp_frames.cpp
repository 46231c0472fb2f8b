#include "viewer/isp_frames.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/constants.h"
#include "core/geometry/surface_normals.h"
#include "pcl_symmetry/core/iterative_symmetric_points.h"

namespace pcl_symmetry::apps {

namespace {

// Where the shown refinement starts, radians and radii from the plane.
constexpr double kTurn = 12.0 * kPi / 180.0, kShift = 0.05;
// Width of the weights and the step that ends the refinement, radii.
constexpr double kSigma = 0.12, kResting = 1e-3;
constexpr int kMaxFrames = 20, kNumSamples = 5'000, kNumShown = 120;

IspFrame frameOf(const Points& points, const std::vector<int>& samples, const ReflectionPlane& plane,
                 const IspStep& step) {
  IspFrame frame;
  frame.plane = plane;
  frame.residual = step.residual;
  const std::size_t stride = std::max<std::size_t>(1, samples.size() / kNumShown);
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < samples.size(); i += stride)
    if (step.closest[i] >= 0 && step.sq_distances[i] < kSigma * kSigma) shown.push_back(i);
  for (Points* const set : {&frame.samples, &frame.reflections, &frame.closest}) set->resize(3, shown.size());
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const Eigen::Vector3f x = points.col(samples[shown[k]]);
    frame.samples.col(k) = x;
    frame.reflections.col(k) = plane.reflect(x.cast<double>()).cast<float>();
    frame.closest.col(k) = points.col(step.closest[shown[k]]);
  }
  return frame;
}

}  // namespace

std::vector<IspFrame> ispFrames(const Points& points, const ReflectionPlane& plane) {
  const ClosestPointSearch::Ptr search = makeFlannSearch(points);
  const LocalGeometry geometry = localGeometry(points, *search, kNumSupportNeighbors, 0);
  const IspSurface surface{points, geometry.normals, *search};
  std::vector<int> samples;
  const Eigen::Index stride = std::max<Eigen::Index>(1, points.cols() / kNumSamples);
  for (Eigen::Index i = 0; i < points.cols(); i += stride) samples.push_back(static_cast<int>(i));

  const Eigen::Vector3d turned = Eigen::AngleAxisd(kTurn, plane.normal().unitOrthogonal()) * plane.normal();
  ReflectionPlane current(turned, plane.offset() + kShift);
  std::vector<IspFrame> frames;
  for (int i = 0; i < kMaxFrames; ++i) {
    const IspStep step = iterateSymmetricPoints(surface, samples, current, kSigma, IspUpdate::PointToPlane);
    frames.push_back(frameOf(points, samples, current, step));
    const double sign = step.plane.normal().dot(current.normal()) < 0.0 ? -1.0 : 1.0;
    const bool rests =
        step.plane.angleTo(current) < kResting && std::abs(sign * step.plane.offset() - current.offset()) < kResting;
    if (rests) break;
    current = step.plane;
  }
  return frames;
}

}  // namespace pcl_symmetry::apps
