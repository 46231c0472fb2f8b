/// The group of rotations that motions and axes generate, placed exactly.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>

#include "core/base/constants.h"
#include "core/base/symmetric_solvers.h"
#include "core/rotation/placed_group.h"

namespace pcl_symmetry {

namespace {

// Rotations that differ by less than this count as one: files are rounded, and folds go up to 120.
constexpr double kOneRotation = 1.0 * kDegree;

using Rotations = std::vector<Eigen::Matrix3d>;
using Kind = RotationGroupKind;

Eigen::Matrix3d closestRotation(const Eigen::Matrix3d& matrix) {
  return Eigen::Affine3d(matrix).rotation();
}

/// The axes of products, which differ by rounding.
std::vector<RotationAxis> axesOfProducts(const Rotations& elements) {
  std::vector<RotationAxis> axes;
  for (std::size_t i = 1; i < elements.size(); ++i) {
    const Eigen::Vector3d direction = Eigen::AngleAxisd(elements[i]).axis();
    // Axes of a group with at most 240 rotations are at least 1.5 degrees apart.
    const auto known = std::find_if(axes.begin(), axes.end(), [&](const RotationAxis& axis) {
      return axis.direction.cross(direction).norm() < std::sin(0.7 * kDegree);
    });
    if (known == axes.end())
      axes.push_back({direction, 2});
    else
      ++known->order;
  }
  return axes;
}

RotationGroup groupOf(std::size_t size, const std::vector<RotationAxis>& axes) {
  std::map<int, int> num_axes;
  for (const RotationAxis& axis : axes) ++num_axes[axis.order];
  if (axes.empty()) return {Kind::Cyclic, 1};
  if (axes.size() == 1) return {Kind::Cyclic, static_cast<int>(size)};
  for (const RotationGroup& solid : kPolyhedralGroups)  // only these groups have several axes of order 3
    if (num_axes[3] > 1 && size == solid.elements().size()) return solid;
  return {Kind::Dihedral, static_cast<int>(size / 2)};
}

/// A rotation that maps the axes z and x of a group's own frame to axes of the generated one.
Eigen::Matrix3d roughFrame(const RotationGroup& group, const std::vector<RotationAxis>& axes) {
  const int main_order = group.kind == Kind::Cyclic || group.kind == Kind::Dihedral ? group.fold
                         : group.kind == Kind::Octahedral                           ? 4
                                                                                    : 2;
  const auto main = std::find_if(axes.begin(), axes.end(), [&](const auto& axis) { return axis.order == main_order; });
  const Eigen::Vector3d z = main->direction;
  Eigen::Vector3d x = z.unitOrthogonal();
  if (group.kind != Kind::Cyclic) {
    const int across_order = group.kind == Kind::Octahedral ? 4 : 2;
    double least = 1.0;
    for (const RotationAxis& axis : axes) {
      const double along = std::abs(axis.direction.dot(z));
      if (axis.order != across_order || along >= least) continue;
      least = along;
      x = axis.direction;
    }
  }
  return frameAlong(z, x);
}

const Eigen::Matrix3d& closestOf(const Rotations& rotations, const Eigen::Matrix3d& rotation) {
  return *std::min_element(rotations.begin(), rotations.end(), [&](const auto& a, const auto& b) {
    return (a - rotation).squaredNorm() < (b - rotation).squaredNorm();
  });
}

double misfitOf(const Rotations& own, const Rotations& generated, const Eigen::Matrix3d& frame) {
  double sum = 0.0;
  for (const Eigen::Matrix3d& rotation : generated)
    sum += (closestOf(own, frame.transpose() * rotation * frame) - frame.transpose() * rotation * frame).squaredNorm();
  return sum;
}

/// The frame in which the elements of a group are closest to the generated ones. Their axes are fitted, weighted by the
/// sine of half the angle.
Eigen::Matrix3d closeFrame(const Rotations& own, const Rotations& generated, const Eigen::Matrix3d& frame) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Eigen::Matrix3d& rotation : generated) {
    const Eigen::Quaterniond to(rotation), from(closestOf(own, frame.transpose() * rotation * frame));
    const Eigen::Vector3d moved = frame * from.vec();
    sum += (moved.dot(to.vec()) < 0.0 ? -1.0 : 1.0) * to.vec() * from.vec().transpose();
  }
  if (sum.norm() == 0.0) return frame;
  // A single axis leaves the rotation about it undetermined: then the frame stays as it is.
  return closestRotation(sum / sum.norm() + 1e-6 * frame);
}

/// The elements of the group, placed exactly.
Rotations placed(const RotationGroup& group, const Rotations& generated, const std::vector<RotationAxis>& axes) {
  const Rotations own = group.elements();
  if (axes.empty()) return own;
  Eigen::Matrix3d frame = roughFrame(group, axes);
  // Three perpendicular axes of order 2 are compatible with two orientations of an icosahedron, a quarter turn apart.
  const Eigen::Matrix3d other = frame * rotationAbout(Eigen::Vector3d::UnitZ(), 0.5 * kPi);
  if (misfitOf(own, generated, other) < misfitOf(own, generated, frame) - 1e-6) frame = other;
  frame = closeFrame(own, generated, frame);
  Rotations result;
  for (const Eigen::Matrix3d& rotation : own) result.push_back(frame * rotation * frame.transpose());
  return result;
}

