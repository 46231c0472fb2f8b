#pragma once

#include <pcl/registration/registration.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/pose_search.h"
#include "pcl_symmetry/core/symmetry_frame.h"
#include "pcl_symmetry/core/visibility.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Poses around a guess.
struct PoseNeighborhood {
  double angle;     ///< greatest rotation away from the guess, radians, in (0, pi]
  double distance;  ///< greatest distance from where the guess puts the center of the source, input units, >= 0
};

/// The search for a pose and its refinement.
struct CloudRegistrationOptions {
  /// Restricts the search to poses around the guess, as tracking needs it; symmetry frames are then not computed. Not
  /// set: all poses are searched.
  std::optional<PoseNeighborhood> around = {};
  /// Options of the symmetry frames that poses are derived from, in addition to evenly spread rotations. Its
  /// probabilities, refined, rotations, seed and num_threads are not used.
  FrameOptions frame;
  PoseSearchOptions search;  ///< options of the search for poses; its num_threads is not used
  /// If no pose is convincing, also searches poses by pairs of points, which clouds that share a small part need.
  bool search_parts = true;
  /// Refines the answer once more with correspondences as close as the points allow; its evidence and confidence are
  /// those before that step.
  bool refine_closely = true;
  int max_iterations = 30;  ///< limit of the iterations of PCL's point-to-plane ICP, >= 1
  /// Greatest distance of corresponding points in the refinement, input units, > 0; not set: from the data. With
  /// refine_closely, the last refinement uses the distance within which samples of one surface meet, if that is less.
  std::optional<double> max_correspondence = {};
  /// As in pcl::Registration, of the refinement, but with lengths in radii, >= 0.
  double transformation_epsilon = 1e-8;
  /// As in pcl::Registration, of the refinement: cosine of the rotation of a step, at or above which the refinement may
  /// end; where it is not > 0, 1 - transformation_epsilon.
  double rotation_epsilon = 0.0;
  std::uint64_t seed = 1;  ///< seed of all random draws
  int num_threads = 0;     ///< >= 0; 0 = one per core

  /// Checks all values.
  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// A pose of one cloud relative to another.
struct RegisteredPose {
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();  ///< moves the source onto the target
  /// Score of the pose. The source counts as the scan, unless only the target was seen from one side.
  PoseScore score;
};

/// The best pose of one cloud relative to another, and the next best ones.
struct CloudRegistration : RegisteredPose {
  /// Whether the best pose is an answer.
  /// \param min_confidence in [0, 1].
  /// \return whether both clouds have enough points for an answer, and the best pose has that confidence.
  bool converged(double min_confidence = 0.5) const { return covariance.has_value() && confidence >= min_confidence; }

  double confidence = 0.0;       ///< estimated probability that the best pose is right, in [0, 1]
  PoseEvidence evidence;         ///< what the confidence follows from
  bool is_around_guess = false;  ///< whether only poses around the guess were tried
  /// \param min_confidence in [0, 1].
  /// \return why the best pose is no answer, one sentence without a full stop.
  std::string doubt(double min_confidence = 0.5) const;

