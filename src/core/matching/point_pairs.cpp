#include "core/matching/point_pairs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/constants.h"
#include "core/base/simd.h"

namespace pcl_symmetry {

namespace {

// Added to divisors.
constexpr float kTiny = 1e-20f;

int angleStep(double cosine, int num_steps, double range) {
  const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
  return std::min(num_steps - 1, static_cast<int>(angle / range * num_steps));
}

/// Adds to each step how many of the limits its value has reached.
/// \param sign -1: reached from above.
PCL_SYMMETRY_MULTIVERSION void countLimits(const float* __restrict values, int size, const float* limits,
                                           int num_limits, float sign, int* __restrict steps) {
  for (int k = 0; k < num_limits; ++k) {
    const float limit = sign * limits[k];
    for (int j = 0; j < size; ++j) steps[j] += sign * values[j] >= limit ? 1 : 0;
  }
}

/// Where a step of the angle ends, as cosines.
template <int kSteps>
std::vector<float> cosineLimits(double range) {
  std::vector<float> limits;
  for (int k = 1; k < kSteps; ++k) limits.push_back(static_cast<float>(std::cos(range * k / kSteps)));
  return limits;
}

/// A surface in single precision, and one point of it with its frame, row by row.
struct RowInput {
  const float *x, *y, *z, *normal_x, *normal_y, *normal_z;
  int size;
  float point[3], frame[3][3];
};

/// Squared distances, cosines of the three angles, rotations.
struct RowOutput {
  float *sq_distance, *cosine, *other_cosine, *between_cosine;
  int* rotation;
};

PCL_SYMMETRY_MULTIVERSION void fillCosines(const RowInput& in, const RowOutput& out) {
  const float* __restrict x = in.x, * __restrict y = in.y, * __restrict z = in.z;
  const float* __restrict nx = in.normal_x, * __restrict ny = in.normal_y, * __restrict nz = in.normal_z;
  float* __restrict sq_distance = out.sq_distance, * __restrict cosine = out.cosine;
  float* __restrict other = out.other_cosine, * __restrict between = out.between_cosine;
  const float px = in.point[0], py = in.point[1], pz = in.point[2];
  const float ax = in.frame[0][0], ay = in.frame[0][1], az = in.frame[0][2];
  for (int j = 0; j < in.size; ++j) {
    const float dx = x[j] - px, dy = y[j] - py, dz = z[j] - pz;
    const float sq = dx * dx + dy * dy + dz * dz, inverse = 1.0f / std::sqrt(sq + kTiny);
    sq_distance[j] = sq;
    cosine[j] = (ax * dx + ay * dy + az * dz) * inverse;
    other[j] = std::abs(nx[j] * dx + ny[j] * dy + nz[j] * dz) * inverse;
    between[j] = std::abs(ax * nx[j] + ay * ny[j] + az * nz[j]);
  }
}

PCL_SYMMETRY_MULTIVERSION void fillRotations(const RowInput& in, const RowOutput& out) {
  const float* __restrict x = in.x, * __restrict y = in.y, * __restrict z = in.z;
  int* __restrict rotation = out.rotation;
  const float px = in.point[0], py = in.point[1], pz = in.point[2];
  const float bx = in.frame[1][0], by = in.frame[1][1], bz = in.frame[1][2];
  const float cx = in.frame[2][0], cy = in.frame[2][1], cz = in.frame[2][2];
  for (int j = 0; j < in.size; ++j) {
    const float dx = x[j] - px, dy = y[j] - py, dz = z[j] - pz;
    const float u = bx * dx + by * dy + bz * dz, v = cx * dx + cy * dy + cz * dz;
    const float au = std::abs(u), av = std::abs(v);
    const float low = au < av ? au : av, high = au < av ? av : au;
    const float t = low / (high + kTiny), s = t * t;
    // Abramowitz and Stegun 4.4.47, off by 1e-5, over 2 pi.
    float angle = t * (0.159133f + s * (-0.0525688f + s * (0.0286703f + s * (-0.0135493f + s * 0.00331601f))));
    angle = au < av ? 0.25f - angle : angle;
    angle = u < 0.0f ? 0.5f - angle : angle;
    angle = v < 0.0f ? 1.0f - angle : angle;
    rotation[j] = static_cast<int>(256.0f * angle) & 255;
  }
}

}  // namespace

Eigen::Matrix3d frameOf(const Eigen::Vector3d& normal) {
  Eigen::Matrix3d frame;
  frame.col(0) = normal;
  frame.col(1) = normal.unitOrthogonal();
  frame.col(2) = normal.cross(frame.col(1));
  return frame;
}

PointPair pairOf(const Eigen::Matrix3d& frame, const Eigen::Vector3d& first, const Eigen::Vector3d& second,
                 const Eigen::Vector3d& second_normal) {
  const Eigen::Vector3d line = second - first;
  const double distance = line.norm();
  const Eigen::Vector3d direction = frame.transpose() * line / distance;
  PointPair pair;
  pair.log_distance = std::log(distance) / kPairDistanceStep;
  pair.angle = std::acos(std::clamp(direction.x(), -1.0, 1.0)) / kPi * kPairAngles;
  pair.other_angle = angleStep(std::abs(second_normal.dot(line)) / distance, kPairOtherAngles, 0.5 * kPi);
  pair.between = angleStep(std::abs(second_normal.dot(frame.col(0))), kPairOtherAngles, 0.5 * kPi);
  const double rotation = std::atan2(direction.z(), direction.y()) / (2.0 * kPi);
  pair.rotation = static_cast<std::uint8_t>(static_cast<int>(std::floor((rotation + 1.0) * 256.0)) & 255);
  return pair;
}

PairedSurface::PairedSurface(const PointsRef& points, const PointsRef& normals, double radius)
    : first_step_(static_cast<int>(std::floor(std::log(0.1 * radius) / kPairDistanceStep))) {
  const Eigen::Vector3f middle = points.rowwise().mean();
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3f x = (points.col(i) - middle) / static_cast<float>(radius);
    points_.x.push_back(x.x());
    points_.y.push_back(x.y());
    points_.z.push_back(x.z());
    normals_.x.push_back(normals(0, i));
    normals_.y.push_back(normals(1, i));
    normals_.z.push_back(normals(2, i));
  }
  for (int step = first_step_ + 1;; ++step) {
    const double distance = std::exp(kPairDistanceStep * step) / radius;
    if (distance > 2.1) break;  // the diameter, with rounding
    sq_distances_.push_back(static_cast<float>(distance * distance));
  }
}

