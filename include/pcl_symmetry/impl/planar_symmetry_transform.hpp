#pragma once

#include <pcl/impl/pcl_base.hpp>

#include "pcl_symmetry/impl/bad_argument.hpp"
#include "pcl_symmetry/impl/point_selection.hpp"
#include "pcl_symmetry/impl/seen_space.hpp"
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
  withBadArguments([&] { options.validate(); });
  edt_options_ = options;
}

template <typename PointT>
void PlanarSymmetryTransform<PointT>::setMapSize(int num_theta, int num_phi, int num_radius) {
  withBadArguments([&] { PlaneGrid(num_theta, num_phi, num_radius, Eigen::Vector3d::Zero(), 1.0); });
  num_theta_ = num_theta;
  num_phi_ = num_phi;
  num_radius_ = num_radius;
}

template <typename PointT>
void PlanarSymmetryTransform<PointT>::setSigma(double sigma) {
  GaussianEdtOptions options = edt_options_;
  options.sigma = sigma;
  withBadArguments([&] { options.validate(); });
  edt_options_ = options;
}

template <typename PointT>
void PlanarSymmetryTransform<PointT>::setBounds(const Eigen::Vector3d& center, double radius) {
  withBadArguments([&] { PlaneGrid(1, 2, 1, center, radius); });
  edt_options_.center = center;
  edt_options_.radius = radius;
}

template <typename PointT>
void PlanarSymmetryTransform<PointT>::setNumSamples(int num_samples) {
  SampledTransformOptions options = transform_.sampled;
  options.num_samples = num_samples;
  withBadArguments([&] { options.validate(); });
  transform_.sampled = options;
}

template <typename PointT>
void PlanarSymmetryTransform<PointT>::setNumPairs(std::int64_t num_pairs) {
  VotingTransformOptions options = transform_.voting;
  options.num_pairs = num_pairs;
  withBadArguments([&] { options.validate(); });
  transform_.voting = options;
}

template <typename PointT>
void PlanarSymmetryTransform<PointT>::setMaxPoints(std::size_t max_points) {
  if (max_points < 2) PCL_THROW_EXCEPTION(pcl::BadArgumentException, "max_points = " << max_points << ", must be >= 2");
  max_points_ = max_points;
}

template <typename PointT>
void PlanarSymmetryTransform<PointT>::setRandomSeed(std::uint64_t seed) {
  transform_.sampled.seed = transform_.voting.seed = seed;
}

template <typename PointT>
void PlanarSymmetryTransform<PointT>::setNumberOfThreads(int num_threads) {
  if (num_threads < 0)
    PCL_THROW_EXCEPTION(pcl::BadArgumentException, "num_threads = " << num_threads << ", must be >= 0");
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
  return withBadArguments([&] {
    if (!input_) throw std::invalid_argument("input cloud: not set, must be given by setInputCloud");
    const SelectedPoints selected =
        selectPoints(*input_, use_indices_ ? indices_.get() : nullptr, max_points_, transform_.sampled.seed);
    edt_ = std::make_shared<GaussianEdt>(selected.points, edt_options_);
    const PlaneGrid grid(num_theta_, num_phi_, num_radius_, edt_->center(), edt_->radius());
    const std::optional<Visibility> seen = seenSpace(*input_, selected.points, viewpoint_);
    return planarTransform(*edt_, grid, centerOfMass(selected.points), transform_, seen ? &*seen : nullptr);
  });
}

}  // namespace pcl_symmetry

#define PCL_INSTANTIATE_PlanarSymmetryTransform(T) template class pcl_symmetry::PlanarSymmetryTransform<T>;
