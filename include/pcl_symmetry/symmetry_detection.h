#pragma once

#include <pcl/PolygonMesh.h>
#include <pcl/point_cloud.h>

#include <vector>

#include "pcl_symmetry/symmetry_maxima_refinement.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Detects the planes of symmetry of a cloud in one call (Sections 4.1 to 4.4 of the paper).
/// \param cloud points that are not finite are left out.
/// \return the planes, best first, in the frame of the cloud. Empty where the shape has no symmetry; also where the
/// cloud holds no answer, which PCL_WARN says.
/// \throws pcl::BadArgumentException for bad options.
template <typename PointT>
std::vector<SymmetryPlane> detectSymmetryPlanes(const pcl::PointCloud<PointT>& cloud,
                                                const DetectionOptions& options = {}) {
  SymmetryMaximaRefinement<PointT> refinement;
  refinement.setOptions(options);
  // The cloud outlives this call: no copy.
  refinement.setInputCloud(typename pcl::PointCloud<PointT>::ConstPtr(&cloud, [](const void*) {}));
  return refinement.compute();
}

/// The same for a mesh, whose planes are exact: see refineOnMesh().
/// \param num_points points spread over the mesh, >= 1.
/// \throws pcl::BadArgumentException for bad options, and where the mesh refers to vertices that it does not have.
std::vector<SymmetryPlane> detectSymmetryPlanes(const pcl::PolygonMesh& mesh, const DetectionOptions& options = {},
                                                int num_points = 10'000);

}  // namespace pcl_symmetry
