#pragma once

#include <pcl/console/print.h>
#include <pcl/search/kdtree.h>
#include <pcl/impl/pcl_base.hpp>

#include <algorithm>
#include <stdexcept>

#include "pcl_symmetry/core/neighbours/closest_point_search.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/symmetry_segmentation.h"

namespace pcl_symmetry {

template <typename PointT>
void SymmetrySegmentation<PointT>::setOptions(const SegmentationOptions& options) {
  detail::withBadArguments([&] { options.validate(); });
  options_ = options;
}

template <typename PointT>
void SymmetrySegmentation<PointT>::setDepth(int depth) {
  SegmentationOptions options = options_;
  options.splitting.depth = depth;
  setOptions(options);
}

template <typename PointT>
void SymmetrySegmentation<PointT>::setNumberOfParts(int num_parts) {
  SegmentationOptions options = options_;
  options.num_parts = num_parts;
  setOptions(options);
}

template <typename PointT>
void SymmetrySegmentation<PointT>::setNumberOfThreads(int num_threads) {
  SegmentationOptions options = options_;
  options.num_threads = num_threads;
  setOptions(options);
}

template <typename PointT>
void SymmetrySegmentation<PointT>::setNumberOfNeighbors(int num_neighbors) {
  detail::checkAtLeast("num_neighbors", static_cast<std::int64_t>(num_neighbors), 3);
  num_neighbors_ = num_neighbors;
}

template <typename PointT>
void SymmetrySegmentation<PointT>::setMaxPoints(std::size_t max_points) {
  detail::checkAtLeast("max_points", static_cast<std::int64_t>(max_points), 10);
  max_points_ = max_points;
}

template <typename PointT>
void SymmetrySegmentation<PointT>::segment(std::vector<pcl::PointIndices>& segments) {
  segments.clear();
  labels_.clear();
  segmentation_ = {};
  try {
    if (mesh_)
      segmentMesh();
    else
      segmentCloud();
  } catch (const std::invalid_argument& error) {
    PCL_ERROR("[pcl_symmetry::SymmetrySegmentation::segment] %s.\n", error.what());
    segmentation_ = {};
    labels_.clear();
    return;
  }
  segments.resize(static_cast<std::size_t>(segmentation_.num_segments));
  for (pcl::PointIndices& segment : segments) segment.header = mesh_ ? mesh_->header : input_->header;
  for (std::size_t i = 0; i < labels_.size(); ++i)
    if (labels_[i] >= 0) segments[labels_[i]].indices.push_back(static_cast<pcl::index_t>(i));
}

template <typename PointT>
void SymmetrySegmentation<PointT>::segmentMesh() {
  segmentation_ = segmentSurface(meshGraph(*mesh_), options_);
  labels_ = segmentation_.labels;
}

template <typename PointT>
void SymmetrySegmentation<PointT>::segmentCloud() {
  if (!input_) throw std::invalid_argument("input: not set, must be given by setInputCloud or setInputMesh");
  const pcl::Indices* indices = use_indices_ ? indices_.get() : nullptr;
  const detail::SelectedPoints used = detail::selectPoints(*input_, indices, max_points_, options_.seed);
  const auto num_neighbors = std::min<std::size_t>(num_neighbors_, std::max<Eigen::Index>(1, used.points.cols()) - 1);
  const auto cloud = pcl::make_shared<pcl::PointCloud<PointT>>(*input_, used.indices);
  const SearchPtr search = search_ ? search_ : pcl::make_shared<pcl::search::KdTree<PointT>>();
  std::vector<std::vector<int>> neighbors(cloud->size());
  if (num_neighbors > 0) search->setInputCloud(cloud);
  pcl::Indices found;
  std::vector<float> sq_distances;
  for (std::size_t i = 0; i < cloud->size() && num_neighbors > 0; ++i) {
    search->nearestKSearch((*cloud)[i], static_cast<int>(num_neighbors) + 1, found, sq_distances);
    for (const pcl::index_t j : found)
      if (static_cast<std::size_t>(j) != i && neighbors[i].size() < num_neighbors) neighbors[i].push_back(j);
  }
  segmentation_ = segmentSurface(cloudGraph(used.points, neighbors), options_);

  labels_.assign(input_->size(), -1);
  const detail::SelectedPoints all = detail::selectPoints(*input_, indices, input_->size(), options_.seed);
  std::vector<int> closest;
  makeFlannSearch(used.points)->search(all.points, 1, closest, sq_distances);
  for (std::size_t i = 0; i < all.indices.size(); ++i) labels_[all.indices[i]] = segmentation_.labels[closest[i]];
  for (std::size_t i = 0; i < used.indices.size(); ++i) labels_[used.indices[i]] = segmentation_.labels[i];
}

}  // namespace pcl_symmetry

#define PCL_INSTANTIATE_SymmetrySegmentation(T) template class pcl_symmetry::SymmetrySegmentation<T>;
