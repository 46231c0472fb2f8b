#pragma once

#include <Eigen/Geometry>

#include "core/registration/posed_surface.h"
#include "pcl_symmetry/core/pose_search.h"

namespace pcl_symmetry {

/// Judges and improves poses that bring a scan, or a whole object, to a model of it (Section 5.1).
///
/// Every point of the scan has to lie on the model, unless the model is a scan too and could not see that position. No
/// point of the model may lie where the scan looked through. Both are counted with a Gaussian of the distance, so that
/// the score rises on the way from a coarse pose to the exact one.
class PoseScorer {
public:
  /// How exactly to look.
  struct Detail {
    int num_points;      ///< of each cloud, >= 1
    double width;        ///< of the Gaussian, > 0, in the unit of the clouds
    bool exact = false;  ///< closest points from the tree, not from the grid
    double unit = 1.0;   ///< length in the unit of the clouds, > 0: of the model's size, so that rotations and
                         ///< translations count alike
  };

  /// \param scan,model must outlive this object.
  PoseScorer(const PosedSurface& scan, const PosedSurface& model) : scan_(scan), model_(model) {}

  PoseScore score(const Eigen::Isometry3d& T_model_scan, const Detail& detail) const;

  /// One Gauss-Newton step. It shortens the distances of the scan's points from the tangent planes at their closest
  /// points, weighted by the Gaussian, and those of the model's points in free space from the scan.
  Eigen::Isometry3d step(const Eigen::Isometry3d& T_model_scan, const Detail& detail) const;

private:
  const PosedSurface& scan_;
  const PosedSurface& model_;
};

}  // namespace pcl_symmetry
