/// Groups of rotations of shapes, and the poses that they make equal.
#include "pcl_symmetry/core/rotational_symmetry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/geometry/directions.h"
#include "shapes/complaint.h"
#include "shapes/shapes.h"
#include "shapes/threads.h"
#include "shapes/turning_shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

/// How far the closest of the motions found is from a rotation.
double angleToNearest(const std::vector<Eigen::Isometry3d>& found, const Eigen::Matrix3d& rotation) {
  double least = kPi;
  for (const Eigen::Isometry3d& motion : found)
    least = std::min(least, angleOf(motion.linear().transpose() * rotation));
  return least;
}

/// Products and inverses of the motions, with the identity, are among them.
void expectGroup(const std::vector<Eigen::Isometry3d>& motions, double size) {
  std::vector<Eigen::Isometry3d> all = motions;
  all.push_back(Eigen::Isometry3d::Identity());
  for (const Eigen::Isometry3d& a : all) {
    EXPECT_NEAR(a.linear().determinant(), 1.0, 1e-9);
    EXPECT_LT((a.linear() * a.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-9);
    for (const Eigen::Isometry3d& b : all) {
      const Eigen::Isometry3d product = a * b.inverse();
      const bool is_known = std::any_of(all.begin(), all.end(), [&](const Eigen::Isometry3d& c) {
        return (c.linear() - product.linear()).norm() < 1e-9 &&
               (c.translation() - product.translation()).norm() < 1e-6 * size;
      });
      EXPECT_TRUE(is_known);
    }
  }
}

class KnownGroup : public testing::TestWithParam<TurningShape> {
protected:
  static constexpr double kAngleError = 0.5 * kDegree;

  /// The group by name, each of its rotations, and the line of a continuous one.
  static void expectFound(const TurningShape& shape, const Eigen::Isometry3d& pose, double scale, std::uint64_t seed,
                          double noise = 0.0) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    ObjectSymmetryOptions options;
    options.seed = seed;
    const Shape sampled = scaled(moved(shape.sampled(2000, seed, noise), pose), scale);
    const ObjectSymmetries found = objectSymmetries(sampled.cloud(), options);
    ASSERT_EQ(found.name(), shape.group);
    EXPECT_GE(found.confidence, 0.5);
    const bool cylinder = found.kind == RotationGroupKind::Cylindrical;
    EXPECT_EQ(found.discrete.size(), cylinder ? 1u : shape.rotations.size());
    for (const Eigen::Matrix3d& rotation : shape.rotations) {
      const Eigen::Matrix3d placed = pose.linear() * rotation * pose.linear().transpose();
      EXPECT_LT(angleToNearest(found.discrete, placed), kAngleError);
    }
    expectGroup(found.discrete, scale);
    EXPECT_LT((found.center - scale * pose.translation()).norm(), 1.5 * scale)
        << "inside the shape, whatever its group";
    const Eigen::Vector3d axis = pose.linear() * shape.axis, origin = scale * pose.translation();
    for (const ContinuousSymmetry& symmetry : found.continuous) {
      EXPECT_NEAR(symmetry.axis.norm(), 1.0, 1e-9);
      if (found.kind == RotationGroupKind::Spherical) {
        EXPECT_LT((symmetry.offset - origin).norm(), 0.01 * scale);
        continue;
      }
      EXPECT_LT(symmetry.axis.cross(axis).norm(), std::sin(kAngleError));
      EXPECT_LT((symmetry.offset - origin).cross(axis).norm(), 0.01 * scale);
    }
    for (const Eigen::Isometry3d& motion : found.discrete) {
      EXPECT_LT((motion * origin - origin).norm(), 0.02 * scale) << "every axis passes through the origin of the shape";
      const double along = std::abs(Eigen::AngleAxisd(motion.linear()).axis().dot(axis));
      EXPECT_TRUE(!cylinder || along < std::sin(kAngleError)) << along;
    }
  }
};

TEST_P(KnownGroup, IsFoundMovedAndScaled) {
  expectFound(GetParam(), randomPose(2), 1e3, 2);
}

INSTANTIATE_TEST_SUITE_P(Shapes, KnownGroup, testing::ValuesIn(turningShapes()), [](const auto& instance) {
  std::string name = instance.param.name;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
});

class NoisyGroup : public KnownGroup {};

