#pragma once

#include <pcl/PointIndices.h>
#include <pcl/PolygonMesh.h>
#include <pcl/pcl_base.h>
#include <pcl/search/search.h>

#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/segmentation/surface_segmentation.h"

namespace pcl_symmetry {

/// Cuts a cloud or a mesh into parts by its symmetries (Section 5.3 of the paper).
///
/// Input is a cloud (setInputCloud, setIndices; points that are not finite belong to no segment) or a mesh
/// (setInputMesh; then indices and labels count its polygons). The cloud is a surface seen from all sides: thickness
/// and line of sight need an inside.
template <typename PointT>
class SymmetrySegmentation : public pcl::PCLBase<PointT> {
public:
  using Ptr = pcl::shared_ptr<SymmetrySegmentation<PointT>>;
  using ConstPtr = pcl::shared_ptr<const SymmetrySegmentation<PointT>>;
  using SearchPtr = typename pcl::search::Search<PointT>::Ptr;

  /// Every option at once. \throws pcl::BadArgumentException naming field, value and rule.
  void setOptions(const SegmentationOptions& options);
  const SegmentationOptions& getOptions() const { return options_; }

  /// Faces of this mesh instead of points; null goes back to the cloud.
  void setInputMesh(const pcl::PolygonMesh::ConstPtr& mesh) { mesh_ = mesh; }

  /// Splits in a row at most, for SegmentationMethod::Splitting; default 3.
  void setDepth(int depth);
  /// Exactly so many parts where the shape allows; 0 = as many as the method finds (default).
  void setNumberOfParts(int num_parts);
  void setRandomSeed(std::uint64_t seed) { options_.seed = seed; }
  /// 0 = one per core (default). The result does not depend on it.
  void setNumberOfThreads(int num_threads);

  /// Any PCL search for the neighbourhood of the points, in place of a k-d tree. It is given a cloud of the points
  /// used.
  void setSearchMethod(const SearchPtr& search) { search_ = search; }
  /// Points that each point is joined with, >= 3; default 12.
  void setNumberOfNeighbors(int num_neighbors);
  /// Of larger clouds so many points are drawn, >= 10, and the others follow the closest of them; default 30 000.
  void setMaxPoints(std::size_t max_points);

  /// \param segments by falling area: indices into the cloud or the polygons of the mesh. Without input or extent it is
  /// empty, and the reason goes to PCL_ERROR.
  void segment(std::vector<pcl::PointIndices>& segments);

  /// Of the last segment(): per point of the cloud or polygon of the mesh its segment, -1 for none.
  const std::vector<int>& getLabels() const { return labels_; }
  /// Of the last segment(): how the parts came about, the root first.
  const std::vector<SegmentNode>& getTree() const { return segmentation_.tree; }

  /// Of the last segment(): per plane that maps most of the surface onto itself, the segment that each one is reflected
  /// onto.
  const std::vector<std::vector<int>>& getImages() const { return segmentation_.images; }

protected:
  using pcl::PCLBase<PointT>::input_;
  using pcl::PCLBase<PointT>::indices_;
  using pcl::PCLBase<PointT>::use_indices_;

private:
  void segmentMesh();
  void segmentCloud();

  SegmentationOptions options_;
  pcl::PolygonMesh::ConstPtr mesh_;
  SearchPtr search_;
  int num_neighbors_ = 12;
  std::size_t max_points_ = 30'000;
  Segmentation segmentation_;
  std::vector<int> labels_;
};

/// The faces of a mesh as a graph. \throws std::invalid_argument as meshGraph() does.
SurfaceGraph meshGraph(const pcl::PolygonMesh& mesh);

}  // namespace pcl_symmetry
