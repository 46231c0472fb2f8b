#include "evaluate/references/reference_symmetries.h"

#include <stdexcept>
#include <string>

#include "core/neighbours/diameter.h"
#include "evaluate/references/reference_search.h"

namespace pcl_symmetry::apps {

namespace {

template <typename Map>
void mapAll(ReferenceSymmetries& symmetries, const Map& map) {
  for (auto* planes : {&symmetries.planes, &symmetries.near_planes})
    for (ReferencePlane& plane : *planes) plane.plane = map.plane(plane.plane);
  for (auto* axes : {&symmetries.axes, &symmetries.near_axes}) {
    for (ReferenceAxis& axis : *axes) {
      axis.point = map.point(axis.point);
      axis.direction = map.direction(axis.direction);
    }
  }
  for (ReferenceCenter& center : symmetries.centers) center.point = map.point(center.point);
  symmetries.center = map.point(symmetries.center);
}

struct RigidMap {
  const Eigen::Isometry3d& motion;
  ReflectionPlane plane(const ReflectionPlane& p) const { return p.transformed(motion).canonical(); }
  Eigen::Vector3d point(const Eigen::Vector3d& p) const { return motion * p; }
  Eigen::Vector3d direction(const Eigen::Vector3d& d) const { return motion.linear() * d; }
};

/// Moves and enlarges: from the frame of the scene to that of its mesh, for one.
struct Enlargement {
  Eigen::Vector3d center;  ///< where the origin comes to lie
  double factor;
  ReflectionPlane plane(const ReflectionPlane& p) const {
    return ReflectionPlane(p.normal(), factor * p.offset() + p.normal().dot(center)).canonical();
  }
  Eigen::Vector3d point(const Eigen::Vector3d& p) const { return center + factor * p; }
  Eigen::Vector3d direction(const Eigen::Vector3d& d) const { return d; }
};

/// \return the diameter of all triangles, in diagonals.
double diameterOf(const TriangleScene& scene) {
  const std::vector<Triangle>& triangles = scene.triangles();
  Points corners(3, 3 * static_cast<Eigen::Index>(triangles.size()));
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    corners.middleCols<3>(3 * static_cast<Eigen::Index>(i)) << t.a.cast<float>(), t.b.cast<float>(), t.c.cast<float>();
  }
  return diameter(corners);
}

[[noreturn]] void reject(const char* field, double value, const char* rule) {
  throw std::invalid_argument(std::string(field) + " = " + std::to_string(value) + ", " + rule);
}

}  // namespace

void ReferenceOptions::validate() const {
  if (!(tolerance > 0.0 && tolerance < 1.0)) reject("tolerance", tolerance, "must be > 0 and < 1");
  if (!(min_share > 0.0 && min_share <= 1.0)) reject("min_share", min_share, "must be > 0 and <= 1");
  if (!(near_share > 0.0 && near_share <= min_share)) reject("near_share", near_share, "must be > 0 and <= min_share");
  if (!(merge_angle >= 0.0)) reject("merge_angle", merge_angle, "must be >= 0");
  if (!(merge_offset >= 0.0)) reject("merge_offset", merge_offset, "must be >= 0");
  if (num_samples < 1000) reject("num_samples", num_samples, "must be >= 1000");
}

const char* toString(SymmetryKind kind) {
  switch (kind) {
    case SymmetryKind::Symmetric:
      return "symmetric";
    case SymmetryKind::NearlySymmetric:
      return "nearly symmetric";
    default:
      return "asymmetric";
  }
}

ReferenceSymmetries ReferenceSymmetries::transformed(const Eigen::Isometry3d& motion) const {
  ReferenceSymmetries moved = *this;
  mapAll(moved, RigidMap{motion});
  return moved;
}

ReferenceSymmetries ReferenceSymmetries::scaled(const Eigen::Vector3d& origin, double factor) const {
  ReferenceSymmetries larger = *this;
  mapAll(larger, Enlargement{-factor * origin, factor});
  for (double* length : {&larger.diagonal, &larger.diameter, &larger.tolerance}) *length *= factor;
  return larger;
}

ReferenceSymmetries findReferenceSymmetries(const pcl::PolygonMesh& mesh, const ReferenceOptions& options) {
  options.validate();
  const TriangleScene scene(mesh);
  const double diameter = diameterOf(scene);
  ReferenceOptions in_diagonals = options;
  in_diagonals.tolerance_in_diagonals = true;
  if (!options.tolerance_in_diagonals) in_diagonals.tolerance *= diameter;
  ReferenceSymmetries symmetries = searchReferences(scene, in_diagonals);
  mapAll(symmetries, Enlargement{scene.center(), scene.diagonal()});
  symmetries.diagonal = scene.diagonal();
  symmetries.diameter = scene.diagonal() * diameter;
  symmetries.tolerance = scene.diagonal() * in_diagonals.tolerance;
  return symmetries;
}

}  // namespace pcl_symmetry::apps
