#pragma once

#include <pcl/PolygonMesh.h>

#include <cstdint>

#include "pcl_symmetry/core/planar_transform.h"
#include "pcl_symmetry/impl/transform_analysis.hpp"
#include "pcl_symmetry/mesh_sampling.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// The planar-reflective symmetry transform of a point cloud: a measure of its symmetry with respect to every plane
/// (Sections 3 and 4.1 to 4.3 of the paper).
///
/// The defaults need no tuning and suit any unit: the grid covers the bounding ball of the points, and sigma is two
/// cells. With a viewpoint, the map holds seenSymmetry() of D and of its counterpart for free space.
///
/// \code
/// pcl_symmetry::PlanarSymmetryTransform<pcl::PointXYZ> transform;
/// transform.setInputCloud(cloud);
/// const pcl_symmetry::SymmetryMap map = transform.compute();
/// if (!map.empty()) std::cout << map.grid.plane(map.grid.bin(map.strongest())).coefficients().transpose() << "\n";
/// \endcode
template <typename PointT>
class PlanarSymmetryTransform : public TransformAnalysis<PointT> {
public:
  using Ptr = pcl::shared_ptr<PlanarSymmetryTransform<PointT>>;
  using ConstPtr = pcl::shared_ptr<const PlanarSymmetryTransform<PointT>>;

  /// Uses at most 200 000 points, see setMaxPoints().
  PlanarSymmetryTransform() : TransformAnalysis<PointT>("PlanarSymmetryTransform") {}

  /// \param method sampled (default), convolution, rotational or voting; all estimate the same normalized quantity.
  void setMethod(TransformMethod method) { transform_.method = method; }

  /// \param n cells of the distance transform along each side, and bins of theta, phi and r each, as in the paper;
  /// even, in [8, 512].
  /// \throws pcl::BadArgumentException "field = value, must be rule", as do all setters here.
  void setGridSize(int n) {
    this->setNumCells(n);
    setMapSize(n, n, n);
  }
  /// \param num_theta,num_phi,num_radius bins of the map, each in [1, 4096], num_phi even; default 64 each.
  void setMapSize(int num_theta, int num_phi, int num_radius) {
    detail::changeOptions(map_size_, [&](MapSize& changed) { changed = {num_theta, num_phi, num_radius}; });
  }

  /// Sets a ball to cover in place of the bounding ball of the points.
  /// \param center,radius input frame and units; radius > 0.
  void setBounds(const Eigen::Vector3d& center, double radius) {
    detail::withBadArguments([&] { PlaneGrid(1, 2, 1, center, radius); });
    edt_options_.center = center;
    edt_options_.radius = radius;
  }

  /// Sets method, seed, number of threads and the options of each estimator at once.
  void setOptions(const PlanarTransformOptions& options) {
    detail::changeOptions(transform_, [&](PlanarTransformOptions& changed) { changed = options; });
  }
  void setRandomSeed(std::uint64_t seed) { transform_.setSeed(seed); }  ///< Sets the seed of all random draws.
  /// \param num_threads >= 0; 0 = one per core (default).
  void setNumberOfThreads(int num_threads) {
    detail::checkAtLeast("num_threads", num_threads, 0);
    transform_.setNumThreads(num_threads);
  }

  /// Analyzes points spread over a mesh by area in place of a cloud.
  /// \param num_points >= 1.
  /// \throws pcl::BadArgumentException if the mesh refers to vertices that it does not have.
  void setInputMesh(const pcl::PolygonMesh& mesh, int num_points = 50'000);

  /// \return the map, in the frame and units of the input; empty where the input holds no answer, see getReason().
  /// \throws pcl::BadArgumentException if the points surround the viewpoint that was given.
  SymmetryMap compute();

private:
  using TransformAnalysis<PointT>::edt_;
  using TransformAnalysis<PointT>::edt_options_;

  PlanarTransformOptions transform_;
  MapSize map_size_{64, 64, 64};
};

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
    const Points points = this->makeDistanceTransform(transform_.sampled.seed, transform_.sampled.num_threads);
    if (points.cols() == 0) return SymmetryMap();
    const PlaneGrid grid(map_size_, edt_->center(), edt_->radius());
    return planarTransform(*edt_, grid, centerOfMass(points), transform_, this->seen());
  });
}

}  // namespace pcl_symmetry