/// The fixed point of all motions that is closest to the origin, by least squares.
/// \throws std::invalid_argument if there is none.
Eigen::Vector3d fixedPoint(const std::vector<Eigen::Isometry3d>& motions, const std::vector<ContinuousSymmetry>& axes) {
  const auto num_rows = static_cast<Eigen::Index>(3 * (motions.size() + axes.size()));
  if (num_rows == 0) return Eigen::Vector3d::Zero();
  Eigen::MatrixX3d rows(num_rows, 3);
  Eigen::VectorXd right(num_rows);
  Eigen::Index row = 0;
  double size = 0.0;
  for (const Eigen::Isometry3d& motion : motions) {
    rows.middleRows<3>(row) = Eigen::Matrix3d::Identity() - closestRotation(motion.linear());
    right.segment<3>(row) = motion.translation();
    size = std::max(size, motion.translation().norm());
    row += 3;
  }
  for (const ContinuousSymmetry& symmetry : axes) {
    const Eigen::Vector3d axis = symmetry.axis.normalized();
    rows.middleRows<3>(row) = Eigen::Matrix3d::Identity() - axis * axis.transpose();
    right.segment<3>(row) = rows.middleRows<3>(row) * symmetry.offset;
    size = std::max(size, symmetry.offset.norm());
    row += 3;
  }
  const double off_center =
      0.02;  // greatest misfit, as a share of the translations: files are rounded, but a screw is no rotation
  const Eigen::Matrix3d squares = rows.transpose().lazyProduct(rows);
  const Eigen::Vector3d center =
      SymmetricEigen<Eigen::Matrix3d>(squares).solve(rows.transpose() * right, off_center * off_center);
  if ((rows * center - right).cwiseAbs().maxCoeff() > off_center * size)
    throw std::invalid_argument("discrete: the motions and axes have no fixed point in common");
  return center;
}

/// The axis that all axes of revolution share; nothing if motions or other axes tilt it, as on a sphere.
std::optional<Eigen::Vector3d> sharedAxis(const std::vector<ContinuousSymmetry>& axes, const Rotations& rotations) {
  const Eigen::Vector3d axis = axes.front().axis.normalized();
  const auto tilts = [&](const Eigen::Vector3d& other) { return axis.cross(other).norm() > std::sin(kOneRotation); };
  for (const ContinuousSymmetry& other : axes)
    if (tilts(other.axis.normalized())) return std::nullopt;
  for (const Eigen::Matrix3d& rotation : rotations)
    if (tilts(rotation * axis)) return std::nullopt;
  return axis;
}

void setRound(ObjectSymmetries& result, const std::vector<ContinuousSymmetry>& axes, const Rotations& rotations) {
  result.fold = 0;
  const std::optional<Eigen::Vector3d> axis = sharedAxis(axes, rotations);
  if (!axis) {
    result.kind = Kind::Spherical;
    for (int k = 0; k < 3; ++k) result.continuous.push_back({Eigen::Vector3d::Unit(k), result.center});
    return;
  }
  result.continuous.push_back({*axis, result.center});
  const auto flips = [&](const Eigen::Matrix3d& rotation) { return axis->dot(rotation * *axis) < 0.0; };
  const bool is_cylinder = std::any_of(rotations.begin(), rotations.end(), flips);
  result.kind = is_cylinder ? Kind::Cylindrical : Kind::Revolution;
  if (is_cylinder) result.discrete.push_back(motionFixing(result.center, rotationAbout(axis->unitOrthogonal(), kPi)));
}

}  // namespace

ObjectSymmetries ObjectSymmetries::from(const std::vector<Eigen::Isometry3d>& discrete,
                                        const std::vector<ContinuousSymmetry>& continuous) {
  for (const ContinuousSymmetry& symmetry : continuous)
    if (!(symmetry.axis.norm() > 0.0)) throw std::invalid_argument("continuous: axis = 0 0 0, must not be zero");
  Rotations rotations;
  for (const Eigen::Isometry3d& motion : discrete) rotations.push_back(closestRotation(motion.linear()));
  ObjectSymmetries result;
  result.center = fixedPoint(discrete, continuous);
  if (!continuous.empty()) {
    setRound(result, continuous, rotations);
    return result;
  }
  const std::size_t max_size = 240;  // size of D_120
  // Frobenius norm of the difference of two rotations by an angle: sqrt(8) sin(angle / 2).
  const Rotations products = productsOf(rotations, std::sqrt(8.0) * std::sin(0.5 * kOneRotation), max_size);
  if (products.size() > max_size)
    throw std::invalid_argument("discrete: the rotations generate no group of at most " + std::to_string(max_size) +
                                " rotations");
  const std::vector<RotationAxis> axes = axesOfProducts(products);
  const RotationGroup group = groupOf(products.size(), axes);
  result.kind = group.kind;
  result.fold = group.fold;
  const Rotations elements = placed(group, products, axes);
  for (std::size_t i = 1; i < elements.size(); ++i) result.discrete.push_back(motionFixing(result.center, elements[i]));
  return result;
}

}  // namespace pcl_symmetry
