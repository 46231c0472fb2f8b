#pragma once

#include <pcl/PolygonMesh.h>
#include <pcl/pcl_base.h>
#include <pcl/search/search.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/detection/plane_detection.h"
#include "pcl_symmetry/viewpoint.h"

namespace pcl_symmetry {

/// From a cloud to its planes of symmetry: local maxima of the transform, refined by Iterative Symmetric Points
/// (Section 4.4 of the paper).
///
/// Honours setIndices; points that are not finite are left out. Without a map it makes its own. With the defaults
/// nothing has to be tuned, and a shape without symmetry gives no plane.
template <typename PointT>
class SymmetryMaximaRefinement : public pcl::PCLBase<PointT> {
public:
  using Ptr = pcl::shared_ptr<SymmetryMaximaRefinement<PointT>>;
  using ConstPtr = pcl::shared_ptr<const SymmetryMaximaRefinement<PointT>>;
  using SearchPtr = typename pcl::search::Search<PointT>::Ptr;

  /// Every option at once. \throws pcl::BadArgumentException naming field, value and rule.
  void setOptions(const DetectionOptions& options);
  const DetectionOptions& getOptions() const { return options_; }

  /// Planes of at least this confidence are symmetries, in [0, 1]; default 0.5.
  void setMinConfidence(double min_confidence);
  /// Also reports maxima below that: approximate symmetries and symmetries of parts, marked as such; default false.
  void setApproximate(bool approximate);
  void setMaxPlanes(int max_planes);
  /// Cells of the distance transform along each side, in [8, 512]; default 64.
  void setGridSize(int num_cells);
  /// Width of the Gaussian, input units, > 0; default two cells.
  void setSigma(double sigma);
  void setRandomSeed(std::uint64_t seed);
  /// 0 = one per core (default). The result does not depend on it.
  void setNumberOfThreads(int num_threads);
  /// Of larger clouds so many points are drawn, >= 2; default 50 000.
  void setMaxPoints(std::size_t max_points);

  /// Where the scanner stood. By default the data decide: an organized cloud tells by its own rays, another one by its
  /// sensor_origin_ if the points can have been seen from there. Reflections that land in space that the scanner saw to
  /// be empty then speak against a plane, those that land behind the surface do not.
  void setViewpointMode(Viewpoint::Mode mode) { viewpoint_.mode = mode; }
  /// The scanner stood here, input frame.
  void setViewpoint(const Eigen::Vector3d& position) { viewpoint_ = {Viewpoint::Mode::Given, position}; }
  void setViewpoint(const Viewpoint& viewpoint) { viewpoint_ = viewpoint; }
  const Viewpoint& getViewpoint() const { return viewpoint_; }

  /// Any PCL search in place of our own FLANN tree, except OrganizedNeighbor (reflected points lie behind what the
  /// sensor saw). It is given a cloud of the points used, and is called from one thread at a time.
  void setSearchMethod(const SearchPtr& search) { search_ = search; }

  /// Maxima of this map in place of one made here.
  /// \param map,edt of PlanarSymmetryTransform for the same cloud.
  void setSymmetryMap(const SymmetryMap& map, const std::shared_ptr<const GaussianEdt>& edt);

  /// \return planes, best first, in the frame of the input.
  /// \throws pcl::BadArgumentException without input, or where the finite points have no extent.
  std::vector<SymmetryPlane> compute();

  /// Support of every point of the input cloud, also of those that compute() did not use; NaN for points that are not
  /// finite. Follows a compute().
  std::vector<float> computePointSupport(const ReflectionPlane& plane) const;

  /// Of the last compute(): axes of revolution, best first, in the frame of the input.
  const std::vector<SymmetryAxis>& getAxes() const { return axes_; }
  /// Of the last compute(): centers of spheres.
  const std::vector<SymmetryCenter>& getCenters() const { return centers_; }
  /// Of the last compute(): the map whose maxima were refined.
  const SymmetryMap& getSymmetryMap() const { return edt_ ? map_ : own_map_; }
  /// Of the last compute(): whether a viewpoint was used.
  bool usedViewpoint() const { return used_viewpoint_; }
  /// Of the last compute(): the points used, in the order of SymmetryPlane::point_support.
  const pcl::Indices& getUsedIndices() const { return used_indices_; }
  /// Of the last compute(): stages and their milliseconds, in order.
  const std::vector<std::pair<std::string, double>>& getTiming() const { return timing_ms_; }

protected:
  using pcl::PCLBase<PointT>::input_;
  using pcl::PCLBase<PointT>::indices_;
  using pcl::PCLBase<PointT>::use_indices_;

private:
  DetectionOptions options_;
  std::size_t max_points_ = 50'000;
  SearchPtr search_;
  Viewpoint viewpoint_;
  bool used_viewpoint_ = false;
  SymmetryMap map_, own_map_;  // given; made here
  std::shared_ptr<const GaussianEdt> edt_;
  pcl::Indices used_indices_;
  Points used_points_;
  std::vector<SymmetryAxis> axes_;
  std::vector<SymmetryCenter> centers_;
  std::vector<std::pair<std::string, double>> timing_ms_;
};

/// The planes of symmetry of a cloud, best first; none where it has none.
/// \throws pcl::BadArgumentException where the finite points have no extent.
template <typename PointT>
std::vector<SymmetryPlane> detectSymmetryPlanes(const pcl::PointCloud<PointT>& cloud,
                                                const DetectionOptions& options = {});

/// The same for a mesh, by points spread over it.
std::vector<SymmetryPlane> detectSymmetryPlanes(const pcl::PolygonMesh& mesh, const DetectionOptions& options = {},
                                                int num_points = 10'000);

}  // namespace pcl_symmetry
