/// Synthetic shapes with a known group of rotations, sampled evenly by area.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "core/geometry/triangles.h"
#include "pcl_symmetry/core/rotation_group.h"
#include "shapes/shapes.h"

namespace pcl_symmetry::test {

/// A body of triangles about the origin, with the rotations that map it onto itself.
struct TurningShape {
  std::string name;
  std::string group;                       ///< name of the group, as from nameOf()
  std::vector<Eigen::Matrix3d> rotations;  ///< all but the identity; empty for continuous groups
  Eigen::Vector3d axis{0.0, 0.0, 1.0};     ///< axis of revolution
  std::vector<Eigen::Vector3d> vertices = {};
  std::vector<Eigen::Vector3i> triangles = {};

  friend std::ostream& operator<<(std::ostream& out, const TurningShape& shape) { return out << shape.name; }

  Eigen::Map<const Eigen::Matrix3Xd> corners() const {
    return {vertices[0].data(), 3, static_cast<Eigen::Index>(vertices.size())};
  }
  void addFace(const std::vector<Eigen::Vector3d>& corners) {
    const int first = static_cast<int>(vertices.size());
    vertices.insert(vertices.end(), corners.begin(), corners.end());
    for (int k = 2; k < static_cast<int>(corners.size()); ++k) triangles.emplace_back(first, first + k - 1, first + k);
  }

  /// A box with its center and axes at \p pose.
  void addBox(const Eigen::Vector3d& half, const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity()) {
    for (const auto& quad : kBoxQuads) {
      std::vector<Eigen::Vector3d> corners;
      for (const int k : quad)
        corners.push_back(pose * half.cwiseProduct(Eigen::Vector3d(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1)));
      addFace(corners);
    }
  }

  /// A profile (radius, height) turned about z in \p num_sides steps.
  void addLathe(const std::vector<Eigen::Vector2d>& profile, int num_sides) {
    const auto at = [&](const Eigen::Vector2d& p, int k) {
      const double angle = 2.0 * kPi * k / num_sides;
      return Eigen::Vector3d(p[0] * std::cos(angle), p[0] * std::sin(angle), p[1]);
    };
    for (std::size_t i = 1; i < profile.size(); ++i)
      for (int k = 0; k < num_sides; ++k)
        addFace({at(profile[i - 1], k), at(profile[i - 1], k + 1), at(profile[i], k + 1), at(profile[i], k)});
  }

  /// \param noise standard deviation of each coordinate.
  Shape sampled(int num_points, std::uint64_t seed, double noise = 0.0) const {
    return noisy({sampleTriangles(corners().cast<float>(), triangles, num_points, seed).cast<double>(), {}}, noise,
                 seed);
  }
};

inline TurningShape turningShape(const std::string& name, RotationGroupKind kind, int fold = 0) {
  TurningShape shape{name, nameOf(kind, fold), {}};
  if (isContinuous(kind)) return shape;
  shape.rotations = RotationGroup{kind, fold}.elements();
  shape.rotations.erase(shape.rotations.begin());
  return shape;
}

/// A box along the axes.
inline TurningShape boxShape(const std::string& name, const Eigen::Vector3d& half, RotationGroupKind kind, int fold) {
  TurningShape shape = turningShape(name, kind, fold);
  shape.addBox(half);
  return shape;
}

inline TurningShape boxShape() {
  return boxShape("box", {1.0, 0.7, 0.45}, RotationGroupKind::Dihedral, 2);
}

/// A rectangle in z = 0.
inline TurningShape sheetShape(double half_width, double half_height) {
  TurningShape shape = turningShape("sheet", RotationGroupKind::Dihedral, 2);
  shape.addFace({{-half_width, -half_height, 0.0},
                 {half_width, -half_height, 0.0},
                 {half_width, half_height, 0.0},
                 {-half_width, half_height, 0.0}});
  return shape;
}

/// A regular n-gon of circumradius 1 swept along z, one corner on x.
inline TurningShape prismShape(int n, double half_height) {
  TurningShape shape = turningShape("prism of " + std::to_string(n) + " sides", RotationGroupKind::Dihedral, n);
  shape.addLathe({{0.0, -half_height}, {1.0, -half_height}, {1.0, half_height}, {0.0, half_height}}, n);
  return shape;
}

inline TurningShape cylinderShape() {
  TurningShape shape = turningShape("cylinder", RotationGroupKind::Cylindrical);
  shape.addLathe({{0.0, -1.0}, {0.6, -1.0}, {0.6, 1.0}, {0.0, 1.0}}, 128);
  return shape;
}

inline TurningShape coneShape() {
  TurningShape shape = turningShape("cone", RotationGroupKind::Revolution);
  shape.addLathe({{0.0, -0.5}, {0.8, -0.5}, {0.0, 1.0}}, 128);
  return shape;
}

/// A cup with walls of no thickness, open at the top.
inline TurningShape cupShape(bool handle) {
  TurningShape shape = handle ? turningShape("cup with a handle", RotationGroupKind::Cyclic, 1)
                              : turningShape("cup", RotationGroupKind::Revolution);
  shape.addLathe({{0.0, 0.0}, {0.7, 0.0}, {0.75, 1.6}}, 96);
  if (!handle) return shape;
  constexpr int kSteps = 16, kAround = 8;
  const auto at = [](int step, int around) {
    const double along = kPi * step / kSteps - 0.5 * kPi, angle = 2.0 * kPi * around / kAround;
    const double r = 0.45 + 0.08 * std::cos(angle);
    return Eigen::Vector3d(0.7 + r * std::cos(along), 0.08 * std::sin(angle), 0.8 + r * std::sin(along));
  };
  for (int i = 0; i < kSteps; ++i)
    for (int k = 0; k < kAround; ++k) shape.addFace({at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)});
  return shape;
}

