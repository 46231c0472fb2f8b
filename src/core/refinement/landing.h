#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_symmetry/core/closest_point_search.h"
#include "pcl_symmetry/core/gaussian_edt.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

/// Detects by a distance transform, without a search, that a point is far from the surface.
class FarTest {
public:
  /// Prepares tests of points (x - center) / scale for x in the input frame.
  /// \param edt distance transform of the surface; must outlive this object.
  /// \param center,scale frame of the tested points, input units; scale > 0.
  FarTest(const GaussianEdt& edt, const Eigen::Vector3d& center, double scale)
      : edt_(edt), center_(center), scale_(scale) {}

  /// \param points 3 x M, side by side.
  /// \param distance in the frame of the points.
  /// \param leaves_out points beyond the reach of the distance transform count as farther.
  /// \return ascending indices of the points that may be within that distance of the surface.
  std::vector<int> nearOf(const PointsRef& points, double distance, bool leaves_out) const;

private:
  const GaussianEdt& edt_;
  Eigen::Vector3d center_;
  double scale_;
};

/// The surface that reflected samples are matched to.
struct IspSurface {
  const Points& points;              ///< 3 x N
  const Points& normals;             ///< 3 x N unit normals of any sign; may be empty with PointToPoint
  const ClosestPointSearch& search;  ///< finds the closest of points
  /// N values; matches to points with the value 1 get no weight, because the true match at the rim of a scan may not
  /// have been seen. Null: no such points.
  const std::vector<char>* at_border = nullptr;
  const FarTest* far = nullptr;  ///< avoids the search for points that would get no weight; null = search for all
  int num_threads = 1;           ///< for the searches of one iteration; 0 = one per core
  /// What a scanner saw, in the frame of the points. The partner of a reflection behind the visible surface is hidden
  /// there: it is not the closest point. Null: the points show the object from all sides.
  const Visibility* visibility = nullptr;
};

/// Where a motion maps points of a surface.
struct Landing {
  Points images;             ///< the points after the motion
  Points normals;            ///< their normals after the motion; empty if they are not measured
  std::vector<int> closest;  ///< points of the surface closest to the images; -1 = none is near
  /// Squared distances of the images from these points; infinite where none is near; empty if they are not measured.
  std::vector<float> sq_distances;
  /// Distances from the discs of the surface, see surfaceDistances(); empty if they are not measured.
  std::vector<float> distances;
};

/// Finds the closest points of a surface to moved points, for Iterative Symmetric Points (Section 4.4) and for
/// rotations of scans.
/// \param images the points after the motion, in the frame of the surface.
/// \param reach greatest distance of a near point.
/// \param guesses indices of points that are likely to be close, which makes the search faster; null = not known.
/// \param leaves_out points beyond the reach of the distance transform are skipped; their weight is negligible.
Landing land(const IspSurface& surface, Points images, double reach, const std::vector<int>* guesses = nullptr,
             bool leaves_out = false);

}  // namespace pcl_symmetry
