#pragma once

#include <pcl/registration/registration.h>

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "pcl_symmetry/registration/cloud_registration.h"
#include "pcl_symmetry/viewpoint.h"

namespace pcl_symmetry {

/// Brings a cloud to another one from any pose, by their symmetries (Section 5.1 of the paper): a partial scan to a
/// model of its object, two wholes, or a whole to a scan.
///
/// A pcl::Registration that needs no guess: align() where PCL's classes stand. Candidates are the poses that bring the
/// symmetry frames of both clouds together in one of the ways that symmetry leaves open, the guess, and rotations
/// spread evenly; they are judged by the points of the one cloud that lie on the other, and by the points that lie
/// where the scanner saw that there is nothing; the best are refined by PCL's point-to-plane ICP.
///
/// Honours setIndices, setMaxCorrespondenceDistance (default: chosen from the data), setMaximumIterations and the
/// epsilons of the refinement. Points that are not finite are left out. Where nothing fits, hasConverged() is false,
/// the transformation the identity, and the output the source as it was.
///
/// \code
/// pcl_symmetry::SymmetryRegistration<pcl::PointXYZ, pcl::PointXYZ> registration;
/// registration.setInputSource(scan);
/// registration.setInputTarget(model);
/// registration.align(aligned);
/// \endcode
template <typename PointSource, typename PointTarget, typename Scalar = float>
class SymmetryRegistration : public pcl::Registration<PointSource, PointTarget, Scalar> {
public:
  using Base = pcl::Registration<PointSource, PointTarget, Scalar>;
  using Ptr = pcl::shared_ptr<SymmetryRegistration<PointSource, PointTarget, Scalar>>;
  using ConstPtr = pcl::shared_ptr<const SymmetryRegistration<PointSource, PointTarget, Scalar>>;
  using typename Base::Matrix4;
  using typename Base::PointCloudSource;

  SymmetryRegistration();

  using Base::getFitnessScore;
  /// As that of the base class, which in PCL 1.13 aborts at points that are not finite: they are left out here.
  /// \return mean squared distance of the source from the target, of the points within \p max_range squared units; the
  /// greatest double where there is none.
  double getFitnessScore(double max_range = std::numeric_limits<double>::max());

  /// Where the scanners stood; by default the data decide, as in SymmetryMaximaRefinement.
  void setSourceViewpoint(const Viewpoint& viewpoint) { source_viewpoint_ = viewpoint; }
  void setTargetViewpoint(const Viewpoint& viewpoint) { target_viewpoint_ = viewpoint; }

  /// Says converged where getScore().merit() reaches this, in [-1, 1]; default 0.4: scans of benchmark models, also
  /// noisy ones and such with holes, reach 0.5 at their own model, and stay below 0.32 at models of other kinds.
  void setMinMerit(double min_merit);
  /// Tries the frames of both clouds (default), or rotations spread evenly alone.
  void setUseFrames(bool use_frames) { options_.frames = use_frames; }
  /// Of the search for poses. \throws pcl::BadArgumentException naming field, value and rule.
  void setSearchOptions(const PoseSearchOptions& options);
  const PoseSearchOptions& getSearchOptions() const { return options_.search; }
  /// Of larger clouds so many points are drawn, >= 3; default 10 000.
  void setMaxPoints(std::size_t max_points);
  void setRandomSeed(std::uint64_t seed) { options_.seed = seed; }
  /// 0 = one per core (default). The result does not depend on it.
  void setNumberOfThreads(int num_threads);

  /// Of the last align(): what the clouds say about the transformation, or about the best that was found where nothing
  /// fits.
  const PoseScore& getScore() const { return score_; }
  /// Of the last align(): stages and their milliseconds, in order.
  const std::vector<std::pair<std::string, double>>& getTiming() const { return timing_ms_; }

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

  void computeTransformation(PointCloudSource& output, const Matrix4& guess) override;

private:
  Viewpoint source_viewpoint_, target_viewpoint_;
  CloudRegistrationOptions options_;
  double min_merit_ = 0.4;
  std::size_t max_points_ = 10'000;
  PoseScore score_;
  std::vector<std::pair<std::string, double>> timing_ms_;
};

}  // namespace pcl_symmetry
