/// Poses of symmetric objects: closed forms against dense sampling, properties of classes, tracks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/rotation/rotation_cover.h"
#include "pcl_symmetry/core/rotational_symmetry.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using Poses = std::vector<Eigen::Isometry3d>;

/// A random rotation and a shift by up to \p shift.
Eigen::Isometry3d poseFrom(RandomStream& random, double shift = 2.0) {
  Eigen::Quaterniond q(test::gaussian(random), test::gaussian(random), test::gaussian(random), test::gaussian(random));
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = q.normalized().toRotationMatrix();
  for (int k = 0; k < 3; ++k) T.translation()[k] = shift * (2.0 * random.uniform() - 1.0);
  return T;
}

Eigen::Isometry3d rotationAboutPoint(const Eigen::Vector3d& axis, double angle, const Eigen::Vector3d& fixed) {
  return motionFixing(fixed, rotationAbout(axis.normalized(), angle));
}

/// A group with its axes and its center somewhere.
ObjectSymmetries placedGroupOf(RotationGroupKind kind, int fold, const Eigen::Isometry3d& place) {
  ObjectSymmetries group;
  group.kind = kind;
  group.fold = isContinuous(kind) ? 0 : fold;
  group.center = place.translation();
  const auto motion = [&](const Eigen::Matrix3d& R) {
    const Eigen::Matrix3d placed = place.linear() * R * place.linear().transpose();
    return motionFixing(group.center, placed);
  };
  if (kind == RotationGroupKind::Spherical) {
    for (int k = 0; k < 3; ++k) group.continuous.push_back({Eigen::Vector3d::Unit(k), group.center});
  } else if (isContinuous(kind)) {
    group.continuous.push_back({place.linear().col(2), group.center});
    if (kind == RotationGroupKind::Cylindrical)
      group.discrete.push_back(motion(rotationAbout(Eigen::Vector3d::UnitX(), kPi)));
  } else {
    for (const Eigen::Matrix3d& R : RotationGroup{kind, fold}.elements())
      if (!R.isIdentity(1e-9)) group.discrete.push_back(motion(R));
  }
  return group;
}

struct NamedGroup {
  RotationGroupKind kind;
  int fold;
};

const std::vector<NamedGroup> kGroups{
    {RotationGroupKind::Cyclic, 1},      {RotationGroupKind::Cyclic, 2},      {RotationGroupKind::Cyclic, 5},
    {RotationGroupKind::Cyclic, 24},     {RotationGroupKind::Dihedral, 2},    {RotationGroupKind::Dihedral, 3},
    {RotationGroupKind::Dihedral, 6},    {RotationGroupKind::Tetrahedral, 3}, {RotationGroupKind::Octahedral, 4},
    {RotationGroupKind::Icosahedral, 5}, {RotationGroupKind::Revolution, 0},  {RotationGroupKind::Cylindrical, 0},
    {RotationGroupKind::Spherical, 0}};

/// Each group in its own frame, and rotated and shifted.
std::vector<ObjectSymmetries> groups() {
  RandomStream random(7);
  std::vector<ObjectSymmetries> all;
  for (const auto& [kind, fold] : kGroups) {
    all.push_back(placedGroupOf(kind, fold, Eigen::Isometry3d::Identity()));
    all.push_back(placedGroupOf(kind, fold, poseFrom(random)));
  }
  return all;
}

/// A symmetry of the group, drawn at random.
Eigen::Isometry3d symmetryFrom(const ObjectSymmetries& group, RandomStream& random) {
  if (group.continuous.size() > 1)
    return rotationAboutPoint(poseFrom(random).linear().col(0), 6.0 * random.uniform(), group.center);
  const std::size_t k = random.below(group.discrete.size() + 1);
  const Eigen::Isometry3d element = k == 0 ? Eigen::Isometry3d::Identity() : group.discrete[k - 1];
  if (group.continuous.empty()) return element;
  return element * rotationAboutPoint(group.continuous[0].axis, 2.0 * kPi * random.uniform(), group.center);
}

double angleApart(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::Quaterniond(a.linear()).angularDistance(Eigen::Quaterniond(b.linear()));
}

double apart(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

Points pointsFrom(RandomStream& random, int size) {
  Points points(3, size);
  for (Eigen::Index i = 0; i < points.size(); ++i) points(i) = static_cast<float>(2.0 * random.uniform() - 1.0);
  return points;
}

/// The greatest distance of points in two poses.
double greatestOffset(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, const Points& points) {
  double sq = 0.0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d x = points.col(i).cast<double>();
    sq = std::max(sq, (a * x - b * x).squaredNorm());
  }
  return std::sqrt(sq);
}

