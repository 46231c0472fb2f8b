#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>

#include "core/evidence/plane_confidence.h"
#include "core/evidence/surface_samples.h"
#include "core/geometry/closest_points.h"
#include "core/geometry/cloud_extent.h"
#include "core/refinement/landing.h"
#include "pcl_symmetry/core/gaussian_edt.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

/// The cloud that all stages of detection use: in the unit ball about 0, with normals, spacing and roughness.
///
/// The normalized frame is (x - center) / scale. Lengths below are in this frame.
struct NormalizedCloud {
  /// \param input 3 x N, finite, distinct, input units.
  /// \param edt_of_input distance transform of these points; must outlive this object.
  /// \param input_search search over the normalized points; null = FLANN.
  /// \param seen what a scanner saw, input frame; null = the points show the object from all sides.
  /// \param given_normals 3 x N, of any length and sign, used where they are finite and not zero; null = all estimated.
  NormalizedCloud(const PointsRef& input, const GaussianEdt& edt_of_input, ClosestPointSearch::Ptr input_search,
                  const Visibility* seen, int num_threads, const Points* given_normals = nullptr);
  NormalizedCloud(const NormalizedCloud&) = delete;  // parts refer to each other
  NormalizedCloud& operator=(const NormalizedCloud&) = delete;

  const GaussianEdt& edt;        ///< input frame
  const Eigen::Vector3d center;  ///< center of the edt, input units
  const double scale;            ///< radius of the edt, input units

  const Points points;                       ///< 3 x N
  const std::shared_ptr<FlannSearch> flann;  ///< null if the caller provides the search
  const ClosestPointSearch::Ptr search;
  FoundNeighbors neighbors;  ///< neighbors of the points, found together with their geometry
  const LocalGeometry geometry;
  /// Null if there are too many points or the processor lacks the instructions.
  const std::shared_ptr<const NeighborLists> lists;
  const SurfaceSamples samples;                ///< the points and their geometry
  const std::optional<Visibility> visibility;  ///< what the scanner of a scan saw, normalized frame
  const FarTest far;
  const IspSurface surface;                  ///< the above, as input of Iterative Symmetric Points
  const std::unique_ptr<NeighborWalk> walk;  ///< null: there are no lists
  const IspSurface quick_surface;            ///< matched by walks, for first steps that are refined again

  const PrincipalAxes principal_axes;  ///< principal axes of the points
  const double diameter;               ///< diameter of the points, by approximateDiameter()
  const double spacing;                ///< median of the points' spacing
  const double roughness;              ///< median of the points' roughness, divided by the spacing
  const double baseline;     ///< mean support of the points by the surface of all others, > 0, which a symmetry reaches
  const double sigma;        ///< width of the weights when refinement starts, the sigma of the edt
  const double final_sigma;  ///< width at the end: as narrow as the spacing allows, <= sigma

  CloudKind kind() const { return kind_; }
  /// Points on all sides of a surface. Open borders indicate that a piece is missing.
  bool isSurface() const { return kind_ == CloudKind::Surface; }
  /// A scan shows too little to complete groups of planes, candidates of little merit may be symmetries, and
  /// point-to-plane steps slide along flat pieces; planes of noisy scans climb within the last stage.
  bool isScan() const { return kind_ == CloudKind::Scan; }
  /// Points that resolve no surface and have no normals: they are made evenly dense, one half of them is compared with
  /// the other, and planes of a polygon are judged together, as noise hides single ones.
  bool isVolume() const { return kind_ == CloudKind::Volume; }
  const Visibility* seen() const { return visibility ? &*visibility : nullptr; }  ///< null: isScan() is false

  /// Transforms between the input frame and the normalized one. Lengths in the input frame are `scale` times as long.
  Eigen::Vector3d toNormalized(const Eigen::Vector3d& input_point) const { return (input_point - center) / scale; }
  Eigen::Vector3d toInput(const Eigen::Vector3d& point) const { return point * scale + center; }
  ReflectionPlane toNormalized(const ReflectionPlane& input_plane) const {
    return input_plane.normalized(center, scale);
  }
  ReflectionPlane toInput(const ReflectionPlane& plane) const;
  /// \param input_axis an axis with a point and a direction, such as SymmetryAxis.
  template <typename Axis>
  Line3d lineOf(const Axis& input_axis) const {
    return {toNormalized(input_axis.point), input_axis.direction};
  }

  /// D(f, gamma) of Equation 2 for a normalized f: the full sum over the cells of the edt.
  /// \param input_plane plane in the input frame.
  /// \return in [0, 1].
  double score(const ReflectionPlane& input_plane) const;

private:
  const CloudKind kind_;
};

}  // namespace pcl_symmetry
