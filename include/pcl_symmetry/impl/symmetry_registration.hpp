#pragma once

#include <pcl/common/point_tests.h>
#include <pcl/common/transforms.h>
#include <pcl/impl/pcl_base.hpp>

#include <cmath>
#include <limits>
#include <sstream>

#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/symmetry_registration.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

template <typename PointSource, typename PointTarget, typename Scalar>
SymmetryRegistration<PointSource, PointTarget, Scalar>::SymmetryRegistration() {
  reg_name_ = "SymmetryRegistration";
  max_iterations_ = options_.max_iterations;
  transformation_epsilon_ = options_.transformation_epsilon;
}

template <typename PointSource, typename PointTarget, typename Scalar>
double SymmetryRegistration<PointSource, PointTarget, Scalar>::getFitnessScore(double max_range) {
  PointCloudSource moved;
  pcl::transformPointCloud(*input_, moved, final_transformation_);
  pcl::Indices closest(1);
  std::vector<float> sq_distance(1);
  double sum = 0.0;
  std::size_t count = 0;
  for (const PointSource& point : moved) {
    if (!pcl::isXYZFinite(point) || tree_->nearestKSearch(point, 1, closest, sq_distance) < 1) continue;
    if (sq_distance[0] > max_range) continue;
    sum += sq_distance[0];
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : std::numeric_limits<double>::max();
}

template <typename PointSource, typename PointTarget, typename Scalar>
void SymmetryRegistration<PointSource, PointTarget, Scalar>::computeTransformation(PointCloudSource& output,
                                                                                   const Matrix4& guess) {
  score_ = {};
  poses_.clear();
  covariance_.reset();
  timing_ms_.clear();
  const detail::SelectedPoints source = detail::selectPoints(*input_, indices_.get(), max_points_, options_.seed);
  reason_ = detail::reasonForNoAnswer(source.points, "source", kLeastRegistrationPoints);
  detail::withBadArguments([&] {
    if (reason_.empty()) prepareTarget();
    if (reason_.empty()) findPose(source.points, guess);
  });
  if (!reason_.empty()) {
    detail::warnOfNoAnswer(getClassName(), reason_);
    return;
  }
  converged_ = true;
  if constexpr (pcl::traits::has_normal<PointSource>::value)
    pcl::transformPointCloudWithNormals(output, output, final_transformation_);
  else
    pcl::transformPointCloud(output, output, final_transformation_);
}

template <typename PointSource, typename PointTarget, typename Scalar>
void SymmetryRegistration<PointSource, PointTarget, Scalar>::prepareTarget() {
  if (prepared_target_) return;
  const detail::SelectedPoints target = detail::selectPoints(*target_, nullptr, max_points_, options_.seed);
  reason_ = detail::reasonForNoAnswer(target.points, "target", kLeastRegistrationPoints);
  if (!reason_.empty()) return;
  const std::optional<Visibility> seen = target_seen_space_
                                             ? detail::visibilityOf(*target_seen_space_)
                                             : detail::seenSpace(*target_, target.points, target_viewpoint_);
  prepared_target_.emplace(target.points, seen, options_);
}

template <typename PointSource, typename PointTarget, typename Scalar>
void SymmetryRegistration<PointSource, PointTarget, Scalar>::findPose(const Points& source, const Matrix4& guess) {
  CloudRegistrationOptions options = options_;
  options.max_iterations = max_iterations_;
  options.transformation_epsilon = transformation_epsilon_;
  options.rotation_epsilon = transformation_rotation_epsilon_;
  if (corr_dist_threshold_ < std::sqrt(std::numeric_limits<double>::max()))
    options.max_correspondence = corr_dist_threshold_;
  const bool is_part = this->use_indices_ && indices_->size() < input_->size();
  const std::optional<Visibility> source_seen = source_seen_space_
                                                    ? detail::visibilityOf(*source_seen_space_)
                                                    : detail::seenSpace(*input_, source, source_viewpoint_, is_part);
  const CloudRegistration result =
      registerClouds(source, source_seen, *prepared_target_, Eigen::Isometry3d(guess.template cast<double>()), options);
  poses_ = result.poses;
  score_ = result.score;
  timing_ms_ = result.timing_ms;
  if (score_.merit() >= min_merit_) {
    covariance_ = result.covariance;
    final_transformation_ = transformation_ = result.T_target_source.matrix().template cast<Scalar>();
    return;
  }
  std::ostringstream reason;
  reason << "nothing fits" << (options_.around ? " around the guess" : "") << ": the best pose has support "
         << score_.support << " and conflict " << score_.conflict;
  reason_ = reason.str();
}

}  // namespace pcl_symmetry

// The attribute of GNU, because Clang takes none in brackets here.
#define PCL_INSTANTIATE_SymmetryRegistration(S, T, Scalar) \
  template class __attribute__((visibility("default"))) pcl_symmetry::SymmetryRegistration<S, T, Scalar>;
