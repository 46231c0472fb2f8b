#pragma once

#include <pcl/search/kdtree.h>
#include <pcl/impl/pcl_base.hpp>

#include <algorithm>

#include "pcl_symmetry/core/neighbours/closest_point_search.h"
#include "pcl_symmetry/symmetry_segmentation.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

namespace detail {

/// \return whether any polygon with finite corners has an area.
/// \throws std::invalid_argument where the mesh refers to vertices that it does not have.
bool hasArea(const pcl::PolygonMesh& mesh);

}  // namespace detail

template <typename PointT>
void SymmetrySegmentation<PointT>::segment(std::vector<pcl::PointIndices>& segments) {
  segments.clear();
  detail::withBadArguments([&] { mesh_ ? segmentMesh() : segmentCloud(); });
  segments.resize(static_cast<std::size_t>(segmentation_.num_segments));
  for (pcl::PointIndices& segment : segments) segment.header = mesh_ ? mesh_->header : input_->header;
  for (std::size_t i = 0; i < labels_.size(); ++i)
    if (labels_[i] >= 0) segments[labels_[i]].indices.push_back(static_cast<pcl::index_t>(i));
}

template <typename PointT>
void SymmetrySegmentation<PointT>::segmentMesh() {
  clearResults();
  if (!detail::hasArea(*mesh_)) {
    this->giveNoAnswer("mesh: no polygon has an area");
    return;
  }
  segmentation_ = segmentSurface(meshGraph(*mesh_), options_);
  labels_ = segmentation_.labels;
}

template <typename PointT>
void SymmetrySegmentation<PointT>::segmentCloud() {
  const Points points = this->selectInput(options_.seed);
  if (points.cols() == 0) return;
  const pcl::Indices& used = this->getUsedIndices();
  segmentation_ = segmentSurface(cloudGraph(points, neighborsOf(used)), options_);

  labels_.assign(input_->size(), -1);
  const detail::SelectedPoints all =
      detail::selectPoints(*input_, use_indices_ ? indices_.get() : nullptr, input_->size(), options_.seed);
  std::vector<int> closest;
  std::vector<float> sq_distances;
  makeFlannSearch(points)->search(all.points, 1, closest, sq_distances);
  for (std::size_t i = 0; i < all.indices.size(); ++i) labels_[all.indices[i]] = segmentation_.labels[closest[i]];
  for (std::size_t i = 0; i < used.size(); ++i) labels_[used[i]] = segmentation_.labels[i];
}

template <typename PointT>
std::vector<std::vector<int>> SymmetrySegmentation<PointT>::neighborsOf(const pcl::Indices& used) const {
  const auto num_neighbors = std::min<std::size_t>(num_neighbors_, used.size() - 1);
  const auto cloud = pcl::make_shared<pcl::PointCloud<PointT>>(*input_, used);
  const SearchPtr search = search_ ? search_ : pcl::make_shared<pcl::search::KdTree<PointT>>();
  search->setInputCloud(cloud);
  std::vector<std::vector<int>> neighbors(cloud->size());
  pcl::Indices found;
  std::vector<float> sq_distances;
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    search->nearestKSearch((*cloud)[i], static_cast<int>(num_neighbors) + 1, found, sq_distances);
    for (const pcl::index_t j : found)
      if (static_cast<std::size_t>(j) != i && neighbors[i].size() < num_neighbors) neighbors[i].push_back(j);
  }
  return neighbors;
}

}  // namespace pcl_symmetry

#define PCL_INSTANTIATE_SymmetrySegmentation(T) \
  template class PCL_SYMMETRY_EXPORTS pcl_symmetry::SymmetrySegmentation<T>;
