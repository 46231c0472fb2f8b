#include "core/matching/signature_axes.h"

#include "core/base/check.h"

namespace pcl_symmetry {

namespace {

// Share of the greatest root mean square, the least that a shape is stretched by. chosen: half stretches the noise of
// flat shapes twice as far, twice leaves thin shapes flat.
constexpr float kFlattest = 0.05f;

}  // namespace

Points inRadii(const PointsRef& points) {
  if (points.cols() == 0) throw std::invalid_argument("points: 0 given, must be >= 1");
  if (!points.allFinite()) throw std::invalid_argument("points: a coordinate is not finite");
  const BoundingBall ball = boundingBall(points);
  check(ball.radius > 0.0, "radius of the points", ball.radius, "> 0");
  return normalizePoints(points, ball.center, ball.radius);
}

Points aboutMiddle(const Points& points, const Eigen::Matrix3d& axes) {
  Points turned = axes.transpose().cast<float>() * points;
  const Eigen::Vector3f mean = turned.rowwise().mean();
  const Eigen::Vector3f middle = 0.5f * (turned.rowwise().minCoeff() + turned.rowwise().maxCoeff());
  turned.colwise() -= 0.5f * (mean + middle);
  return turned;
}

Points stretched(const Points& points) {
  const Eigen::Vector3f spread = points.rowwise().norm();
  return spread.cwiseMax(kFlattest * spread.maxCoeff()).cwiseInverse().asDiagonal() * points;
}

}  // namespace pcl_symmetry
