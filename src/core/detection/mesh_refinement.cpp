/// Planes, axes and centers of a cloud, refined on the mesh that the points were spread over.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/lists.h"
#include "core/detection/plane_decision.h"
#include "core/geometry/geometry_rules.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/mesh_surface.h"

namespace pcl_symmetry {

namespace {

/// The probability that at least 97 % of the surface is within the tolerance.
/// \param share share of the samples within the tolerance.
double confidenceOf(double share, int num_samples) {
  constexpr double kLeast = 0.003;  // confidences lie in [kLeast, 1 - kLeast]
  const double deviation = std::sqrt(kSymmetricShare * (1.0 - kSymmetricShare) / num_samples);
  const double confidence = 0.5 * std::erfc(-(share - kSymmetricShare) / deviation / std::sqrt(2.0));
  return std::clamp(confidence, kLeast, 1.0 - kLeast);
}

double errorOf(double share, int num_samples) {
  return std::sqrt(share * (1.0 - share) / num_samples) + 1.0 / num_samples;
}

/// Missing or added material biases the fit: a plane whose fit is clearly worse stays unchanged.
void refine(const MeshSurface& mesh, SymmetryPlane& plane, double tolerance, const DetectionOptions& options) {
  const ReflectionPlane fitted = mesh.fitted(static_cast<const ReflectionPlane&>(plane)).canonical();
  const MeshShares before = mesh.shares(plane, tolerance), after = mesh.shares(fitted, tolerance);
  const bool is_worse = after.share < before.share - errorOf(before.share, mesh.numSamples());
  if (!is_worse) static_cast<ReflectionPlane&>(plane) = fitted;
  const MeshShares& shares = is_worse ? before : after;
  plane.share = shares.share;
  const double error = errorOf(shares.share, mesh.numSamples());
  plane.share_low = std::max(0.0, shares.share - 2.0 * error);
  plane.share_high = std::min(1.0, shares.share + 2.0 * error);
  plane.deviation = shares.deviation;
  plane.residual = shares.residual;
  // The mesh shows the whole surface: its share replaces the evidence of points and its uncertainty.
  setConfidence(plane, confidenceOf(shares.share, mesh.numSamples()), "how much of the mesh the plane maps onto it",
                options);
}

}  // namespace

void refineOnMesh(const MeshSurface& mesh, Detection& found, const DetectionOptions& options) {
  // Planes closer than this are one after the refinement; the planes of 120 teeth are 0.026 apart.
  constexpr double kSameOnMesh = 0.01;
  const auto inBall = [&](const ReflectionPlane& plane) {
    return plane.normalized(mesh.ball().center, mesh.ball().radius);
  };
  std::vector<SymmetryPlane> kept;
  std::optional<SymmetryPlane> dropped;
  for (SymmetryPlane& plane : found.planes) {
    if (isDecided(plane)) {
      refine(mesh, plane, found.tolerance, options);
      if (MergeTolerance{kSameOnMesh, kSameOnMesh}.anySame(kept, inBall(plane), inBall)) continue;
      if (plane.kind == PlaneKind::Approximate && !options.approximate) {
        if (!dropped || plane.share > dropped->share) dropped = std::move(plane);
        continue;
      }
    }
    kept.push_back(std::move(plane));
  }
  if (found.best && found.best->share >= kNearlySymmetricShare) {
    refine(mesh, *found.best, found.tolerance, options);
    if (isDecided(*found.best)) {
      const ReflectionPlane best = inBall(*found.best);
      eraseIf(kept, [&](const SymmetryPlane& plane) { return kSamePlane.same(inBall(plane), best); });
      kept.push_back(*found.best);
      found.best.reset();
    }
  } else if (dropped && kept.empty() && !found.hasFamily()) {
    found.best = dropped;
  }
  if (found.flat) found.flat = mesh.fitted(*found.flat);
  found.planes = sortPlanes(std::move(kept), options);
  for (SymmetryAxis& axis : found.axes) {
    MotionsAbout motions{{}, axis.point};
    motions.addRotations(axis.direction);
    const MeshSurface::Placement placed = mesh.fitted(motions);
    axis.direction = placed.rotation * axis.direction;
    axis.point = placed.center + axis.direction.dot(mesh.ball().center - placed.center) * axis.direction;
  }
  for (SymmetryCenter& center : found.centers) {
    MotionsAbout motions{{}, center.point};
    for (int k = 0; k < 3; ++k) motions.addReflection(Eigen::Vector3d::Unit(k));
    center.point = mesh.fitted(motions).center;
  }
}

}  // namespace pcl_symmetry
