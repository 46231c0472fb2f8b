/// Groups of rotations: of arbitrary points, and those that arbitrary motions generate.
#include <stdexcept>

#include "fuzz/byte_source.h"
#include "pcl_symmetry/core/rotational_symmetry.h"

namespace {

using namespace pcl_symmetry;

void checkGroup(const ObjectSymmetries& symmetries) {
  FUZZ_CHECK(symmetries.center.allFinite());
  FUZZ_CHECK(fuzz::isShare(symmetries.support) && fuzz::isShare(symmetries.confidence));
  // The icosahedron with its reflections has 120 elements, from() allows twice as many.
  FUZZ_CHECK(symmetries.discrete.size() < 240);
  for (const Eigen::Isometry3d& motion : symmetries.discrete) {
    FUZZ_CHECK(motion.matrix().allFinite());
    FUZZ_CHECK(motion.linear().isUnitary(1e-6) && motion.linear().determinant() > 0.0);
  }
  for (const ContinuousSymmetry& axis : symmetries.continuous) FUZZ_CHECK(std::abs(axis.axis.norm() - 1.0) < 1e-6);
}

/// Any motions: turns by whole parts of a circle, so that some generate a group, or by any angle.
Eigen::Isometry3d takeMotion(fuzz::ByteSource& source) {
  Eigen::Vector3d axis(source.take<std::int8_t>(), source.take<std::int8_t>(), source.take<std::int8_t>());
  if (axis.norm() == 0.0) axis = Eigen::Vector3d::UnitZ();
  const double angle = source.flag() ? 2.0 * M_PI / (1 + source.below(12)) : static_cast<double>(source.take<float>());
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  if (source.flag()) motion.translation().setConstant(static_cast<double>(source.take<float>()));
  return motion;
}

void generatedGroup(fuzz::ByteSource& source) {
  std::vector<Eigen::Isometry3d> motions;
  std::vector<ContinuousSymmetry> axes;
  for (int i = source.below(4); i > 0; --i) motions.push_back(takeMotion(source));
  for (int i = source.below(3); i > 0; --i) {
    const Eigen::Vector3d axis(source.take<std::int8_t>(), source.take<std::int8_t>(), source.take<std::int8_t>());
    axes.push_back({axis, Eigen::Vector3d::Constant(source.take<std::int8_t>())});
  }
  const ObjectSymmetries symmetries = ObjectSymmetries::from(motions, axes);
  checkGroup(symmetries);
  const Eigen::Isometry3d pose = takeMotion(source);
  if (!pose.matrix().allFinite()) return;
  const PoseDistance distance = symmetries.distance(pose, symmetries.canonical(pose));
  FUZZ_CHECK(distance.angle < 1e-3);
}

void groupOfPoints(fuzz::ByteSource& source) {
  ObjectSymmetryOptions options;
  options.num_cells = 8 + source.below(9);
  options.num_directions = 100;
  options.max_fold = 2 + source.below(12);
  options.max_points = 100;
  options.other_tolerances = source.flag();
  options.num_threads = 1;
  checkGroup(objectSymmetries(fuzz::takePoints(source, 200), options));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::ByteSource source(data, size);
  try {
    if (source.flag())
      generatedGroup(source);
    else
      groupOfPoints(source);
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
