#pragma once

#include <pcl/impl/pcl_base.hpp>

#include "core/distance_transform/free_space.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/mesh_sampling.h"
#include "pcl_symmetry/planar_symmetry_transform.h"

namespace pcl_symmetry {

template <typename PointT>
void PlanarSymmetryTransform<PointT>::setGridSize(int n) {
  setNumCells(n);
  setMapSize(n, n, n);
}

template <typename PointT>
void PlanarSymmetryTransform<PointT>::setNumCells(int num_cells) {
  GaussianEdtOptions options = edt_options_;
  options.num_cells = num_cells;
  detail::withBadArguments([&] { options.validate(); });
  edt_options_ = options;
}

template <typename PointT>
void PlanarSymmetryTransform<PointT>::setMapSize(int num_theta, int num_phi, int num_radius) {
  detail::withBadArguments([&] { PlaneGrid(num_theta, num_phi, num_radius, Eigen::Vector3d::Zero(), 1.0); });
  num_theta_ = num_theta;
  num_phi_ = num_phi;
  num_radius_ = num_radius;
}

template <typename PointT>
void PlanarSymmetryTransform<PointT>::setSigma(double sigma) {
  GaussianEdtOptions options = edt_options_;
  options.sigma = sigma;
  detail::withBadArguments([&] { options.validate(); });
  edt_options_ = options;
}

template <typename PointT>
void PlanarSymmetryTransform<PointT>::setBounds(const Eigen::Vector3d& center, double radius) {
  detail::withBadArguments([&] { PlaneGrid(1, 2, 1, center, radius); });
  edt_options_.center = center;
  edt_options_.radius = radius;
}

template <typename PointT>
void PlanarSymmetryTransform<PointT>::setNumSamples(int num_samples) {
  SampledTransformOptions options = transform_.sampled;
  options.num_samples = num_samples;
  detail::withBadArguments([&] { options.validate(); });
  transform_.sampled = options;
}

template <typename PointT>
void PlanarSymmetryTransform<PointT>::setNumPairs(std::int64_t num_pairs) {
  VotingTransformOptions options = transform_.voting;
  options.num_pairs = num_pairs;
  detail::withBadArguments([&] { options.validate(); });
  transform_.voting = options;
}

template <typename PointT>
void PlanarSymmetryTransform<PointT>::setMaxPoints(std::size_t max_points) {
  detail::checkAtLeast("max_points", static_cast<std::int64_t>(max_points), 2);
  max_points_ = max_points;
}

template <typename PointT>
void PlanarSymmetryTransform<PointT>::setRandomSeed(std::uint64_t seed) {
  transform_.sampled.seed = transform_.voting.seed = seed;
}

template <typename PointT>
void PlanarSymmetryTransform<PointT>::setNumberOfThreads(int num_threads) {
  detail::checkAtLeast("num_threads", static_cast<std::int64_t>(num_threads), 0);
  edt_options_.num_threads = transform_.sampled.num_threads = transform_.convolution.num_threads =
      transform_.voting.num_threads = num_threads;
}

template <typename PointT>
void PlanarSymmetryTransform<PointT>::setInputMesh(const pcl::PolygonMesh& mesh, int num_points) {
  const auto samples = sampleMesh(mesh, num_points);
  auto cloud = pcl::make_shared<pcl::PointCloud<PointT>>();
  cloud->header = mesh.header;
  cloud->resize(samples->size());
  for (std::size_t i = 0; i < samples->size(); ++i) (*cloud)[i].getVector3fMap() = (*samples)[i].getVector3fMap();
  this->setInputCloud(cloud);
}

template <typename PointT>
SymmetryMap PlanarSymmetryTransform<PointT>::compute() {
  return detail::withBadArguments([&] {
    if (!input_) throw std::invalid_argument("input cloud: not set, must be given by setInputCloud");
    const detail::SelectedPoints selected =
        detail::selectPoints(*input_, use_indices_ ? indices_.get() : nullptr, max_points_, transform_.sampled.seed);
    edt_ = std::make_shared<GaussianEdt>(selected.points, edt_options_);
    const PlaneGrid grid(num_theta_, num_phi_, num_radius_, edt_->center(), edt_->radius());
    const std::optional<Visibility> seen = detail::seenSpace(*input_, selected.points, viewpoint_);
    return planarTransform(*edt_, grid, centerOfMass(selected.points), transform_,
                           seen ? freeSpace(*edt_, *seen, edt_options_.num_threads) : std::vector<float>());
  });
}

}  // namespace pcl_symmetry

#define PCL_INSTANTIATE_PlanarSymmetryTransform(T) template class pcl_symmetry::PlanarSymmetryTransform<T>;