TEST(PoseSymmetry, EquivalentsAreThePoseTimesEachSymmetry) {
  RandomStream random(1);
  for (const ObjectSymmetries& group : groups()) {
    SCOPED_TRACE(group.name());
    const Eigen::Isometry3d T = poseFrom(random);
    const Poses equivalents = group.equivalents(T, 0.7);
    EXPECT_EQ(apart(equivalents[0], T), 0.0);
    if (group.continuous.size() < 2) {
      const std::size_t num_angles = group.continuous.empty() ? 1 : 9;  // 9 > 2 pi / 0.7
      EXPECT_EQ(equivalents.size(), num_angles * (group.discrete.size() + 1));
    }
    for (const Eigen::Isometry3d& other : equivalents) {
      EXPECT_LT(group.distance(T, other).angle, 1e-7);
      EXPECT_LT(group.distance(T, other).offset, 1e-12);
    }
    for (int k = 0; k < 20; ++k) {
      const Eigen::Isometry3d drawn = T * symmetryFrom(group, random);
      double least = kPi;
      for (const Eigen::Isometry3d& other : equivalents) least = std::min(least, angleApart(drawn, other));
      EXPECT_LE(least, group.continuous.empty() ? 1e-7 : 0.35) << "half a step";
    }
  }
}

/// Rotations of a continuous group are sampled every \p step: the closed form is never worse, and the samples come
/// close.
TEST(PoseSymmetry, ClosestIsThatOfDenseSampling) {
  RandomStream random(2);
  for (const ObjectSymmetries& group : groups()) {
    SCOPED_TRACE(group.name());
    const double step = group.continuous.size() > 1 ? 0.4 : 0.01;
    for (int k = 0; k < (group.continuous.size() > 1 ? 2 : 10); ++k) {
      const Eigen::Isometry3d T = poseFrom(random), previous = poseFrom(random);
      const Eigen::Isometry3d closest = group.closestTo(T, previous);
      EXPECT_LT(group.distance(T, closest).angle, 1e-7) << "looks like T";
      EXPECT_LT((T * group.center - closest * group.center).norm(), 1e-12);
      double least = kPi;
      for (const Eigen::Isometry3d& other : group.equivalents(T, step))
        least = std::min(least, angleApart(other, previous));
      const double found = angleApart(closest, previous);
      EXPECT_LE(found, least + 1e-9);
      EXPECT_LE(least, found + (group.continuous.empty() ? 1e-9 : 0.5 * step));
      EXPECT_NEAR(group.distance(previous, T).angle, found, 1e-9);
    }
  }
}

TEST(PoseSymmetry, CanonicalIsTheSameForAllThatLookTheSame) {
  RandomStream random(3);
  for (const ObjectSymmetries& group : groups()) {
    SCOPED_TRACE(group.name());
    Poses poses{Eigen::Isometry3d::Identity()};
    for (int k = 0; k < 6; ++k) poses.push_back(poseFrom(random));
    // Poses between equals: rotations by 90 and 180 degrees about the axes of the group and of the frame.
    for (const double angle : {0.5 * kPi, kPi, kPi / 3.0, kPi / 5.0}) {
      for (int k = 0; k < 3; ++k)
        poses.push_back(rotationAboutPoint(Eigen::Vector3d::Unit(k), angle, Eigen::Vector3d::Ones()));
      if (!group.continuous.empty())
        poses.push_back(rotationAboutPoint(group.continuous[0].axis.unitOrthogonal(), angle, {1, 2, 3}));
    }
    for (const Eigen::Isometry3d& T : poses) {
      const Eigen::Isometry3d canonical = group.canonical(T);
      EXPECT_LT(group.distance(T, canonical).angle, 1e-7) << "looks like T";
      EXPECT_LT(apart(group.canonical(canonical), canonical), 1e-7);
      EXPECT_LE(angleApart(canonical, Eigen::Isometry3d::Identity()),
                angleApart(T, Eigen::Isometry3d::Identity()) + 1e-7);
      for (int k = 0; k < 6; ++k) {
        const Eigen::Isometry3d same = T * symmetryFrom(group, random);
        EXPECT_LT(apart(group.canonical(same), canonical), 1e-7);
      }
    }
    EXPECT_LT(apart(group.canonical(Eigen::Isometry3d::Identity()), Eigen::Isometry3d::Identity()), 1e-12);
  }
}

