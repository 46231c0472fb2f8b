#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/views/view_signature.h"

namespace pcl_symmetry {

struct ViewSearchOptions {
  int num_nearest = 10;  ///< shapes, >= 0
  int num_poses = 6;     ///< of each, >= 1
  /// What a factor of e between the radii of two views adds to their distance, >= 0.
  double size_weight = 0.25;
  int num_threads = 0;  ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// A shape that looks like a scan from some side.
struct ShapeOfView {
  int shape;                                    ///< in the order in which they were added
  double distance;                              ///< least distance of views, difference of sizes included
  std::vector<Eigen::Isometry3d> T_shape_scan;  ///< poses of the nearest views, nearest first
};

/// Finds the shapes that a scan can be a view of, and in which poses.
class ViewIndex {
public:
  /// Adds a shape. \param views as of viewsAround().
  void add(const std::vector<View>& views);

  int numShapes() const { return static_cast<int>(shapes_.size()); }

  /// \return nearest first; fewer where there are no more. Shapes without views are never found.
  std::vector<ShapeOfView> nearest(const View& scan, const ViewSearchOptions& options = {}) const;

private:
  std::vector<std::vector<View>> shapes_;
};

}  // namespace pcl_symmetry