TEST_P(NoisyGroup, IsFoundUnderNoiseOfHalfAPerCent) {
  expectFound(GetParam(), randomPose(5), 1.0, 5, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Shapes, NoisyGroup,
                         testing::Values(boxShape(), prismShape(6, 0.8), cylinderShape(), cupShape(true),
                                         propellerShape(3, true)));

/// A box with knobs on its top, at (x, y).
std::string groupOfBoxWithKnobs(double side, const std::vector<Eigen::Vector2d>& places, double max_feature) {
  TurningShape shape = boxShape();
  for (const Eigen::Vector2d& place : places)
    shape.addBox({side, side, 0.5 * side},
                 Eigen::Isometry3d(Eigen::Translation3d(place.x(), place.y(), 0.45 + 0.5 * side)));
  ObjectSymmetryOptions options;
  options.max_feature = max_feature;
  return objectSymmetries(shape.sampled(6000, 1).cloud(), options).name();
}

/// The share of one knob in the surface of the box.
double shareOfKnob(double side) {
  return 8.0 * side * side / (8.0 * (0.7 + 0.45 + 0.315) + 8.0 * side * side);
}

TEST(ObjectSymmetries, SmallFeaturesBreakThemFromTheStatedShareOn) {
  ASSERT_LT(shareOfKnob(0.08), 0.005);
  ASSERT_GT(shareOfKnob(0.18), 0.02);
  EXPECT_EQ(groupOfBoxWithKnobs(0.08, {{0.5, 0.2}}, 0.01), "D2");
  EXPECT_EQ(groupOfBoxWithKnobs(0.18, {{0.5, 0.2}}, 0.01), "C1");
  EXPECT_EQ(groupOfBoxWithKnobs(0.08, {{0.5, 0.2}}, 0.0), "C1");
}

/// Each knob alone leaves the box its symmetry, as above.
TEST(ObjectSymmetries, SmallFeaturesCountTogether) {
  EXPECT_EQ(groupOfBoxWithKnobs(0.08, {{0.5, 0.2}, {-0.7, 0.4}, {0.1, -0.45}}, 0.01), "C1");
}

/// A hemisphere with a wall, open at the top.
TurningShape bowlShape() {
  TurningShape shape = turningShape("bowl", RotationGroupKind::Revolution);
  std::vector<Eigen::Vector2d> profile;
  for (int k = 0; k <= 24; ++k) profile.emplace_back(std::sin(kPi * k / 48), -std::cos(kPi * k / 48));
  for (int k = 24; k >= 0; --k) profile.emplace_back(0.92 * std::sin(kPi * k / 48), -0.92 * std::cos(kPi * k / 48));
  shape.addLathe(profile, 96);
  return shape;
}

/// A tire with spokes on one side.
TurningShape rimShape(int num_spokes) {
  TurningShape shape = turningShape("rim", RotationGroupKind::Cyclic, num_spokes);
  shape.addLathe({{0.8, -0.2}, {1.0, -0.2}, {1.0, 0.2}, {0.8, 0.2}, {0.8, -0.2}}, 120);
  shape.addLathe({{0.0, 0.05}, {0.2, 0.05}, {0.2, 0.25}, {0.0, 0.25}}, 120);
  for (int k = 0; k < num_spokes; ++k)
    shape.addBox({0.32, 0.09, 0.04}, Eigen::AngleAxisd(2.0 * kPi * k / num_spokes, Eigen::Vector3d::UnitZ()) *
                                         Eigen::Isometry3d(Eigen::Translation3d(0.5, 0.0, 0.15)));
  return shape;
}

/// A cylinder with a slot along its length, so wide that its floor and walls are 5 % of the surface.
TurningShape keyedShaftShape() {
  TurningShape shape = cylinderShape();
  for (Eigen::Vector3d& vertex : shape.vertices)
    if (vertex.head<2>().norm() > 0.5 && std::abs(std::atan2(vertex.y(), vertex.x())) < 0.13) vertex.x() = 0.5;
  return shape;
}

std::string groupOf(const TurningShape& shape, int num_points, std::uint64_t seed,
                    const std::function<void(ObjectSymmetryOptions&)>& change = nullptr) {
  ObjectSymmetryOptions options;
  options.seed = seed;
  if (change) change(options);
  return objectSymmetries(moved(shape.sampled(num_points, seed), randomPose(seed)).cloud(), options).name();
}

/// Walls as thick as points are apart, and so thick that points on both sides look like those of a body.
TEST(ObjectSymmetries, OfABowlAreNeverThoseOfASphere) {
  for (const int num_points : {2000, 6000, 10'000})
    EXPECT_EQ(groupOf(bowlShape(), num_points, 1), "Cinf") << num_points;
}

/// Multiples of the fold, and folds of the round tire alone, map most of the surface onto the surface.
TEST(ObjectSymmetries, OfARimHaveTheFoldOfItsSpokes) {
  EXPECT_EQ(groupOf(rimShape(5), 4000, 1), "C5");
  EXPECT_EQ(groupOf(rimShape(7), 4000, 2), "C7");
}

TEST(ObjectSymmetries, AreTheSameForAnyNumberOfPoints) {
  for (const int num_points : {2000, 10'000}) {
    EXPECT_EQ(groupOf(keyedShaftShape(), num_points, 1), "Dinf") << num_points;
    EXPECT_EQ(groupOf(prismShape(8, 0.8), num_points, 2), "D8") << num_points;
  }
}

TEST(ObjectSymmetries, IgnoreKeywaysUpToTheStatedShare) {
  EXPECT_EQ(groupOf(keyedShaftShape(), 2000, 1, [](auto& o) { o.max_feature = 0.1; }), "Dinf");
  EXPECT_EQ(groupOf(keyedShaftShape(), 5000, 1, [](auto& o) { o.max_feature = 0.01; }), "C2");
}

/// A plate whose sides differ by 2 x 4 % of 1: a rotation by 90 degrees maps the faces of two sides 4 % of 1 off, 1.4 %
/// of the diameter.
TEST(ObjectSymmetries, DependOnTheTolerance) {
  const TurningShape plate = boxShape("plate", {1.0, 0.96, 0.4}, RotationGroupKind::Dihedral, 2);
  EXPECT_EQ(groupOf(plate, 3000, 1, [](auto& o) { o.tolerance = 0.02; }), "D4");
  EXPECT_EQ(groupOf(plate, 3000, 1, [](auto& o) { o.absolute_tolerance = 0.058; }), "D4");
  ObjectSymmetryOptions options;
  options.other_tolerances = true;
  const ObjectSymmetries found = objectSymmetries(plate.sampled(5000, 1).cloud(), options);
  EXPECT_EQ(found.name(), "D2");
  ASSERT_TRUE(found.at_half_tolerance && found.at_twice_tolerance);
  EXPECT_EQ(found.at_half_tolerance->name(), "D2");
  EXPECT_EQ(found.at_twice_tolerance->name(), "D4");
  EXPECT_NEAR(found.tolerance, 0.01 * 2.0 * std::sqrt(1.0 + 0.96 * 0.96 + 0.16), 0.0005);
}

/// The handle is what a rotation about the axis of a cup maps off its surface.
TEST(ObjectSymmetries, SayWhatFailedAndWhere) {
  const TurningShape cup = cupShape(true);
  const ObjectSymmetries found = objectSymmetries(cup.sampled(5000, 1).cloud());
  ASSERT_EQ(found.name(), "C1");
  ASSERT_FALSE(found.rejected.empty());
  const RejectedRotation& first = found.rejected.front();
  EXPECT_GT(std::abs(first.axis.z()), 0.99);
  EXPECT_GT(first.off, 0.02);
  EXPECT_LT(first.off, 0.2);
  EXPECT_GT(first.far, 0.0125);
  EXPECT_GT(first.where.x(), 0.7) << "the handle is at x = 0.7 to 1.2";
}

TEST(ObjectSymmetries, DoNotNeedEvenSampling) {
  for (const TurningShape& shape : {boxShape(), cylinderShape(), propellerShape(3, true)}) {
    SCOPED_TRACE(shape.name);
    const Points all = moved(shape.sampled(8000, 1), randomPose(4)).cloud();
    RandomStream random(6);
    const Points uneven = pointsWhere(all, [&](const Eigen::Vector3f& x) {
      return x.x() > randomPose(4).translation().x() || random.uniform() < 0.4;
    });
    EXPECT_EQ(objectSymmetries(uneven).name(), shape.group);
  }
}

TEST(ObjectSymmetries, CopiesOfPointsChangeNothing) {
  const Points cloud = boxShape().sampled(2000, 1).cloud();
  EXPECT_EQ(objectSymmetries(cloud.replicate(1, 5)).name(), "D2");
}

TEST(ObjectSymmetries, OfAFlatSheetTurnItOver) {
  EXPECT_EQ(groupOf(sheetShape(1.0, 0.6), 3000, 1), "D2");
  EXPECT_EQ(groupOf(sheetShape(1.0, 1.0), 3000, 1), "D4");
}

TEST(ObjectSymmetries, AreTheSameForAnyNumberOfThreads) {
  for (const TurningShape& shape : {prismShape(3, 0.8), cylinderShape()}) {
    const Points cloud = moved(shape.sampled(1500, 1), randomPose(1)).cloud();
    compareThreads([&](int num_threads) {
      ObjectSymmetryOptions options;  // coarse: sanitizers make it slow
      options.num_cells = 32;
      options.num_directions = 1000;
      options.num_threads = num_threads;
      const ObjectSymmetries found = objectSymmetries(cloud, options);
      return std::make_tuple(found.name(), found.confidence, matricesOf(found.discrete),
                             valuesOf(found.continuous, &ContinuousSymmetry::axis, &ContinuousSymmetry::offset));
    });
  }
}

TEST(ObjectSymmetries, RefuseWhatShowsNoSurface) {
  EXPECT_THROW(objectSymmetries(Points(3, 0)), std::invalid_argument);
  EXPECT_THROW(objectSymmetries(Points::Ones(3, 1)), std::invalid_argument);
  EXPECT_THROW(objectSymmetries(Points::Ones(3, 500)), std::invalid_argument);
  EXPECT_THROW(objectSymmetries(Points::Random(3, 19)), std::invalid_argument);
  const Points line = Eigen::Vector3f(1.0f, -2.0f, 0.5f) * Eigen::RowVectorXf::LinSpaced(500, 0.0f, 1.0f);
  EXPECT_THROW(objectSymmetries(line), std::invalid_argument);
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Points points = Points::Random(3, 100);
    points(1, 50) = bad;
    EXPECT_THROW(objectSymmetries(points), std::invalid_argument);
  }
}

TEST(ObjectSymmetries, StandExtremeUnits) {
  for (const double scale : {1e-12, 1e12})
    EXPECT_EQ(objectSymmetries(scaled(boxShape().sampled(2000, 1), scale).cloud()).name(), "D2") << scale;
}

TEST(ObjectSymmetries, OptionsNameFieldValueAndRule) {
  const auto message = [](const auto& change) {
    ObjectSymmetryOptions options;
    change(options);
    return complaintOf<std::invalid_argument>([&] { options.validate(); });
  };
  using Options = ObjectSymmetryOptions;
  EXPECT_NO_THROW(Options().validate());
  EXPECT_EQ(message([](Options& o) { o.max_feature = 2.0; }), "max_feature = 2, must be in [0, 1]");
  EXPECT_EQ(message([](Options& o) { o.tolerance = 0.0; }), "tolerance = 0, must be in (0, 0.1]");
}

using Poses = std::vector<Eigen::Isometry3d>;

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
    all.push_back(placedGroupOf(kind, fold, randomPose(random)));
  }
  return all;
}

/// A symmetry of the group, drawn at random.
Eigen::Isometry3d symmetryFrom(const ObjectSymmetries& group, RandomStream& random) {
  if (group.continuous.size() > 1)
    return rotationAboutPoint(randomDirection(random), 6.0 * random.uniform(), group.center);
  const std::size_t k = random.below(group.discrete.size() + 1);
  const Eigen::Isometry3d element = k == 0 ? Eigen::Isometry3d::Identity() : group.discrete[k - 1];
  if (group.continuous.empty()) return element;
  return element * rotationAboutPoint(group.continuous[0].axis, 2.0 * kPi * random.uniform(), group.center);
}

double angleApart(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return angleOf(a.linear().transpose() * b.linear());
}

double apart(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

/// The greatest distance of points in two poses.
double greatestOffset(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, const Points& points) {
  const Eigen::Matrix3Xd x = points.cast<double>();
  return (a * x - b * x).colwise().norm().maxCoeff();
}

TEST(PoseSymmetry, EquivalentsAreThePoseTimesEachSymmetry) {
  RandomStream random(1);
  for (const ObjectSymmetries& group : groups()) {
    SCOPED_TRACE(group.name());
    const Eigen::Isometry3d T = randomPose(random);
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
      const Eigen::Isometry3d T = randomPose(random), previous = randomPose(random);
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
    for (int k = 0; k < 6; ++k) poses.push_back(randomPose(random));
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
      const Eigen::Isometry3d a = randomPose(random), b = randomPose(random), c = randomPose(random);
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
  const Points points = Points::Random(3, 200);
  for (const ObjectSymmetries& group : groups()) {
    if (group.kind == RotationGroupKind::Spherical) continue;
    SCOPED_TRACE(group.name());
    for (int k = 0; k < 4; ++k) {
      const Eigen::Isometry3d a = randomPose(random);
      const Eigen::Isometry3d b =
          k < 2 ? randomPose(random) : a * rotationAboutPoint({1, 2, 3}, 0.05, {1, 0, 1}) * symmetryFrom(group, random);
      constexpr double kStep = 0.002;
      double least = 1e9;
      for (const Eigen::Isometry3d& other : group.equivalents(b, kStep))
        least = std::min(least, greatestOffset(a, other, points));
      const double farthest_arm = (points.cast<double>().colwise() - group.center).colwise().norm().maxCoeff();
      const double found = group.surfaceDistance(a, b, points);
      EXPECT_LE(found, least + 1e-9);
      EXPECT_LE(least, found + (group.continuous.empty() ? 1e-9 : 0.5 * kStep * farthest_arm));
      EXPECT_NEAR(group.surfaceDistance(a, b * symmetryFrom(group, random), points), found, 1e-6);
    }
    const Eigen::Isometry3d T = randomPose(random);
    EXPECT_LT(group.surfaceDistance(T, T * symmetryFrom(group, random), points), 1e-6);
  }
}

/// Points of a ball that come in opposite pairs: whatever the rotation, one of a pair is at least as far as the center.
TEST(PoseSymmetry, SurfaceDistanceOfASphereIsThatOfItsCenters) {
  RandomStream random(6);
  const ObjectSymmetries sphere = placedGroupOf(RotationGroupKind::Spherical, 0, randomPose(random));
  Points points(3, 400);
  for (Eigen::Index i = 0; i < points.cols(); i += 2) {
    const Eigen::Vector3d out = randomDirection(random);
    points.col(i) = (sphere.center + 0.7 * out).cast<float>();
    points.col(i + 1) = (sphere.center - 0.7 * out).cast<float>();
  }
  const Eigen::Isometry3d a = randomPose(random), b = randomPose(random);
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
    const Points points = Points::Random(3, 20);
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
  const auto about = [&](const Eigen::Vector3d& axis, double angle) { return rotationAboutPoint(axis, angle, center); };
  EXPECT_EQ(ObjectSymmetries::from({about(z, 0.5 * kPi), about(x, 0.5 * kPi)}, {}).name(), "O");
  EXPECT_EQ(ObjectSymmetries::from({about(x, kPi)}, {{2.0 * z, center}}).name(), "Dinf");
  EXPECT_EQ(ObjectSymmetries::from({about(z, 1.0)}, {{z, center}}).name(), "Cinf");
  EXPECT_EQ(ObjectSymmetries::from({about(x, 1.0)}, {{z, center}}).name(), "SO3");
  EXPECT_EQ(ObjectSymmetries::from({}, {{z, center}, {x, center}}).name(), "SO3");
  EXPECT_THROW(ObjectSymmetries::from({about(z, 1.0)}, {}), std::invalid_argument) << "never comes round";
  EXPECT_THROW(ObjectSymmetries::from({}, {{Eigen::Vector3d::Zero(), center}}), std::invalid_argument);
  EXPECT_THROW(ObjectSymmetries::from({}, {{z, center}, {x, Eigen::Vector3d(1, 20, 30)}}), std::invalid_argument)
      << "axes that do not meet";
  Eigen::Isometry3d screw = rotationAboutPoint(z, kPi, center);
  screw.translation() += z;
  EXPECT_THROW(ObjectSymmetries::from({screw}, {}), std::invalid_argument);
}

TEST(TiltsCovering, ReachEveryRotationWithinTheAngle) {
  RandomStream random(12);
  const Eigen::Vector3d axis = randomDirection(random);
  for (const double degrees : {180.0, 90.0, 60.0, 30.0, 15.0, 5.0}) {
    const double angle = degrees * kDegree;
    const std::vector<Eigen::Matrix3d> tilts = tiltsCovering(axis, angle);
    EXPECT_TRUE(tilts[0].isIdentity(1e-12));
    EXPECT_LE(static_cast<double>(tilts.size()), 2.0 + 8.0 / (angle * angle)) << degrees;
    double farthest = 0.0;
    for (int k = 0; k < 5000; ++k) {
      // R = C D H: H takes R^-1 a to D^-1 a.
      const Eigen::Vector3d direction = randomDirection(random);
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
