#pragma once

#include <pcl/PolygonMesh.h>
#include <pcl/pcl_base.h>

#include <cstdint>
#include <memory>

#include "pcl_symmetry/core/transform/planar_transform.h"
#include "pcl_symmetry/viewpoint.h"

namespace pcl_symmetry {

/// The planar-reflective symmetry transform of a point cloud: a measure of its symmetry with respect to every plane
/// (Sections 3 and 4.1 to 4.3 of the paper).
///
/// Honours setIndices; points that are not finite are left out. With the defaults no unit and no tuning enters: the
/// grid covers the bounding ball of the points, sigma is two cells.
///
/// \code
/// pcl_symmetry::PlanarSymmetryTransform<pcl::PointXYZ> transform;
/// transform.setInputCloud(cloud);
/// const pcl_symmetry::SymmetryMap map = transform.compute();
/// const pcl_symmetry::ReflectionPlane plane = map.grid.plane(map.grid.bin(map.strongest()));
/// \endcode
template <typename PointT>
class PlanarSymmetryTransform : public pcl::PCLBase<PointT> {
public:
  using Ptr = pcl::shared_ptr<PlanarSymmetryTransform<PointT>>;
  using ConstPtr = pcl::shared_ptr<const PlanarSymmetryTransform<PointT>>;

  /// The estimator: sampled (default), convolution or voting; all give the same normalised quantity.
  void setMethod(TransformMethod method) { transform_.method = method; }
  TransformMethod getMethod() const { return transform_.method; }

  /// Cells of the distance transform and bins of theta, phi and r, n of each as in the paper; even, in [8, 512].
  void setGridSize(int n);
  /// Cells along each side of the distance transform alone, in [8, 512]; default 64.
  void setNumCells(int num_cells);
  /// Bins of the map alone; num_phi even; default 64 x 64 x 64.
  void setMapSize(int num_theta, int num_phi, int num_radius);

  /// Width of the Gaussian, input units, > 0; default two cells, or the spacing of the points where that is more.
  void setSigma(double sigma);
  /// Ball to cover instead of the bounding ball of the points, input frame and units; radius > 0.
  void setBounds(const Eigen::Vector3d& center, double radius);

  /// Points drawn by the sampled estimator, >= 1; default 128, for an error below 1 %.
  void setNumSamples(int num_samples);
  /// Pairs drawn by voting, >= 1; default 2 million.
  void setNumPairs(std::int64_t num_pairs);
  /// Of larger clouds so many points are drawn, >= 2; default 200 000.
  void setMaxPoints(std::size_t max_points);
  void setRandomSeed(std::uint64_t seed);
  /// 0 = one per core (default). The result does not depend on it.
  void setNumberOfThreads(int num_threads);

  /// Where the scanner stood; by default the data decide, as in SymmetryMaximaRefinement. With a viewpoint the map
  /// holds seenSymmetry() of D and of its counterpart for the space that the scanner saw to be empty.
  void setViewpointMode(Viewpoint::Mode mode) { viewpoint_.mode = mode; }
  /// The scanner stood here, input frame.
  void setViewpoint(const Eigen::Vector3d& position) { viewpoint_ = {Viewpoint::Mode::Given, position}; }
  void setViewpoint(const Viewpoint& viewpoint) { viewpoint_ = viewpoint; }
  const Viewpoint& getViewpoint() const { return viewpoint_; }

  /// Takes points spread over the mesh by area in place of a cloud (PointT needs nothing but x, y and z).
  void setInputMesh(const pcl::PolygonMesh& mesh, int num_points = 50'000);

  /// \return the map, in the frame and units of the input.
  /// \throws pcl::BadArgumentException without input, or where the finite points have no extent.
  SymmetryMap compute();

  /// The function f that the last map was made from; null before compute().
  std::shared_ptr<const GaussianEdt> getDistanceTransform() const { return edt_; }

protected:
  using pcl::PCLBase<PointT>::input_;
  using pcl::PCLBase<PointT>::indices_;
  using pcl::PCLBase<PointT>::use_indices_;

private:
  GaussianEdtOptions edt_options_;
  PlanarTransformOptions transform_;
  Viewpoint viewpoint_;
  int num_theta_ = 64, num_phi_ = 64, num_radius_ = 64;
  std::size_t max_points_ = 200'000;
  std::shared_ptr<const GaussianEdt> edt_;
};

}  // namespace pcl_symmetry
