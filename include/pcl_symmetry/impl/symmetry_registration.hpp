#pragma once

#include <pcl/common/point_tests.h>
#include <pcl/common/transforms.h>
#include <pcl/search/kdtree.h>
#include <pcl/impl/pcl_base.hpp>

#include <cmath>
#include <limits>

#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/symmetry_registration.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

namespace detail {

/// Finds nothing near points that are not finite, at which PCL's tree would abort: pcl::Registration::getFitnessScore()
/// then leaves them out.
template <typename PointT>
class FinitePointTree : public pcl::search::KdTree<PointT> {
public:
  using pcl::search::KdTree<PointT>::nearestKSearch;
  int nearestKSearch(const PointT& point, int k, pcl::Indices& indices,
                     std::vector<float>& sq_distances) const override {
    if (pcl::isXYZFinite(point)) return pcl::search::KdTree<PointT>::nearestKSearch(point, k, indices, sq_distances);
    sq_distances.assign(static_cast<std::size_t>(k), std::numeric_limits<float>::infinity());
    return 0;
  }
};

}  // namespace detail

template <typename PointSource, typename PointTarget, typename Scalar>
SymmetryRegistration<PointSource, PointTarget, Scalar>::SymmetryRegistration() {
  reg_name_ = "SymmetryRegistration";
  tree_ = pcl::make_shared<detail::FinitePointTree<PointTarget>>();
  max_iterations_ = options_.max_iterations;
  transformation_epsilon_ = options_.transformation_epsilon;
}

template <typename PointSource, typename PointTarget, typename Scalar>
void SymmetryRegistration<PointSource, PointTarget, Scalar>::computeTransformation(PointCloudSource& output,
                                                                                   const Matrix4& guess) {
  result_ = {};
  const detail::SelectedPoints source = detail::selectPoints(*input_, indices_.get(), max_points_, options_.seed);
  reason_ = detail::reasonForNoAnswer(source.points, "source", kLeastRegistrationPoints,
                                      this->use_indices_ ? indices_.get() : nullptr);
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
  const SeenSpace seen = detail::findSeenSpace(*target_, target.points, target_viewpoint_);
  prepared_target_ = registrationTarget(target.points, detail::visibilityOf(seen), options_);
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
  const SeenSpace seen = detail::findSeenSpace(*input_, source, source_viewpoint_, is_part);
  result_ = registerClouds(source, detail::visibilityOf(seen), *prepared_target_,
                           Eigen::Isometry3d(guess.template cast<double>()), options);
  if (result_.converged(min_confidence_)) {
    final_transformation_ = transformation_ = result_.T_target_source.matrix().template cast<Scalar>();
    return;
  }
  reason_ = result_.doubt(min_confidence_);
  result_.covariance.reset();
}

}  // namespace pcl_symmetry
