/// How well a rigid motion maps a surface onto itself, and a comparison of the symmetries that a file lists for a model
/// with those of its surface.
#pragma once

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bop/models_info.h"
#include "core/evidence/surface_samples.h"
#include "pcl_symmetry/core/closest_point_search.h"

namespace pcl_symmetry::apps {

struct MotionEvidence {
  double share = 1.0;      ///< share of the surface that is mapped to within the tolerance of the surface, in [0, 1]
  double mean = 0.0;       ///< mean distance of mapped points from the surface, input units
  double deviation = 0.0;  ///< distance from the surface within which 97 % of the mapped points stay, input units
};

/// Samples of a surface, and the distances from it by which motions are judged.
class SurfaceEvidence {
public:
  /// \param points 3 x N, finite, at least 20 distinct ones.
  /// \param tolerance input units, > 0.
  SurfaceEvidence(Points points, double tolerance);

  MotionEvidence of(const Eigen::Isometry3d& motion) const;
  /// \return distance of each moved point from the surface, input units.
  std::vector<float> distances(const Eigen::Isometry3d& motion) const;

  const Points& points() const { return points_; }
  double tolerance() const { return tolerance_; }

private:
  Points points_;
  double tolerance_;
  ClosestPointSearch::Ptr search_;
  SurfaceSamples samples_;
};

/// Rotations on which a file and the surface disagree.
struct Disagreement {
  std::string says;         ///< "file only" or "surface only"
  Eigen::Vector3d axis;     ///< unit, input frame
  Eigen::Vector3d point;    ///< point of the axis, input frame
  double angle = 0.0;       ///< radians; 0 = any angle
  MotionEvidence evidence;  ///< evidence of the rotation; for any angle, of the worst of eight rotations
};

struct SymmetryCheck {
  std::string file_group;     ///< such as D2; empty where the file's motions are no group
  std::string surface_group;  ///< such as D4
  std::string remark;         ///< what is wrong with the list itself, such as rotations that it lacks; may be empty
  std::vector<Disagreement> disagreements;

  bool agrees() const { return remark.empty() && disagreements.empty(); }
};

/// \param found symmetries of the surface.
/// \param diameter diameter of the model, input units. Rotations that differ by up to 2 % of it at every point count as
/// one.
SymmetryCheck checkSymmetries(const ListedSymmetries& listed, const ObjectSymmetries& found,
                              const SurfaceEvidence& surface, double diameter);

nlohmann::ordered_json toJson(const SymmetryCheck& check, double diameter);

/// \param name name of the model.
void printCheck(const std::string& name, const SymmetryCheck& check, double diameter);

}  // namespace pcl_symmetry::apps
