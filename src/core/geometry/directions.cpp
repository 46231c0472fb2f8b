#include "core/geometry/directions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/check.h"
#include "core/base/constants.h"

namespace pcl_symmetry {

namespace {

Eigen::Vector3d directionAt(double z, double angle) {
  const double ring = std::sqrt(1.0 - z * z);
  return {ring * std::cos(angle), ring * std::sin(angle), z};
}

std::array<Eigen::Matrix3i, kNumAxisRotations> makeRotations() {
  // All orders of three axes, the three cyclic ones first
  constexpr int kOrders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  std::array<Eigen::Matrix3i, kNumAxisRotations> rotations;
  std::size_t count = 0;
  for (const auto& order : kOrders)
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3i rotation = Eigen::Matrix3i::Zero();
      for (int axis = 0; axis < 3; ++axis) rotation(order[axis], axis) = signs >> axis & 1 ? -1 : 1;
      if (rotation.determinant() == 1) rotations[count++] = rotation;
    }
  return rotations;
}

/// A ring of directions about the pole.
struct Ring {
  double theta;  ///< radians from the pole
  int size;      ///< number of directions, evenly spaced
};

/// The number of directions on a ring that are needed so that no point of the band up to \p theta_border is farther
/// than an angle.
int directionsReaching(double theta, double theta_border, double angle) {
  const double across = std::sin(theta) * std::sin(theta_border);
  const double along = std::cos(theta) * std::cos(theta_border);
  if (along - across >= std::cos(angle)) return 1;  // even the far side of the border is near enough
  const double cos_half_width = (std::cos(angle) - along) / across;
  if (cos_half_width >= 1.0) return std::numeric_limits<int>::max();  // not even the near side is near enough
  return static_cast<int>(std::ceil(kPi / std::acos(cos_half_width)));
}

/// A cap around either pole, and \p num_bands bands between them.
std::vector<Ring> ringsOf(int num_bands, double angle) {
  const double width = (kPi - 2.0 * angle) / num_bands;
  std::vector<Ring> rings{{0.0, 1}};
  for (int i = 0; i < num_bands; ++i) {
    const double low = angle + i * width, high = low + width, theta = low + 0.5 * width;
    rings.push_back({theta, std::max(directionsReaching(theta, low, angle), directionsReaching(theta, high, angle))});
  }
  rings.push_back({kPi, 1});
  return rings;
}

double sizeOf(const std::vector<Ring>& rings) {
  double size = 0.0;
  for (const Ring& ring : rings) size += ring.size;
  return size;
}

/// Rings for the number of bands that needs the fewest directions.
std::vector<Ring> fewestRings(double angle) {
  if (angle >= kPi) return {{0.0, 1}};
  if (angle >= 0.5 * kPi) return {{0.0, 1}, {kPi, 1}};
  // Bands wider than twice the angle are not covered. For small angles, square cells of sqrt(2) times the angle are
  // best, and bands half as wide never are.
  const int min_bands = std::max(1, static_cast<int>(std::ceil((kPi - 2.0 * angle) / (2.0 * angle))));
  std::vector<Ring> best = ringsOf(min_bands, angle);
  for (int num_bands = min_bands + 1; num_bands <= 2 * min_bands + 2; ++num_bands) {
    std::vector<Ring> rings = ringsOf(num_bands, angle);
    if (sizeOf(rings) < sizeOf(best)) best = std::move(rings);
  }
  return best;
}

}  // namespace

double goldenFraction(int k) {
  return k * kGoldenSection - std::floor(k * kGoldenSection);
}

Eigen::Vector3d spiralDirection(int k, int count, double angle) {
  return directionAt((k + 0.5) / count, angle);
}

std::vector<Eigen::Vector3d> evenDirections(int num_directions) {
  check(num_directions >= 1, "num_directions", num_directions, ">= 1");
  // One unit in the last place below kGoldenAngle: stored signatures were made with these very directions.
  const double golden_angle = kPi * (3.0 - std::sqrt(5.0));
  std::vector<Eigen::Vector3d> directions;
  for (int i = 0; i < num_directions; ++i)
    directions.push_back(directionAt(1.0 - (2.0 * i + 1.0) / num_directions, golden_angle * i));
  return directions;
}

const std::array<Eigen::Matrix3i, kNumAxisRotations>& axisRotations() {
  static const std::array<Eigen::Matrix3i, kNumAxisRotations> rotations = makeRotations();
  return rotations;
}

std::vector<Eigen::Matrix3d> tiltsCovering(const Eigen::Vector3d& axis, double angle) {
  check(angle > 0.0 && angle <= kPi, "angle", angle, "in (0, pi]");
  std::vector<Eigen::Matrix3d> tilts;
  for (const Ring& ring : fewestRings(angle)) {
    for (int k = 0; k < ring.size; ++k) {
      const Eigen::Vector3d tilt_axis = directionAcross(axis, 2.0 * kPi * k / ring.size);
      tilts.push_back(Eigen::AngleAxisd(ring.theta, tilt_axis).toRotationMatrix());
    }
  }
  return tilts;
}

}  // namespace pcl_symmetry