  /// Distinct poses, at most PoseSearchOptions::max_poses, best first: poses of nearly the greatest merit by decreasing
  /// confidence, then others by decreasing merit. If no pose was convincing and pairs of points were tried, all by
  /// decreasing confidence. Poses that are equivalent by symmetry have nearly the same merit.
  std::vector<RegisteredPose> poses;
  /// Uncertainty of the best pose: the covariance of the small motion (w, t) in the target's frame that would correct
  /// it, so that a point x of the aligned source belongs at x + w x x + t. w is a rotation vector, radians; t is a
  /// translation, input units. It follows from the Hessian and the scatter of the point-to-plane distances: it covers
  /// noise and sampling, but neither equivalent nor wrong poses. Directions that the surface does not constrain have
  /// the variance of a uniform rotation, or of a translation by the radius. Empty if no pose was found.
  std::optional<Eigen::Matrix<double, 6, 6>> covariance;
  std::vector<std::pair<std::string, double>> timing_ms;  ///< stages in order, with their milliseconds
};

/// Least number of points of a cloud. Fewer fit any cloud of their size: with 50, eight of eight wrong objects reach a
/// merit of 0.55.
constexpr int kLeastRegistrationPoints = 100;
/// Number of points drawn from larger clouds, see SymmetryRegistration::setMaxPoints().
constexpr std::size_t kRegistrationPoints = 10'000;

class PreparedCloud;

/// A cloud that others are registered to repeatedly. Its normals, its trees and, if needed, its symmetry frame are
/// computed on first use and kept; several threads may use it.
/// \param points 3 x N, finite, not all equal, input units.
/// \param seen what the scanner saw of them; nothing = the cloud shows its object from all sides.
/// \param options options of the preparation: frame, seed and num_threads are used.
std::shared_ptr<const PreparedCloud> registrationTarget(const Points& points, const std::optional<Visibility>& seen,
                                                        const CloudRegistrationOptions& options = {});

/// Finds the best pose of two clouds (Section 5.1): hypotheses from symmetry frames, search, refinement by ICP, and a
/// last comparison with more points.
/// \param source,target 3 x N, finite, not all equal, input units.
/// \param source_seen,target_seen what the scanners saw of them; nothing = the cloud shows its object from all sides.
/// \param guess T_target_source, tried in addition to the hypotheses; the center of options.around.
/// \param options options of frames, search and refinement.
/// \return the poses of greatest merit; if no pose around the guess remains, the guess with a score of 0.
/// \throws std::invalid_argument for bad options or points without extent.
CloudRegistration registerClouds(const Points& source, const std::optional<Visibility>& source_seen,
                                 const Points& target, const std::optional<Visibility>& target_seen,
                                 const Eigen::Isometry3d& guess, const CloudRegistrationOptions& options = {});

/// The same for a target that was prepared once. registrationTarget() was given the options of its frame.
CloudRegistration registerClouds(const Points& source, const std::optional<Visibility>& source_seen,
                                 const PreparedCloud& target, const Eigen::Isometry3d& guess,
                                 const CloudRegistrationOptions& options = {});

/// Registers a cloud to another one from any pose by their symmetries (Section 5.1 of the paper): a partial scan to a
/// model of its object, two whole objects, or a whole object to a scan.
///
/// This is a pcl::Registration that needs no guess. It honors setIndices(), which selects points of the source (the
/// others may only hide them), setMaxCorrespondenceDistance() (default: from the data; the last refinement uses the
/// distance within which samples of one surface meet, if that is less), setMaximumIterations() and the epsilons of the
/// refinement. Points that are not finite are left out, also by getFitnessScore(), unless setSearchMethodTarget() gave
/// it another tree, which align() does not use. Estimations, rejectors, RANSAC, the Euclidean fitness epsilon and the
/// visualization callback have no effect. The target is prepared by the first align() after it was set, and kept: a
/// change of its points needs setInputTarget() again.
///
/// If nothing fits, or a cloud holds no answer, hasConverged() is false, the transformation is the identity, the output
/// is the unchanged source, getReason() returns the reason, which PCL_WARN prints, and getPoses() lists the poses
/// found.
///
/// The class is compiled where it is used, for any point type with x, y and z. Source and target have the same one
/// where PCL's own classes ask for that, as PCL 1.13 does.
template <typename PointSource, typename PointTarget, typename Scalar = float>
class SymmetryRegistration : public pcl::Registration<PointSource, PointTarget, Scalar> {
public:
  using Base = pcl::Registration<PointSource, PointTarget, Scalar>;
  using Ptr = pcl::shared_ptr<SymmetryRegistration<PointSource, PointTarget, Scalar>>;
  using ConstPtr = pcl::shared_ptr<const SymmetryRegistration<PointSource, PointTarget, Scalar>>;
  using typename Base::Matrix4;
  using typename Base::PointCloudSource;
  using typename Base::PointCloudSourceConstPtr;
  using typename Base::PointCloudTargetConstPtr;

  static_assert(std::is_convertible_v<typename Base::KdTreeReciprocalPtr,
                                      typename pcl::registration::CorrespondenceEstimationBase<
                                          PointSource, PointTarget, Scalar>::KdTreeReciprocalPtr>,
                "pcl::Registration of this PCL takes one point type for source and target: use pcl::copyPointCloud");

  SymmetryRegistration();

  /// Sets the cloud whose pose is sought.
  void setInputSource(const PointCloudSourceConstPtr& cloud) override {
    Base::setInputSource(cloud);
    forgetAnswer();
  }
  /// Sets the cloud that sources are registered to. It is prepared once, see above.
  void setInputTarget(const PointCloudTargetConstPtr& cloud) override {
    Base::setInputTarget(cloud);
    prepared_target_.reset();
    forgetAnswer();
  }

