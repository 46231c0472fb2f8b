#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/matching/view_signature.h"

namespace pcl_symmetry {

struct ViewSearchOptions {
  int num_nearest = 10;       ///< shapes that are returned, >= 0
  int num_poses = 6;          ///< poses of each shape, >= 1
  double size_weight = 0.25;  ///< distance that radii a factor of e apart add, >= 0
  int num_threads = 0;        ///< >= 0; 0 = one per core
};

/// A shape that looks like a scan from some side.
struct ShapeOfView {
  int shape;        ///< number of the shape, in the order in which shapes were added
  double distance;  ///< mean distance of its two nearest views, with the difference of sizes
  std::vector<Eigen::Isometry3d> T_shape_scan;  ///< poses of the nearest views, nearest first
};

/// Finds the shapes that a scan can show, and their poses.
class ViewIndex {
public:
  /// Adds a shape.
  /// \param views of viewsAround().
  void add(const std::vector<View>& views);

  int numShapes() const { return static_cast<int>(shapes_.size()); }

  /// \return nearest first, at most ViewSearchOptions::num_nearest. Shapes without views are never found.
  std::vector<ShapeOfView> nearest(const View& scan, const ViewSearchOptions& options = {}) const;

private:
  std::vector<std::vector<View>> shapes_;
};

}  // namespace pcl_symmetry
