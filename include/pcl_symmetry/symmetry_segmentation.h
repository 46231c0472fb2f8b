#pragma once

#include <pcl/PointIndices.h>
#include <pcl/PolygonMesh.h>

#include <vector>

#include "pcl_symmetry/core/surface_segmentation.h"
#include "pcl_symmetry/impl/pcl_search.hpp"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Cuts a cloud or a mesh into parts by its symmetries (Section 5.3 of the paper).
///
/// The input is a cloud (setInputCloud(), setIndices(); points that are not finite belong to no segment) or a mesh
/// (setInputMesh(); indices and labels count its polygons then), whichever was set last. The cloud has to show the
/// surface from all sides, because thickness and line of sight need an inside.
template <typename PointT>
class SymmetrySegmentation : public SearchingAnalysis<CloudAnalysis<PointT>, SegmentationOptions> {
public:
  using Ptr = pcl::shared_ptr<SymmetrySegmentation<PointT>>;
  using ConstPtr = pcl::shared_ptr<const SymmetrySegmentation<PointT>>;
  using typename pcl::PCLBase<PointT>::PointCloudConstPtr;

  /// Draws at most 30 000 points, see setMaxPoints(); other points belong to the segment of the closest one drawn.
  SymmetrySegmentation()
      : SearchingAnalysis<CloudAnalysis<PointT>, SegmentationOptions>("SymmetrySegmentation", 30'000, 20) {}

  /// Sets the cloud to segment, in place of the last cloud or mesh.
  void setInputCloud(const PointCloudConstPtr& cloud) override {
    CloudAnalysis<PointT>::setInputCloud(cloud);
    mesh_.reset();
  }
  /// Sets the mesh whose polygons are segmented, in place of the last mesh or of the cloud. Null: the cloud again.
  void setInputMesh(const pcl::PolygonMesh::ConstPtr& mesh) {
    mesh_ = mesh;
    clearResults();
  }

  /// \param num_parts number of parts where the shape allows it, >= 0; 0 = as many as the method finds (default).
  void setNumberOfParts(int num_parts) {
    this->change([&](SegmentationOptions& changed) { changed.num_parts = num_parts; });
  }

  /// Finds the parts.
  /// \param segments is filled with the segments, by decreasing area: indices into the cloud or into the polygons of
  /// the mesh. Empty if the input holds no answer. The shape may not allow the number of parts that was set: see
  /// getReason().
  /// \throws pcl::BadArgumentException if the mesh refers to vertices that it does not have.
  void segment(std::vector<pcl::PointIndices>& segments);
  /// The same under the name that PCL's clustering classes use.
  void extract(std::vector<pcl::PointIndices>& clusters) { segment(clusters); }

  /// \return the segment of each point of the cloud or polygon of the mesh, -1 for none; result of the last segment().
  const std::vector<int>& getLabels() const { return labels_; }
  /// \return how the parts of the last segment() came about, the root first.
  const std::vector<SegmentNode>& getTree() const { return segmentation_.tree; }
  /// \return for each plane that maps most of the surface onto itself, the segment that each segment is reflected onto;
  /// result of the last segment().
  const std::vector<std::vector<int>>& getImages() const { return segmentation_.images; }

protected:
  using pcl::PCLBase<PointT>::input_;
  using pcl::PCLBase<PointT>::indices_;
  using pcl::PCLBase<PointT>::use_indices_;

  void clearResults() override {
    CloudAnalysis<PointT>::clearResults();
    segmentation_ = {};
    labels_.clear();
  }

private:
  using SearchingAnalysis<CloudAnalysis<PointT>, SegmentationOptions>::options_;

  void segmentMesh();
  void segmentCloud();

  pcl::PolygonMesh::ConstPtr mesh_;
  Segmentation segmentation_;
  std::vector<int> labels_;
};

template <typename PointT>
void SymmetrySegmentation<PointT>::segment(std::vector<pcl::PointIndices>& segments) {
  segments.clear();
  detail::withBadArguments([&] { mesh_ ? segmentMesh() : segmentCloud(); });
  if (!segmentation_.reason.empty()) this->giveNoAnswer(segmentation_.reason);
  segments.resize(static_cast<std::size_t>(segmentation_.num_segments));
  for (pcl::PointIndices& segment : segments) segment.header = mesh_ ? mesh_->header : input_->header;
  for (std::size_t i = 0; i < labels_.size(); ++i)
    if (labels_[i] >= 0) segments[labels_[i]].indices.push_back(static_cast<pcl::index_t>(i));
}

template <typename PointT>
void SymmetrySegmentation<PointT>::segmentMesh() {
  clearResults();
  const detail::MeshArrays arrays = detail::toArrays(*mesh_);
  if (!arrays.hasArea()) {
    this->giveNoAnswer("mesh: no polygon has an area");
    return;
  }
  SegmentationOptions options = options_;
  options.make_search = this->makeSearch();
  segmentation_ = segmentSurface(meshGraph(arrays.vertices, arrays.polygons), options);
  labels_ = segmentation_.labels;
}

template <typename PointT>
void SymmetrySegmentation<PointT>::segmentCloud() {
  if (this->selectInput(options_.seed).cols() == 0) return;
  SegmentationOptions options = options_;
  options.make_search = this->makeSearch();
  const detail::SelectedPoints all =
      detail::selectPoints(*input_, use_indices_ ? indices_.get() : nullptr, input_->size(), options_.seed);
  segmentation_ = pcl_symmetry::segmentCloud(all.points, this->getUsedIndices().size(), options);
  labels_.assign(input_->size(), -1);
  for (std::size_t i = 0; i < all.indices.size(); ++i) labels_[all.indices[i]] = segmentation_.labels[i];
}

}  // namespace pcl_symmetry