  /// Sets where the scanner of each cloud stood; by default it follows from the data, see ScanAnalysis.
  void setSourceViewpoint(const Viewpoint& viewpoint) { source_viewpoint_ = detail::checkedViewpoint(viewpoint); }
  /// See setSourceViewpoint().
  void setTargetViewpoint(const Viewpoint& viewpoint) {
    target_viewpoint_ = detail::checkedViewpoint(viewpoint);
    prepared_target_.reset();
  }
  /// \param min_confidence least confidence of a pose that has converged, in [0, 1]; default 0.5.
  /// \throws pcl::BadArgumentException "field = value, must be rule", as do all setters here.
  void setMinConfidence(double min_confidence) {
    if (!(min_confidence >= 0.0 && min_confidence <= 1.0)) {
      std::ostringstream message;
      message << "min_confidence = " << min_confidence << ", must be in [0, 1]";
      detail::throwBadArgument(message.str());
    }
    min_confidence_ = min_confidence;
  }
  /// Searches only around the guess that align() is given: a moving object is tracked from one frame to the next, and
  /// does not jump to an equivalent pose farther away. align() does not converge where nothing fits there.
  /// \param angle greatest rotation away from the guess, radians, in (0, pi].
  /// \param distance greatest distance of the center of the source from where the guess puts it, input units, >= 0.
  void setSearchAround(double angle, double distance) {
    detail::changeOptions(options_, [&](CloudRegistrationOptions& changed) { changed.around = {angle, distance}; });
  }
  /// Larger clouds are reduced to this number of points, see CloudAnalysis::setMaxPoints().
  /// \param max_points >= 3; default 10 000.
  void setMaxPoints(std::size_t max_points) {
    detail::checkAtLeast("max_points", static_cast<std::int64_t>(max_points), 3);
    max_points_ = max_points;
    prepared_target_.reset();
  }
  /// \param seed seed of all random draws.
  void setRandomSeed(std::uint64_t seed) {
    options_.seed = seed;
    prepared_target_.reset();
  }
  /// \param num_threads >= 0; 0 = one per core (default).
  void setNumberOfThreads(int num_threads) {
    detail::checkAtLeast("num_threads", num_threads, 0);
    options_.num_threads = num_threads;
  }

  /// \return how well the clouds agree at the transformation of the last align(), or, if nothing fits, at the best pose
  /// that was found.
  const PoseScore& getScore() const { return result_.score; }
  /// \return estimated probability that the best pose of the last align() is right, in [0, 1].
  double getConfidence() const { return result_.confidence; }
  /// \return the evidence that the confidence follows from: agreement, surface that should be visible but was not
  /// measured, and more.
  const PoseEvidence& getEvidence() const { return result_.evidence; }
  /// \return the best poses that the last align() found, see CloudRegistration::poses; the first one is the
  /// transformation. Empty if a cloud held no answer.
  const std::vector<RegisteredPose>& getPoses() const { return result_.poses; }
  /// \return the uncertainty of the transformation of the last align(), see CloudRegistration::covariance; nothing if
  /// it did not converge.
  const std::optional<Eigen::Matrix<double, 6, 6>>& getCovariance() const { return result_.covariance; }
  /// Why there is no pose, one sentence: the last align() did not converge or could not begin. Empty if it converged.
  std::string getReason() const {
    if (!input_ || input_->empty()) return "source: not set";
    if (!target_ || target_->empty()) return "target: not set";
    return reason_;
  }
  /// \return stages of the last align() and their milliseconds, in order.
  const std::vector<std::pair<std::string, double>>& getTiming() const { return result_.timing_ms; }

protected:
  using Base::converged_;
  using Base::corr_dist_threshold_;
  using Base::final_transformation_;
  using Base::getClassName;
  using Base::indices_;
  using Base::input_;
  using Base::max_iterations_;
  using Base::reg_name_;
  using Base::target_;
  using Base::transformation_;
  using Base::transformation_epsilon_;
  using Base::transformation_rotation_epsilon_;
  using Base::tree_;

  /// Finds the pose, or the reason why there is none.
  /// \throws pcl::BadArgumentException if points surround the viewpoint that was given for them.
  void computeTransformation(PointCloudSource& output, const Matrix4& guess) override;

private:
  void forgetAnswer() {
    result_ = {};
    converged_ = false;
    reason_ = "align() was not called with these clouds";
  }
  /// Prepares the target, or sets the reason why it holds no answer.
  void prepareTarget();
  /// Sets the transformation, or the reason if nothing fits.
  void findPose(const Points& source, const Matrix4& guess);

  Viewpoint source_viewpoint_, target_viewpoint_;
  CloudRegistrationOptions options_;
  std::shared_ptr<const PreparedCloud> prepared_target_;
  double min_confidence_ = 0.5;
  std::size_t max_points_ = kRegistrationPoints;
  CloudRegistration result_;  // result of the last align(); without covariance if it did not converge
  std::string reason_ = "align() was not called with these clouds";
};

}  // namespace pcl_symmetry

#include "pcl_symmetry/impl/symmetry_registration.hpp"