TEST(PoseSymmetry, DistanceIsThatOfClasses) {
  RandomStream random(4);
  for (const ObjectSymmetries& group : groups()) {
    SCOPED_TRACE(group.name());
    for (int k = 0; k < 5; ++k) {
      const Eigen::Isometry3d a = poseFrom(random), b = poseFrom(random), c = poseFrom(random);
      const PoseDistance ab = group.distance(a, b);
      EXPECT_NEAR(group.distance(b, a).angle, ab.angle, 1e-9);
      EXPECT_NEAR(group.distance(a * symmetryFrom(group, random), b * symmetryFrom(group, random)).angle, ab.angle,
                  1e-7);
      EXPECT_LE(ab.angle, group.distance(a, c).angle + group.distance(c, b).angle + 1e-9);
      EXPECT_NEAR(ab.offset, (a * group.center - b * group.center).norm(), 1e-12);
    }
  }
}

TEST(PoseSymmetry, SurfaceDistanceIsThatOfDenseSampling) {
  RandomStream random(5);
  const Points points = pointsFrom(random, 200);
  for (const ObjectSymmetries& group : groups()) {
    if (group.kind == RotationGroupKind::Spherical) continue;
    SCOPED_TRACE(group.name());
    for (int k = 0; k < 4; ++k) {
      const Eigen::Isometry3d a = poseFrom(random);
      const Eigen::Isometry3d b =
          k < 2 ? poseFrom(random) : a * rotationAboutPoint({1, 2, 3}, 0.05, {1, 0, 1}) * symmetryFrom(group, random);
      constexpr double kStep = 0.002;
      double least = 1e9, farthest_arm = 0.0;
      for (const Eigen::Isometry3d& other : group.equivalents(b, kStep))
        least = std::min(least, greatestOffset(a, other, points));
      for (Eigen::Index i = 0; i < points.cols(); ++i)
        farthest_arm = std::max(farthest_arm, (points.col(i).cast<double>() - group.center).norm());
      const double found = group.surfaceDistance(a, b, points);
      EXPECT_LE(found, least + 1e-9);
      EXPECT_LE(least, found + (group.continuous.empty() ? 1e-9 : 0.5 * kStep * farthest_arm));
      EXPECT_NEAR(group.surfaceDistance(a, b * symmetryFrom(group, random), points), found, 1e-6);
    }
    const Eigen::Isometry3d T = poseFrom(random);
    EXPECT_LT(group.surfaceDistance(T, T * symmetryFrom(group, random), points), 1e-6);
  }
}

/// Points of a ball that come in opposite pairs: whatever the rotation, one of a pair is at least as far as the center.
TEST(PoseSymmetry, SurfaceDistanceOfASphereIsThatOfItsCenters) {
  RandomStream random(6);
  const ObjectSymmetries sphere = placedGroupOf(RotationGroupKind::Spherical, 0, poseFrom(random));
  Points points(3, 400);
  for (Eigen::Index i = 0; i < points.cols(); i += 2) {
    const Eigen::Vector3d out = poseFrom(random).linear().col(0);
    points.col(i) = (sphere.center + 0.7 * out).cast<float>();
    points.col(i + 1) = (sphere.center - 0.7 * out).cast<float>();
  }
  const Eigen::Isometry3d a = poseFrom(random), b = poseFrom(random);
  const double found = sphere.surfaceDistance(a, b, points);
  EXPECT_NEAR(found, greatestOffset(a, sphere.closestTo(b, a), points), 1e-6);
  for (int k = 0; k < 200; ++k) EXPECT_GE(greatestOffset(a, b * symmetryFrom(sphere, random), points), found - 1e-6);
  EXPECT_THROW(sphere.surfaceDistance(a, b, Points(3, 0)), std::invalid_argument);
}

TEST(PoseSymmetry, GroupsComeBackFromTheirMotions) {
  RandomStream random(11);
  for (const ObjectSymmetries& group : groups()) {
    SCOPED_TRACE(group.name());
    // As a file rounds them to four digits.
    Poses rounded = group.discrete;
    for (Eigen::Isometry3d& motion : rounded) motion.matrix() = (motion.matrix() * 1e4).array().round().matrix() / 1e4;
    const ObjectSymmetries found = ObjectSymmetries::from(rounded, group.continuous);
    EXPECT_EQ(found.name(), group.name());
    ASSERT_EQ(found.discrete.size(), group.discrete.size());
    ASSERT_EQ(found.continuous.size(), group.continuous.size());
    const Points points = pointsFrom(random, 20);
    for (int k = 0; k < 5; ++k) {
      const Eigen::Isometry3d same = symmetryFrom(group, random);
      if (group.kind == RotationGroupKind::Spherical) continue;
      EXPECT_LT(found.surfaceDistance(Eigen::Isometry3d::Identity(), same, points), 2e-3);
    }
    for (const Eigen::Isometry3d& a : found.discrete)
      for (const Eigen::Isometry3d& b : found.discrete)
        EXPECT_LT(found.distance(a * b, Eigen::Isometry3d::Identity()).angle, 1e-7);
  }
}

