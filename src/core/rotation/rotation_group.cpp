#include "pcl_symmetry/core/rotation_group.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/rotation/placed_group.h"

namespace pcl_symmetry {

namespace {

constexpr double kSameRotation = 1e-6;  // radians; elements of C_n differ by 2 pi / n

}  // namespace

Eigen::Matrix3d rotationAbout(const Eigen::Vector3d& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

Eigen::Isometry3d motionFixing(const Eigen::Vector3d& center, const Eigen::Matrix3d& rotation) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = rotation;
  motion.translation() = center - rotation * center;
  return motion;
}

Eigen::Vector3d signedDirection(const Eigen::Vector3d& direction) {
  int largest = 0;
  direction.cwiseAbs().maxCoeff(&largest);
  return direction[largest] < 0.0 ? -direction : direction;
}

std::vector<Eigen::Matrix3d> RotationGroup::generators() const {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), z = Eigen::Vector3d::UnitZ();
  const Eigen::Matrix3d cyclic = rotationAbout(z, 2.0 * kPi / fold);
  const Eigen::Matrix3d diagonal = rotationAbout(Eigen::Vector3d::Ones().normalized(), 2.0 * kPi / 3.0);
  const double golden_ratio = 0.5 * (1.0 + std::sqrt(5.0));
  switch (kind) {
    case RotationGroupKind::Cyclic:
      return fold == 1 ? std::vector<Eigen::Matrix3d>{} : std::vector{cyclic};
    case RotationGroupKind::Dihedral:
      return fold == 1 ? std::vector{rotationAbout(x, kPi)} : std::vector{cyclic, rotationAbout(x, kPi)};
    case RotationGroupKind::Tetrahedral:
      return {rotationAbout(z, kPi), diagonal};
    case RotationGroupKind::Octahedral:
      return {rotationAbout(z, 0.5 * kPi), diagonal};
    case RotationGroupKind::Icosahedral:
      return {rotationAbout(Eigen::Vector3d(0.0, 1.0, golden_ratio).normalized(), 0.4 * kPi), diagonal};
    default:
      check(false, "kind", nameOf(kind, fold), "a finite group");
      return {};
  }
}

std::vector<Eigen::Matrix3d> RotationGroup::elements() const {
  check(fold >= 1, "fold", fold, ">= 1");
  return productsOf(generators(), kSameRotation, std::numeric_limits<std::size_t>::max());
}

std::vector<Eigen::Matrix3d> productsOf(const std::vector<Eigen::Matrix3d>& generators, double same_rotation,
                                        std::size_t most) {
  // Frobenius norm of the difference of two rotations by an angle.
  const double apart = std::sqrt(8.0) * std::sin(0.5 * same_rotation);
  std::vector<Eigen::Matrix3d> elements{Eigen::Matrix3d::Identity()};
  for (std::size_t i = 0; i < elements.size(); ++i) {
    for (const Eigen::Matrix3d& generator : generators) {
      const Eigen::Matrix3d product = generator * elements[i];
      const auto is_same = [&](const Eigen::Matrix3d& other) { return (other - product).norm() < apart; };
      if (std::any_of(elements.begin(), elements.end(), is_same)) continue;
      elements.push_back(product);
      if (elements.size() > most)
        throw std::invalid_argument("discrete: the rotations generate no group of at most " + std::to_string(most) +
                                    " rotations");
    }
  }
  return elements;
}

std::vector<RotationAxis> axesOf(const std::vector<Eigen::Matrix3d>& elements, double same_axis) {
  std::vector<RotationAxis> axes;
  for (const Eigen::Matrix3d& element : elements) {
    const Eigen::AngleAxisd rotation(element);
    if (std::abs(rotation.angle()) < kSameRotation) continue;
    const Eigen::Vector3d& direction = rotation.axis();
    const auto known = std::find_if(axes.begin(), axes.end(), [&](const RotationAxis& axis) {
      return axis.direction.cross(direction).norm() < std::sin(same_axis);
    });
    if (known == axes.end())
      axes.push_back({signedDirection(direction), 2});
    else
      ++known->order;
  }
  return axes;
}

std::string nameOf(RotationGroupKind kind, int fold) {
  switch (kind) {
    case RotationGroupKind::Cyclic:
      return "C" + std::to_string(fold);
    case RotationGroupKind::Dihedral:
      return "D" + std::to_string(fold);
    case RotationGroupKind::Tetrahedral:
      return "T";
    case RotationGroupKind::Octahedral:
      return "O";
    case RotationGroupKind::Icosahedral:
      return "I";
    case RotationGroupKind::Revolution:
      return "Cinf";
    case RotationGroupKind::Cylindrical:
      return "Dinf";
    case RotationGroupKind::Spherical:
      return "SO3";
  }
  return "";
}

}  // namespace pcl_symmetry