void PairedSurface::fillRow(int i, PairRow& row) const {
  static const std::vector<float> limits = cosineLimits<kPairAngles>(kPi);
  static const std::vector<float> other_limits = cosineLimits<kPairOtherAngles>(0.5 * kPi);
  const std::size_t size = points_.x.size(), at = static_cast<std::size_t>(i);
  const Eigen::Matrix3d frame = frameOf(Eigen::Vector3f(normals_.x[at], normals_.y[at], normals_.z[at]).cast<double>());
  RowInput in{points_.x.data(),
              points_.y.data(),
              points_.z.data(),
              normals_.x.data(),
              normals_.y.data(),
              normals_.z.data(),
              static_cast<int>(size),
              {points_.x[at], points_.y[at], points_.z[at]},
              {}};
  for (int k = 0; k < 3; ++k)
    for (int c = 0; c < 3; ++c) in.frame[k][c] = static_cast<float>(frame(c, k));
  std::vector<float> cosine(size), other(size), between(size);
  row.distance.resize(size);
  row.rotation.resize(size);
  row.distance_step.assign(size, first_step_);
  for (std::vector<int>* steps : {&row.angle_step, &row.other_step, &row.between_step}) steps->assign(size, 0);
  const RowOutput out{row.distance.data(), cosine.data(), other.data(), between.data(), row.rotation.data()};
  fillCosines(in, out);
  fillRotations(in, out);
  const auto count = [&](const std::vector<float>& values, const std::vector<float>& ends, float sign,
                         std::vector<int>& steps) {
    countLimits(values.data(), in.size, ends.data(), static_cast<int>(ends.size()), sign, steps.data());
  };
  count(row.distance, sq_distances_, 1.0f, row.distance_step);
  count(cosine, limits, -1.0f, row.angle_step);
  count(other, other_limits, -1.0f, row.other_step);
  count(between, other_limits, -1.0f, row.between_step);
  for (float& distance : row.distance) distance = std::sqrt(distance);
}

}  // namespace pcl_symmetry
