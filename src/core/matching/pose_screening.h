#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "core/matching/surface_points.h"
#include "core/registration/posed_surface.h"

namespace pcl_symmetry {

/// A shape or a scan reduced to a few points, enough to reject impossible poses.
struct ScreenedSurface {
  BoundingBall ball;     ///< bounding ball of the points, input frame
  PosedSurface surface;  ///< the points about the center of the ball, input units

  /// \param points in random order, at least one.
  /// \param seen what the scanner saw of a scan, input frame; nothing for a shape.
  explicit ScreenedSurface(const SurfacePoints& points, const std::optional<Visibility>& seen = std::nullopt);
};

/// Poses of a scan to try with one shape.
struct PosesOfShape {
  const ScreenedSurface* shape;                 ///< not null
  std::vector<Eigen::Isometry3d> T_shape_scan;  ///< input frames
};

struct PoseScreeningOptions {
  int num_shapes = 10;       ///< shapes that are returned, >= 0
  double max_behind = 0.15;  ///< deficit in merit to the best pose of all shapes, at which a shape is left out
  int min_shapes = 2;        ///< number of best shapes that are never left out, because a confidence needs a second one
  int num_poses = 6;         ///< poses of each shape, >= 1
  int num_threads = 0;       ///< >= 0; 0 = one per core
};

/// A remaining shape with its best poses.
struct ScreenedShape {
  int shape;                                    ///< index of the shape in the input
  std::vector<Eigen::Isometry3d> T_shape_scan;  ///< input frames, best first, at least one
};

/// Tries thousands of poses of many shapes with a scan: votes of pairs of points are weak where much of an object is
/// hidden, but one of many poses with votes is near the true one. All poses are judged by a few points and by free
/// space; the best of all shapes are improved by Gauss-Newton steps and judged again. Not in the paper.
/// \param shapes in the unit of the scan.
/// \return the shapes with the best poses, best first, at most PoseScreeningOptions::num_shapes.
std::vector<ScreenedShape> screenPoses(const ScreenedSurface& scan, const std::vector<PosesOfShape>& shapes,
                                       const PoseScreeningOptions& options = {});

}  // namespace pcl_symmetry
