#pragma once

#include <pcl/common/point_tests.h>
#include <pcl/common/transforms.h>
#include <pcl/impl/pcl_base.hpp>

#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/registration/symmetry_registration.h"

namespace pcl_symmetry {

template <typename PointSource, typename PointTarget, typename Scalar>
SymmetryRegistration<PointSource, PointTarget, Scalar>::SymmetryRegistration() {
  reg_name_ = "SymmetryRegistration";
  max_iterations_ = options_.max_iterations;
  transformation_epsilon_ = options_.transformation_epsilon;
}

template <typename PointSource, typename PointTarget, typename Scalar>
void SymmetryRegistration<PointSource, PointTarget, Scalar>::setMinMerit(double min_merit) {
  if (!(min_merit >= -1.0 && min_merit <= 1.0)) {
    std::ostringstream message;
    message << "min_merit = " << min_merit << ", must be in [-1, 1]";
    detail::throwBadArgument(message.str());
  }
  min_merit_ = min_merit;
}

template <typename PointSource, typename PointTarget, typename Scalar>
void SymmetryRegistration<PointSource, PointTarget, Scalar>::setSearchOptions(const PoseSearchOptions& options) {
  detail::withBadArguments([&] { options.validate(); });
  options_.search = options;
}

template <typename PointSource, typename PointTarget, typename Scalar>
void SymmetryRegistration<PointSource, PointTarget, Scalar>::setMaxPoints(std::size_t max_points) {
  detail::checkAtLeast("max_points", static_cast<std::int64_t>(max_points), 3);
  max_points_ = max_points;
}

template <typename PointSource, typename PointTarget, typename Scalar>
void SymmetryRegistration<PointSource, PointTarget, Scalar>::setNumberOfThreads(int num_threads) {
  detail::checkAtLeast("num_threads", static_cast<std::int64_t>(num_threads), 0);
  options_.num_threads = num_threads;
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
  timing_ms_.clear();
  try {
    const detail::SelectedPoints source = detail::selectPoints(*input_, indices_.get(), max_points_, options_.seed);
    const detail::SelectedPoints target = detail::selectPoints(*target_, nullptr, max_points_, options_.seed);
    CloudRegistrationOptions options = options_;
    options.max_iterations = max_iterations_;
    options.transformation_epsilon = transformation_epsilon_;
    options.rotation_epsilon = transformation_rotation_epsilon_;
    if (corr_dist_threshold_ < std::sqrt(std::numeric_limits<double>::max()))
      options.max_correspondence = corr_dist_threshold_;
    const CloudRegistration result =
        registerClouds(source.points, detail::seenSpace(*input_, source.points, source_viewpoint_), target.points,
                       detail::seenSpace(*target_, target.points, target_viewpoint_),
                       Eigen::Isometry3d(guess.template cast<double>()), options);
    score_ = result.score;
    timing_ms_ = result.timing_ms;
    if (!(score_.merit() >= min_merit_)) {
      PCL_ERROR("[pcl_symmetry::%s::computeTransformation] Nothing fits: support %g, conflict %g\n",
                getClassName().c_str(), score_.support, score_.conflict);
      return;
    }
    final_transformation_ = transformation_ = result.T_target_source.matrix().template cast<Scalar>();
  } catch (const std::invalid_argument& error) {
    PCL_ERROR("[pcl_symmetry::%s::computeTransformation] %s\n", getClassName().c_str(), error.what());
    return;
  }
  converged_ = true;
  if constexpr (pcl::traits::has_normal<PointSource>::value)
    pcl::transformPointCloudWithNormals(output, output, final_transformation_);
  else
    pcl::transformPointCloud(output, output, final_transformation_);
}

}  // namespace pcl_symmetry

#define PCL_INSTANTIATE_SymmetryRegistration(S, T, Scalar) \
  template class pcl_symmetry::SymmetryRegistration<S, T, Scalar>;
