#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "core/neighbours/closest_point_grid.h"
#include "pcl_symmetry/core/geometry/point_set.h"
#include "pcl_symmetry/core/neighbours/closest_point_search.h"
#include "pcl_symmetry/core/scan/visibility.h"

namespace pcl_symmetry {

/// One of two clouds that are brought together, with all that judging a pose asks of it.
struct PosedSurface {
  Points points;                   ///< 3 x N
  Points normals;                  ///< 3 x N, unit, of any sign
  std::vector<int> order;          ///< of the points, at random: its first k are an even sample of the surface
  double accuracy = 0.0;           ///< within which samples of one surface meet: their spacing and their noise
  std::optional<Visibility> seen;  ///< what the scanner saw; nothing = the cloud shows its object from all sides
  ClosestPointGrid grid;
  ClosestPointSearch::Ptr search;

  /// \param points 3 x N, finite, N >= 1. \param seen in the same frame.
  PosedSurface(const PointsRef& points, std::optional<Visibility> seen, std::uint64_t seed, int num_threads);
};

/// What two clouds say about a pose.
struct PoseScore {
  double support = 0.0;  ///< share of the scan's points that lie on the model, in [0, 1]
  /// Of the model's points that the scanner could judge, the share that lies where it saw that there is nothing; and
  /// the share of the scan's points that lie where a scanner saw that nothing of the model is. In [0, 2].
  double conflict = 0.0;

  /// By which poses are compared. Conflict counts half: holes that a scanner leaves look like space it saw through.
  double merit() const { return support - 0.5 * conflict; }
};

/// Judges and improves poses that bring a scan, or a whole object, to a model of it (Section 5.1).
///
/// Every point of the scan has to lie on the model, unless the model is a scan too and could not see it there; no point
/// of the model may lie where the scan looked through. Both are counted with a Gaussian of the distance, so that there
/// is a way uphill from a coarse pose to the exact one.
class PoseScorer {
public:
  /// How exactly to look.
  struct Detail {
    int num_points;      ///< of each cloud, >= 1
    double width;        ///< of the Gaussian, > 0
    bool exact = false;  ///< closest points from the tree, not from the grid
  };

  /// \param scan,model must outlive this object.
  PoseScorer(const PosedSurface& scan, const PosedSurface& model) : scan_(scan), model_(model) {}

  PoseScore score(const Eigen::Isometry3d& T_model_scan, const Detail& detail) const;

  /// One Gauss-Newton step on the distances of the scan's points to the planes at their closest points, weighted by the
  /// Gaussian, and on those of the model's points in free space to the scan.
  Eigen::Isometry3d step(const Eigen::Isometry3d& T_model_scan, const Detail& detail) const;

private:
  const PosedSurface& scan_;
  const PosedSurface& model_;
};

}  // namespace pcl_symmetry
