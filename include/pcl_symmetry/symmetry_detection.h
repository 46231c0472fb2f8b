#pragma once

#include <pcl/PolygonMesh.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <vector>

#include "pcl_symmetry/mesh_sampling.h"
#include "pcl_symmetry/symmetry_maxima_refinement.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

namespace detail {

/// \return the planes of kind Symmetry.
inline std::vector<SymmetryPlane> onlySymmetries(std::vector<SymmetryPlane> planes) {
  planes.erase(std::remove_if(planes.begin(), planes.end(),
                              [](const SymmetryPlane& plane) { return plane.kind != PlaneKind::Symmetry; }),
               planes.end());
  return planes;
}

}  // namespace detail

/// Detects the planes of symmetry of a cloud in one call (Sections 4.1 to 4.4 of the paper).
/// \param cloud points that are not finite are left out.
/// \param options options for other planes, such as approximate, have no effect here.
/// \return the symmetries, best first, in the frame of the cloud. Empty where the shape has no symmetry; where it
/// has an axis of revolution and so a plane at every angle; and where the cloud holds no answer, which PCL_WARN says.
/// SymmetryMaximaRefinement gives axes, and possible and approximate planes.
/// \throws pcl::BadArgumentException for bad options.
template <typename PointT>
std::vector<SymmetryPlane> detectSymmetryPlanes(const pcl::PointCloud<PointT>& cloud,
                                                const DetectionOptions& options = {}) {
  static_assert(pcl::traits::has_xyz<PointT>::value, "PointT must have x, y and z");
  SymmetryMaximaRefinement<PointT> refinement;
  refinement.setOptions(options);
  // The cloud outlives this call: no copy.
  refinement.setInputCloud(typename pcl::PointCloud<PointT>::ConstPtr(&cloud, [](const void*) {}));
  return detail::onlySymmetries(refinement.compute());
}

/// The same for a mesh, whose planes are exact: see refineOnMesh().
/// \param num_points points spread over the mesh, >= 1.
/// \throws pcl::BadArgumentException for bad options, and where the mesh refers to vertices that it does not have.
inline std::vector<SymmetryPlane> detectSymmetryPlanes(const pcl::PolygonMesh& mesh,
                                                       const DetectionOptions& options = {}, int num_points = 10'000) {
  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  refinement.setOptions(options);
  const auto points = sampleMesh(mesh, num_points, options.seed);
  refinement.setInputCloud(points);
  if (!points->empty()) refinement.setMesh(meshSurface(mesh));
  return detail::onlySymmetries(refinement.compute());
}

}  // namespace pcl_symmetry
