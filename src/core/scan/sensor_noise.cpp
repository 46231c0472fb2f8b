#include "core/scan/sensor_noise.h"

#include <cmath>

#include "core/scan/depth_filter.h"

namespace pcl_symmetry {

namespace {

// Standard deviation of the errors in squares of 11 x 11 pixels, per standard deviation of what differs between
// neighbors. measured: 2.2 (1.9 to 2.4) on eight frames of a Kinect.
constexpr double kSharedWithNeighbors = 2.2;
// derived: 97 % of a normal distribution lie within 2.17 standard deviations; the difference of two errors has the root
// of 2 times that of one.
const double kResolvedDeviations = 2.17 * std::sqrt(2.0);

}  // namespace

double sensorError(const DepthImage& image) {
  return kSharedWithNeighbors * inverseDepthError(image);
}

double resolvedTolerance(const PointsRef& points, const Visibility& seen) {
  const Eigen::Vector3d middle = points.cast<double>().rowwise().mean();
  return kResolvedDeviations * seen.depthError(middle);
}

}  // namespace pcl_symmetry