TEST(PoseSymmetry, GroupsGrowFromGeneratorsAndRefuseWhatIsNone) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), z = Eigen::Vector3d::UnitZ(), center(1, 2, 3);
  EXPECT_EQ(ObjectSymmetries::from({}, {}).name(), "C1");
  EXPECT_EQ(ObjectSymmetries::from({Eigen::Isometry3d::Identity()}, {}).name(), "C1");
  EXPECT_EQ(ObjectSymmetries::from({rotationAboutPoint(z, 2.0 * kPi / 7.0, center)}, {}).name(), "C7");
  const ObjectSymmetries prism =
      ObjectSymmetries::from({rotationAboutPoint(z, kPi / 3.0, center), rotationAboutPoint(x, kPi, center)}, {});
  EXPECT_EQ(prism.name(), "D6");
  EXPECT_EQ(prism.discrete.size(), 11u);
  EXPECT_LT((prism.center - center).norm(), 1e-9);
  EXPECT_EQ(
      ObjectSymmetries::from({rotationAboutPoint(z, kPi / 2.0, center), rotationAboutPoint(x, kPi / 2.0, center)}, {})
          .name(),
      "O");
  EXPECT_EQ(ObjectSymmetries::from({rotationAboutPoint(x, kPi, center)}, {{2.0 * z, center}}).name(), "Dinf");
  EXPECT_EQ(ObjectSymmetries::from({rotationAboutPoint(z, 1.0, center)}, {{z, center}}).name(), "Cinf");
  EXPECT_EQ(ObjectSymmetries::from({rotationAboutPoint(x, 1.0, center)}, {{z, center}}).name(), "SO3");
  EXPECT_EQ(ObjectSymmetries::from({}, {{z, center}, {x, center}}).name(), "SO3");
  EXPECT_THROW(ObjectSymmetries::from({rotationAboutPoint(z, 1.0, center)}, {}), std::invalid_argument)
      << "never comes round";
  EXPECT_THROW(ObjectSymmetries::from({}, {{Eigen::Vector3d::Zero(), center}}), std::invalid_argument);
  EXPECT_THROW(ObjectSymmetries::from({}, {{z, center}, {x, Eigen::Vector3d(1, 20, 30)}}), std::invalid_argument)
      << "axes that do not meet";
  Eigen::Isometry3d screw = rotationAboutPoint(z, kPi, center);
  screw.translation() += z;
  EXPECT_THROW(ObjectSymmetries::from({screw}, {}), std::invalid_argument);
}

TEST(TiltsCovering, ReachEveryRotationWithinTheAngle) {
  RandomStream random(12);
  const Eigen::Vector3d axis = poseFrom(random).linear().col(0);
  for (const double degrees : {180.0, 90.0, 60.0, 30.0, 15.0, 5.0}) {
    const double angle = degrees * kDegree;
    const std::vector<Eigen::Matrix3d> tilts = tiltsCovering(axis, angle);
    EXPECT_TRUE(tilts[0].isIdentity(1e-12));
    EXPECT_LE(static_cast<double>(tilts.size()), 2.0 + 8.0 / (angle * angle)) << degrees;
    double farthest = 0.0;
    for (int k = 0; k < 5000; ++k) {
      // R = C D H: H takes R^-1 a to D^-1 a.
      const Eigen::Vector3d direction = poseFrom(random).linear().col(0);
      double closest = -1.0;
      for (const Eigen::Matrix3d& tilt : tilts) closest = std::max(closest, direction.dot(tilt.transpose() * axis));
      farthest = std::max(farthest, std::acos(std::min(1.0, closest)));
    }
    EXPECT_LE(farthest, angle);
    EXPECT_GE(farthest, 0.6 * angle) << degrees << ": no more tilts than needed";
  }
  EXPECT_THROW(tiltsCovering(axis, 0.0), std::invalid_argument);
}

}  // namespace
