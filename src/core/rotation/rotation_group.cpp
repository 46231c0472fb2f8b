#include "pcl_symmetry/core/rotation_group.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/small_motion.h"
#include "core/rotation/placed_group.h"

namespace pcl_symmetry {

namespace {

// Frobenius norm of the difference of equal matrices: elements of C_n differ by 2 sqrt(2) sin(pi / n).
constexpr double kSameRotation = 1e-6;

}  // namespace

Eigen::Matrix3d rotationAbout(const Eigen::Vector3d& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

Eigen::Isometry3d motionFixing(const Eigen::Vector3d& center, const Eigen::Matrix3d& rotation) {
  return isometry(rotation, center - rotation * center);
}

Eigen::Isometry3d motionAbout(const Line3d& line, double angle) {
  return motionFixing(line.origin(), rotationAbout(line.direction(), angle));
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
  return productsOf(generators(), kSameRotation);
}

std::vector<RotationAxis> axesOf(const std::vector<Eigen::Matrix3d>& elements) {
  std::vector<RotationAxis> axes;
  for (const Eigen::Matrix3d& element : elements) {
    const Eigen::AngleAxisd rotation(element);
    if (std::abs(rotation.angle()) < kSameRotation) continue;
    const auto known = std::find_if(axes.begin(), axes.end(), [&](const RotationAxis& axis) {
      return std::abs(axis.direction.dot(rotation.axis())) > 1.0 - 1e-9;
    });
    if (known == axes.end())
      axes.push_back({signedDirection(rotation.axis()), 2});
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
