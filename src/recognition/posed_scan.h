#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/registration/pose_scoring.h"
#include "core/registration/posed_surface.h"
#include "pcl_symmetry/symmetry_database.h"
#include "recognition/recognition_rules.h"
#include "registration/pose_refinement.h"

namespace pcl_symmetry::detail {

/// A model that a scan was registered to.
struct PosedModel {
  RecognizedModel model;  ///< the confidence is 0 until all models are judged together
  std::shared_ptr<const PosedSurface> surface;
  Eigen::Isometry3d T_surface_scan;  ///< the same as T_model_scan, but in radii about the centers of both
  SearchFrames frames;               ///< search frames of both poses
};

/// The share of each surface that lies on the other one where a scan puts both, the smaller of the two, in [0, 1]: near
/// 1 for models of the same shape. The Gaussian of the distance is as wide as samples of one surface may be apart.
double sharedSurface(const PosedModel& a, const PosedModel& b);

/// \return options of a pose search that takes a tenth of the time of the default, because candidates come with poses
/// or frames of their own.
CloudRegistrationOptions quickRegistration(int num_threads);

/// Least-squares steps that move the visible surface of a model onto the measurements of a scanner along the same rays,
/// including those beside the points of the scan: parts cut off from an object help to pose it.
/// \param scan a scan, with what its scanner saw.
/// \return T_model_scan.
Eigen::Isometry3d posedInPicture(const PosedSurface& scan, const PosedSurface& model,
                                 const Eigen::Isometry3d& T_model_scan);

/// Evidence for a model at a pose.
/// \param scan,model made with exact search.
ModelEvidence modelEvidence(const PosedSurface& scan, const PosedSurface& model, const Eigen::Isometry3d& T_model_scan);

/// A scan that is registered to models.
class PosedScan {
public:
  /// \param points 3 x N, finite, input units, not all equal.
  /// \param seen what the scanner saw; nothing = the points show the object from all sides.
  PosedScan(const Points& points, const std::optional<Visibility>& seen, int num_threads);

  /// Registers the scan to a model: the best of some poses, refined and judged.
  /// \param points points of the model, 3 x M, finite, units of the scan.
  /// \param poses T_model_scan to start from, at least one.
  PosedModel fitModel(const std::string& name, const Points& points, const std::vector<Eigen::Isometry3d>& poses) const;

  /// Tries rotations of a model about its principal axes: a mug fits nearly as well with its handle elsewhere, and no
  /// step leads from there to the true pose.
  /// \return the best pose, with the confidence that the model had.
  PosedModel rotated(const PosedModel& found) const;

  /// Judges a pose that was found elsewhere, as fitModel() does: by the distances of the scan from the surface between
  /// the points of the model, so that the density of these points does not matter.
  /// \param points points of the model, 3 x M, finite, units of the scan.
  PosedModel judged(const std::string& name, const Points& points, const Eigen::Isometry3d& T_model_scan) const;

private:
  PosedModel withoutPose(const std::string& name, const Points& points) const;
  PosedModel fitModel(const PosedModel& model, const std::vector<Eigen::Isometry3d>& T_surface_scan) const;
  PosedModel posed(PosedModel model, const Eigen::Isometry3d& T_surface_scan) const;
  PoseScore scoreOf(const PosedSurface& model, const Eigen::Isometry3d& T_model_scan) const;
  PosedSurface surfaceOf(const Points& points, const Eigen::Vector3d& center, std::optional<Visibility> seen) const;

  CloudRegistrationOptions options_;
  BoundingBall ball_;
  double scale_;  // estimated radius of the whole object, input units
  PosedSurface surface_;
};

}  // namespace pcl_symmetry::detail
