/// The finite groups of rotations: their orders, generators and axes are those of the textbooks.
#include "pcl_symmetry/core/rotation_group.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace pcl_symmetry;
using Kind = RotationGroupKind;
using Matrices = std::vector<Eigen::Matrix3d>;

constexpr double kSame = 1e-9;

bool holds(const Matrices& elements, const Eigen::Matrix3d& rotation) {
  return std::any_of(elements.begin(), elements.end(),
                     [&](const Eigen::Matrix3d& element) { return (element - rotation).norm() < kSame; });
}

struct Expected {
  RotationGroup group;
  std::size_t size;
  std::string name;
};

std::vector<Expected> finiteGroups() {
  std::vector<Expected> groups{
      {{Kind::Tetrahedral, 3}, 12, "T"}, {{Kind::Octahedral, 4}, 24, "O"}, {{Kind::Icosahedral, 5}, 60, "I"}};
  for (const int n : {1, 2, 3, 5, 7, 12, 24}) {
    groups.push_back({{Kind::Cyclic, n}, static_cast<std::size_t>(n), "C" + std::to_string(n)});
    groups.push_back({{Kind::Dihedral, n}, static_cast<std::size_t>(2 * n), "D" + std::to_string(n)});
  }
  return groups;
}

TEST(RotationGroup, ElementsAreRotationsClosedUnderProductsAndInverses) {
  for (const auto& [group, size, name] : finiteGroups()) {
    SCOPED_TRACE(name);
    EXPECT_EQ(nameOf(group.kind, group.fold), name);
    const Matrices elements = group.elements();
    ASSERT_EQ(elements.size(), size);
    EXPECT_LE(group.generators().size(), 2u);
    EXPECT_TRUE(elements.front().isIdentity());
    for (std::size_t i = 0; i < size; ++i) {
      EXPECT_NEAR(elements[i].determinant(), 1.0, kSame);
      EXPECT_LT((elements[i] * elements[i].transpose() - Eigen::Matrix3d::Identity()).norm(), kSame);
      EXPECT_TRUE(holds(elements, elements[i].transpose()));
      for (const Eigen::Matrix3d& other : elements) EXPECT_TRUE(holds(elements, elements[i] * other));
      for (std::size_t j = 0; j < i; ++j) EXPECT_GT((elements[i] - elements[j]).norm(), 0.1) << "each once";
    }
  }
}

TEST(RotationGroup, HasTheAxesOfItsSolid) {
  const auto orders = [](Kind kind, int fold) {
    std::map<int, int> count;
    for (const RotationAxis& axis : axesOf(RotationGroup{kind, fold}.elements())) {
      ++count[axis.order];
      EXPECT_NEAR(axis.direction.norm(), 1.0, kSame);
      EXPECT_EQ(axis.direction, signedDirection(axis.direction));
    }
    return count;
  };
  using Orders = std::map<int, int>;
  EXPECT_EQ(orders(Kind::Tetrahedral, 3), (Orders{{2, 3}, {3, 4}}));
  EXPECT_EQ(orders(Kind::Octahedral, 4), (Orders{{2, 6}, {3, 4}, {4, 3}}));
  EXPECT_EQ(orders(Kind::Icosahedral, 5), (Orders{{2, 15}, {3, 10}, {5, 6}}));
  EXPECT_EQ(orders(Kind::Dihedral, 6), (Orders{{2, 6}, {6, 1}}));
  EXPECT_EQ(orders(Kind::Cyclic, 7), (Orders{{7, 1}}));
  EXPECT_EQ(orders(Kind::Cyclic, 1), Orders{});
}

TEST(RotationGroup, StandsInItsFrame) {
  const auto hasAxis = [](const RotationGroup& group, const Eigen::Vector3d& direction, int order) {
    const std::vector<RotationAxis> axes = axesOf(group.elements());
    return std::any_of(axes.begin(), axes.end(), [&](const RotationAxis& axis) {
      return axis.order == order && (axis.direction - direction).norm() < kSame;
    });
  };
  for (int k = 0; k < 3; ++k) {
    EXPECT_TRUE(hasAxis({Kind::Tetrahedral, 3}, Eigen::Vector3d::Unit(k), 2));
    EXPECT_TRUE(hasAxis({Kind::Octahedral, 4}, Eigen::Vector3d::Unit(k), 4));
    EXPECT_TRUE(hasAxis({Kind::Icosahedral, 5}, Eigen::Vector3d::Unit(k), 2));
  }
  EXPECT_TRUE(hasAxis({Kind::Cyclic, 5}, Eigen::Vector3d::UnitZ(), 5));
  EXPECT_TRUE(hasAxis({Kind::Dihedral, 5}, Eigen::Vector3d::UnitZ(), 5));
  EXPECT_TRUE(hasAxis({Kind::Dihedral, 5}, Eigen::Vector3d::UnitX(), 2));
}

TEST(RotationGroup, RefusesContinuousGroupsAndNoFold) {
  for (const Kind kind : {Kind::Revolution, Kind::Cylindrical, Kind::Spherical}) {
    EXPECT_TRUE(isContinuous(kind));
    EXPECT_THROW((RotationGroup{kind, 1}.elements()), std::invalid_argument);
    EXPECT_THROW((RotationGroup{kind, 1}.generators()), std::invalid_argument);
  }
  EXPECT_FALSE(isContinuous(Kind::Icosahedral));
  EXPECT_THROW((RotationGroup{Kind::Cyclic, 0}.elements()), std::invalid_argument);
  EXPECT_EQ(nameOf(Kind::Revolution, 0), "Cinf");
  EXPECT_EQ(nameOf(Kind::Cylindrical, 0), "Dinf");
  EXPECT_EQ(nameOf(Kind::Spherical, 0), "SO3");
}

TEST(RotationAbout, FollowsTheRightHandRule) {
  const double quarter = std::acos(0.0);
  EXPECT_LT(
      (rotationAbout(Eigen::Vector3d::UnitZ(), quarter) * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(),
      kSame);
}

TEST(SignedDirection, IsOneOfTwo) {
  const Eigen::Vector3d direction(0.3, -0.9, 0.1);
  EXPECT_EQ(signedDirection(direction), -direction);
  EXPECT_EQ(signedDirection(-direction), -direction);
}

}  // namespace
