#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "core/evidence/plane_confidence.h"
#include "core/evidence/surface_samples.h"
#include "core/geometry/closest_points.h"
#include "core/geometry/cloud_extent.h"
#include "pcl_symmetry/core/gaussian_edt.h"
#include "pcl_symmetry/core/iterative_symmetric_points.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

/// Tells from a distance transform, without a search, that a point is far from the surface.
class FarTest {
public:
  /// Tests points (x - center) / scale for x in the input frame.
  /// \param edt distance transform of the surface; must outlive this object.
  /// \param center,scale of the frame of the tested points, input units; scale > 0.
  FarTest(const GaussianEdt& edt, const Eigen::Vector3d& center, double scale)
      : edt_(edt), center_(center), scale_(scale) {}

  /// \param distance in the frame of the tested points.
  /// \return the least f of any cell that contains a point within \p distance of the surface.
  float bound(double distance) const {
    const double half_diagonal = 0.5 * std::sqrt(3.0) * edt_.cellSize();
    const double reach = (distance * scale_ + half_diagonal) / edt_.sigma();
    return static_cast<float>(std::exp(-reach * reach));
  }

  /// Whether the distance transform reaches as far as that, so that no point within is taken for far.
  /// \param bound what bound() returned for a distance.
  static bool isExact(float bound) { return bound > 1.2e-3f; }  // below it, f is 0

  /// \param points 3 x M, side by side.
  /// \param bound what bound() returned for a distance.
  /// \return indices of the points that lie inside the grid and may be as near to the surface as that, rising.
  std::vector<Eigen::Index> nearOf(const PointsRef& points, float bound) const;

private:
  static constexpr float kFarthest = 1e-3f;  // below f at the cut of the transform, exp(-2.6^2) = 1.2e-3
  const GaussianEdt& edt_;
  Eigen::Vector3d center_;
  double scale_;
};

/// Where a motion maps points of a surface.
struct Landing {
  Points images, normals;           ///< the points and their normals after the motion; normals only where they are used
  std::vector<int> closest;         ///< points of the surface that the images are closest to; -1: none is near
  std::vector<float> sq_distances;  ///< from these points; infinite where none is near
  std::vector<float> distances;     ///< from the discs of the surface, see surfaceDistances(); only where they are used
};

/// Where points land on a surface. Iterative Symmetric Points (Section 4.4) and rotations of scans ask for their
/// closest points here.
/// \param images the points after the motion, in the frame of the surface.
/// \param reach beyond which points are not near.
/// \param guesses indices of points that are likely to be near, which makes the search faster; null = not known.
/// \param leaves_out points beyond what the distance transform reaches may be taken for far, as their weight is little.
Landing land(const IspSurface& surface, Points images, double reach, const std::vector<int>* guesses = nullptr,
             bool leaves_out = false);

/// The constants of this folder that change answers.
struct RefinementRules {
  // The normalized cloud
  double final_sigma_in_spacings = 3.0;  ///< narrowest weights; less leaves reflections between samples without any
  double volume_roughness = 0.36;        ///< spacings; points that fill a volume evenly have 0.42
  double volume_dimension = 2.6;         ///< of a few hundred points in a thin shell at most

  // Iterative Symmetric Points, of planes and of rotations
  double min_stiffness = 1e-3;  ///< share of the stiffest direction below which a direction is free
  double longest_step = 0.2;    ///< radians, extents of the samples or radii; longer steps leave the basin
  double reach_sigmas = 3.0;    ///< sigmas beyond which pairs have no weight
  double rest_sigmas = 0.1;     ///< sigmas; a shorter step lets the weights narrow
  double hidden_depth = 0.1;    ///< sigmas behind the surface seen over which a pair loses its weight
};

inline constexpr RefinementRules kRefinement;

/// The cloud as all stages of detection see it: in the unit ball about 0, with normals, spacing and roughness.
///
/// The normalized frame is (x - center) / scale. Lengths below are in this frame.
struct NormalizedCloud {
  /// \param input 3 x N, finite, distinct, input units.
  /// \param edt_of_input distance transform of these points; must outlive this object.
  /// \param input_search closest points among the normalized points; null = FLANN's.
  /// \param seen what a scanner saw, input frame; null = the points show the object from all sides.
  /// \param given_normals 3 x N, of any length and sign, used where they are finite and not zero; null = all estimated.
  NormalizedCloud(const PointsRef& input, const GaussianEdt& edt_of_input, ClosestPointSearch::Ptr input_search,
                  const Visibility* seen, int num_threads, const Points* given_normals = nullptr);
  NormalizedCloud(const NormalizedCloud&) = delete;  // parts refer to each other
  NormalizedCloud& operator=(const NormalizedCloud&) = delete;

  const GaussianEdt& edt;        ///< input frame
  const Eigen::Vector3d center;  ///< of the edt, input units
  const double scale;            ///< radius of the edt, input units

  const Points points;                       ///< 3 x N
  const std::shared_ptr<FlannSearch> flann;  ///< null: the search is of the caller
  const ClosestPointSearch::Ptr search;
  FoundNeighbors neighbors;  ///< of the points, found together with their geometry
  const LocalGeometry geometry;
  const std::shared_ptr<const NeighborLists> lists;  ///< null: there are too many points, or no instructions for them
  const SurfaceSamples samples;                      ///< the points and their geometry
  const std::optional<Visibility> visibility;        ///< of a scan
  const FarTest far;
  const IspSurface surface;                  ///< the above, as Iterative Symmetric Points wants it
  const std::unique_ptr<NeighborWalk> walk;  ///< null: there are no lists
  const IspSurface quick_surface;            ///< matched by walks, for first steps, which others refine again

  const PrincipalAxes principal_axes;  ///< of the points
  const double extent;                 ///< greatest distance between two points, by farthestPair()
  const double spacing;                ///< median of the points' spacing
  const double roughness;              ///< median of the points' roughness, divided by the spacing
  const double baseline;     ///< mean support of the points on the surface of all others, > 0: a symmetry reaches it
  const double sigma;        ///< width of the weights when refinement starts: that of the edt
  const double final_sigma;  ///< width at the end: as narrow as the spacing allows, <= sigma

  CloudKind kind() const { return kind_; }
  const Visibility* seen() const { return visibility ? &*visibility : nullptr; }  ///< null: from all sides

  /// From the input frame to the normalized one and back. Lengths: times scale.
  Eigen::Vector3d toNormalized(const Eigen::Vector3d& input_point) const { return (input_point - center) / scale; }
  Eigen::Vector3d toInput(const Eigen::Vector3d& point) const { return point * scale + center; }
  ReflectionPlane toNormalized(const ReflectionPlane& input_plane) const {
    return input_plane.normalized(center, scale);
  }
  ReflectionPlane toInput(const ReflectionPlane& plane) const;
  /// \param input_axis with a point and a direction, such as SymmetryAxis.
  template <typename Axis>
  Line3d lineOf(const Axis& input_axis) const {
    return {toNormalized(input_axis.point), input_axis.direction};
  }

  /// D(f, gamma) of equation 2 for a normalized f: the full sum over the cells of the edt.
  /// \param input_plane in the input frame.
  /// \return in [0, 1].
  double score(const ReflectionPlane& input_plane) const;

private:
  const CloudKind kind_;
};

}  // namespace pcl_symmetry
