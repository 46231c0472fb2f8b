#include "core/scan/sensor_noise.h"

#include <algorithm>
#include <cmath>

#include "core/scan/depth_filter.h"
#include "core/scan/scan_rules.h"

namespace pcl_symmetry {

namespace {

// 97 % of a normal distribution lie within 2.17 standard deviations; the difference of two errors has the root
// of 2 times that of one.
const double kResolvedDeviations = 2.17 * std::sqrt(2.0);

}  // namespace

double sensorError(const DepthImage& image) {
  const double error = inverseDepthError(image);
  return error > 0.0 ? std::min(kScan.most_shared * error, inverseDepthError(image, kScan.window)) : 0.0;
}

double resolvedTolerance(const PointsRef& points, const Visibility& seen) {
  const Eigen::Vector3d middle = points.cast<double>().rowwise().mean();
  return kResolvedDeviations * seen.depthError(middle);
}

}  // namespace pcl_symmetry