/// Two plates at a right angle, and a rib beside their middle.
inline TurningShape bracketShape() {
  TurningShape shape = turningShape("bracket", RotationGroupKind::Cyclic, 1);
  const auto place = [](double x, double y, double z) { return Eigen::Isometry3d(Eigen::Translation3d(x, y, z)); };
  shape.addBox({1.0, 0.7, 0.1}, place(0.0, 0.0, 0.0));
  shape.addBox({0.1, 0.7, 0.6}, place(-0.9, 0.0, 0.7));
  shape.addBox({0.4, 0.1, 0.3}, place(-0.4, 0.35, 0.4));
  return shape;
}

/// A regular tetrahedron whose axes of order 2 are x, y and z.
inline TurningShape tetrahedronShape() {
  TurningShape shape = turningShape("tetrahedron", RotationGroupKind::Tetrahedral, 3);
  const std::vector<Eigen::Vector3d> corners{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  for (int k = 0; k < 4; ++k) shape.addFace({corners[k], corners[(k + 1) % 4], corners[(k + 2) % 4]});
  return shape;
}

inline TurningShape icosahedronShape() {
  TurningShape shape = turningShape("icosahedron", RotationGroupKind::Icosahedral, 5);
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  std::vector<Eigen::Vector3d> corners;
  for (int k = 0; k < 3; ++k)
    for (const double a : {-1.0, 1.0})
      for (const double b : {-g, g}) {
        Eigen::Vector3d corner = Eigen::Vector3d::Zero();
        corner[(k + 1) % 3] = a;
        corner[(k + 2) % 3] = b;
        corners.push_back(corner);
      }
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (std::size_t k = 0; k < j; ++k)
        if ((corners[i] - corners[j]).norm() < 2.1 && (corners[j] - corners[k]).norm() < 2.1 &&
            (corners[k] - corners[i]).norm() < 2.1)
          shape.addFace({corners[i], corners[j], corners[k]});
  return shape;
}

inline TurningShape ballShape() {
  TurningShape shape = turningShape("sphere", RotationGroupKind::Spherical);
  std::vector<Eigen::Vector2d> profile;
  for (int k = 0; k <= 48; ++k) profile.emplace_back(std::sin(kPi * k / 48), -std::cos(kPi * k / 48));
  shape.addLathe(profile, 96);
  return shape;
}

/// Blades at 35 degrees to the plane in which they turn. Half turns about the lengths of the blades map them onto
/// themselves; a hub on one side removes these symmetries.
inline TurningShape propellerShape(int num_blades, bool hub) {
  TurningShape shape = turningShape(std::to_string(num_blades) + (hub ? " blades on a hub" : " blades"),
                                    hub ? RotationGroupKind::Cyclic : RotationGroupKind::Dihedral, num_blades);
  for (int k = 0; k < num_blades; ++k)
    shape.addBox({0.45, 0.2, 0.03}, Eigen::AngleAxisd(2.0 * kPi * k / num_blades, Eigen::Vector3d::UnitZ()) *
                                        Eigen::Translation3d(0.55, 0.0, 0.0) *
                                        Eigen::Isometry3d(Eigen::AngleAxisd(35.0 * kDegree, Eigen::Vector3d::UnitX())));
  if (hub) shape.addLathe({{0.0, -0.1}, {0.15, -0.1}, {0.15, 0.5}, {0.0, 0.5}}, 96);
  return shape;
}

inline std::vector<TurningShape> turningShapes() {
  using Kind = RotationGroupKind;
  return {boxShape(),
          boxShape("square prism", {0.6, 0.6, 1.0}, Kind::Dihedral, 4),
          boxShape("square plate", {1.0, 1.0, 0.15}, Kind::Dihedral, 4),
          boxShape("cube", {1.0, 1.0, 1.0}, Kind::Octahedral, 4),
          prismShape(3, 0.8),
          prismShape(5, 0.5),
          prismShape(6, 0.8),
          prismShape(8, 1.2),
          cylinderShape(),
          coneShape(),
          cupShape(false),
          cupShape(true),
          bracketShape(),
          tetrahedronShape(),
          icosahedronShape(),
          ballShape(),
          propellerShape(2, false),
          propellerShape(2, true),
          propellerShape(3, false),
          propellerShape(3, true),
          propellerShape(4, true),
          propellerShape(5, true)};
}

}  // namespace pcl_symmetry::test
