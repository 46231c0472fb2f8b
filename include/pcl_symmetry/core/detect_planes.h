#pragma once

#include "pcl_symmetry/core/closest_point_search.h"
#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/gaussian_edt.h"
#include "pcl_symmetry/core/plane_types.h"
#include "pcl_symmetry/core/visibility.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

class MeshSurface;

/// The input of detectPlanes(). It refers to its arrays, which must outlive it.
struct PlaneInput {
  /// Points and what a scanner saw of them.
  /// \param points_of_cloud 3 x N, finite, input units.
  /// \param seen_space see visibility.
  PlaneInput(const PointsRef& points_of_cloud, const Visibility* seen_space = nullptr)
      : points(points_of_cloud.data(), 3, points_of_cloud.cols(), points_of_cloud.outerStride()),
        visibility(seen_space) {}
  /// Converts points to an input.
  PlaneInput(const Points& points_of_cloud, const Visibility* seen_space = nullptr)
      : PlaneInput(PointsRef(points_of_cloud), seen_space) {}

  /// 3 x N, finite, input units. Fewer than 20 distinct points, or points on one line, give Detection::reason instead
  /// of an answer. More than 20 000 points are represented by a subset that resolves the tolerance.
  Eigen::Map<const Eigen::Matrix3Xf, 0, Eigen::OuterStride<>> points;
  /// What a scanner saw, input frame; null = the points show the object from all sides.
  const Visibility* visibility = nullptr;
  /// 3 x N normals of any length and sign; zero and non-finite ones are estimated from the neighbors. Null: all are
  /// estimated.
  const Points* normals = nullptr;
  /// A symmetry map of the points and the distance transform that it was computed from; both or neither.
  const SymmetryMap* map = nullptr;
  const GaussianEdt* edt = nullptr;  ///< see map
  MakeSearch make_search;  ///< makes the closest-point search over the points used; called once; empty = FLANN
  /// Whether the points may be the rings of a LiDAR. If so, and if the visibility has a support, the answer is the
  /// middle plane of an upright box where the points are too sparse for a surface, or where nothing else is decided.
  bool may_be_rings = false;
};

/// Finds the planes of symmetry of points: transform, maxima, refinement, decision (Sections 4.1 to 4.4).
/// publishedPlanes() follows Section 4.4 of the paper exactly. This default adds stages of refinement, the decision
/// whether a plane is a symmetry, families of planes, rotations of scans and symmetries of parts.
/// \throws std::invalid_argument for bad options, coordinates that are not finite, a number of normals that is not the
/// number of points, or a map without its distance transform or the reverse.
Detection detectPlanes(const PlaneInput& input, const DetectionOptions& options = {});

/// Refines planes, axes and centers on the mesh itself: the last step of a search whose points were sampled from a
/// mesh. Samples determine a plane only to a fraction of their spacing, within which the plane of a slender or flat
/// part can rotate far; the mesh determines it exactly. For symmetries and possible symmetries, share, deviation,
/// residual and confidence are measured again, on the mesh. Coinciding planes are reported once, in the order of
/// Detection::planes, and planes below DetectionOptions::min_possible are dropped unless approximate ones are reported.
/// \param found result of detectPlanes() on points of the mesh, without visibility, in the frame of the mesh. Its
/// tolerance is used.
/// \param options the options of that detection.
void refineOnMesh(const MeshSurface& mesh, Detection& found, const DetectionOptions& options = {});

}  // namespace pcl_symmetry
