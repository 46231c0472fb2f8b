/// The symmetries that a mesh really has, found by exhaustive search: what detectors are measured against.
#pragma once

#include <pcl/PolygonMesh.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/geometry/reflection_plane.h"

namespace pcl_symmetry::apps {

struct ReferenceOptions {
  /// A reflected point within this of the mesh is on it, > 0: in diameters (the greatest distance between two points,
  /// which no rotation changes), or in diagonals of the bounding box.
  double tolerance = 0.01;
  bool tolerance_in_diagonals = false;
  double min_share = 0.97;     ///< of the area: planes with more are references, in (0, 1]
  double near_share = 0.90;    ///< planes with more, and less than min_share, are neither right nor wrong
  double merge_angle = 3.0;    ///< degrees: of planes closer than this ...
  double merge_offset = 0.02;  ///< ... and this, in diagonals, the best is kept: answers could not be told apart
  bool by_transform = false;   ///< candidates from this library's transform in place of brute force, for comparison
  int num_samples = 20'000;    ///< points of the surface that the shares are measured with
  std::uint64_t seed = 1;
  int num_threads = 0;  ///< 0 = all; does not change the result

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

struct ReferencePlane {
  ReflectionPlane plane;
  double share;  ///< of the area whose reflection lies on the mesh
};

/// Every plane through this line is a symmetry: a body of revolution.
struct ReferenceAxis {
  Eigen::Vector3d point;
  Eigen::Vector3d direction;  ///< unit
  double share;               ///< the least among planes through it
};

/// Every plane through this point is a symmetry: a sphere.
struct ReferenceCenter {
  Eigen::Vector3d point;
  double share;  ///< the least among planes through it
};

enum class SymmetryKind {
  Symmetric,        ///< has a reference
  NearlySymmetric,  ///< has none, but near planes: counts in no rate
  Asymmetric        ///< has neither
};

const char* toString(SymmetryKind kind);

/// All lengths and frames as the mesh has them.
struct ReferenceSymmetries {
  std::vector<ReferencePlane> planes;  ///< best first; without those of the axes and centers
  std::vector<ReferenceAxis> axes;
  std::vector<ReferenceCenter> centers;
  std::vector<ReferencePlane> near_planes;
  std::vector<ReferenceAxis> near_axes;
  double best_share = 0.0;                           ///< of any plane, also where it is no reference
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< of the bounding box, where offsets are measured
  double diagonal = 1.0;                             ///< of the bounding box
  double diameter = 1.0;                             ///< the greatest distance between two points
  double tolerance = 0.01;                           ///< within which the shares hold
  SymmetryKind kind = SymmetryKind::Asymmetric;

  /// The same symmetries of the mesh after a rigid motion; center moves along, the diagonal stays.
  ReferenceSymmetries transformed(const Eigen::Isometry3d& motion) const;

  /// The same symmetries of the mesh moved by -\p origin and then made larger by \p factor.
  ReferenceSymmetries scaled(const Eigen::Vector3d& origin, double factor) const;
};

/// Tries all planes, two degrees and one per cent of the diagonal apart, by reflecting points of the mesh; refines the
/// local maxima, and the reflections of what was found in each other, on exact distances to the mesh, and climbs to the
/// greatest share. Nothing of it is shared with the detector (but see by_transform).
/// \throws std::invalid_argument where the mesh has no area, or for bad options.
ReferenceSymmetries findReferenceSymmetries(const pcl::PolygonMesh& mesh, const ReferenceOptions& options = {});

}  // namespace pcl_symmetry::apps
