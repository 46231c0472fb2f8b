#include "evaluate/rotations/solid_builder.h"

#include <algorithm>
#include <cmath>

#include "core/base/constants.h"

namespace pcl_symmetry::apps {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kAround = 144;  // sides of a body of revolution. derived: divides by 2, 3, 4, 6, 8; sagitta 2.4e-4 radii
constexpr double kFlat = 1e-9;  // derived: far above rounding of coordinates about 1

}  // namespace

SolidBuilder& SolidBuilder::face(const std::vector<Vector3d>& corners) {
  const int first = static_cast<int>(solid_.vertices.size());
  solid_.vertices.insert(solid_.vertices.end(), corners.begin(), corners.end());
  for (int k = 2; k < static_cast<int>(corners.size()); ++k)
    solid_.triangles.emplace_back(first, first + k - 1, first + k);
  return *this;
}

SolidBuilder& SolidBuilder::box(const Vector3d& center, const Vector3d& half, const Eigen::Matrix3d& turn) {
  // derived: the faces of a box, by the bits of its corners.
  constexpr int kQuads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& quad : kQuads) {
    std::vector<Vector3d> corners;
    for (const int k : quad)
      corners.push_back(turn * (center + half.cwiseProduct(Vector3d(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1))));
    face(corners);
  }
  return *this;
}

SolidBuilder& SolidBuilder::turned(const Outline& profile) {
  const auto at = [](const Vector2d& p, int k) {
    const double angle = 2.0 * kPi * k / kAround;
    return Vector3d(p.x() * std::cos(angle), p.x() * std::sin(angle), p.y());
  };
  for (std::size_t i = 1; i < profile.size(); ++i)
    for (int k = 0; k < kAround; ++k)
      face({at(profile[i - 1], k), at(profile[i - 1], k + 1), at(profile[i], k + 1), at(profile[i], k)});
  return *this;
}

SolidBuilder& SolidBuilder::swept(const Outline& outline, double low, double high, double bore) {
  const auto at = [](const Vector2d& p, double z) { return Vector3d(p.x(), p.y(), z); };
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector2d a = outline[i], b = outline[(i + 1) % outline.size()];
    const Vector2d inner_a = bore * a.normalized(), inner_b = bore * b.normalized();
    face({at(a, low), at(b, low), at(b, high), at(a, high)});
    for (const double z : {low, high}) face({at(inner_a, z), at(a, z), at(b, z), at(inner_b, z)});
    if (bore > 0.0) face({at(inner_a, low), at(inner_b, low), at(inner_b, high), at(inner_a, high)});
  }
  return *this;
}

SolidBuilder& SolidBuilder::hull(const std::vector<Vector3d>& corners) {
  std::vector<Vector3d> normals;
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      for (std::size_t k = j + 1; k < n; ++k) {
        Vector3d normal = (corners[j] - corners[i]).cross(corners[k] - corners[i]);
        if (normal.norm() < kFlat) continue;
        normal.normalize();
        if (normal.dot(corners[i]) < 0.0) normal = -normal;
        const double height = normal.dot(corners[i]);
        const auto outside = [&](const Vector3d& c) { return normal.dot(c) > height + kFlat; };
        const auto same = [&](const Vector3d& other) { return (other - normal).norm() < 1e3 * kFlat; };
        if (std::any_of(corners.begin(), corners.end(), outside)) continue;
        if (std::any_of(normals.begin(), normals.end(), same)) continue;
        normals.push_back(normal);
        std::vector<Vector3d> polygon;
        std::copy_if(corners.begin(), corners.end(), std::back_inserter(polygon),
                     [&](const Vector3d& c) { return normal.dot(c) > height - kFlat; });
        const Vector3d u = (polygon[0] - height * normal).normalized(), v = normal.cross(u);
        std::sort(polygon.begin(), polygon.end(), [&](const Vector3d& a, const Vector3d& b) {
          return std::atan2(v.dot(a), u.dot(a)) < std::atan2(v.dot(b), u.dot(b));
        });
        face(polygon);
      }
  return *this;
}

SolidBuilder& SolidBuilder::handle(const Vector3d& foot, double reach, double rise, double thickness, double turn) {
  constexpr int kAlong = 24, kRound = 12;  // chosen: half shows corners, twice only adds faces
  const Eigen::Matrix3d frame = Eigen::AngleAxisd(turn, Vector3d::UnitZ()).toRotationMatrix();
  const auto at = [&](int i, int k) -> Vector3d {
    const double angle = kPi * (static_cast<double>(i) / kAlong - 0.5), round = 2.0 * kPi * k / kRound;
    const Vector3d out(std::cos(angle), 0.0, std::sin(angle));
    const Vector3d middle = foot + Vector3d(reach * out.x(), 0.0, rise * out.z());
    return frame * (middle + thickness * (std::cos(round) * out + std::sin(round) * Vector3d::UnitY()));
  };
  for (int i = 0; i < kAlong; ++i)
    for (int k = 0; k < kRound; ++k) face({at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)});
  return *this;
}

SolidBuilder& SolidBuilder::bent(const std::function<Vector3d(const Vector3d&)>& move) {
  for (Vector3d& vertex : solid_.vertices) vertex = move(vertex);
  return *this;
}

}  // namespace pcl_symmetry::apps
