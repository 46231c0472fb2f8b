#pragma once

#include <pcl/PolygonMesh.h>
#include <pcl/point_cloud.h>

#include "pcl_symmetry/core/rotational_symmetry.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Finds the rotations that map the shape of a cloud onto itself: two poses of an object that differ by one of them
/// look the same, which pose estimation has to take into account.
/// \param cloud seen from all sides; points that are not finite are left out.
/// \return the group of rotations; where the cloud holds no answer, as a scan from one side does not, the identity
/// alone with confidence 0 and ObjectSymmetries::reason, which PCL_WARN prints.
/// \throws pcl::BadArgumentException for bad options.
template <typename PointT>
ObjectSymmetries detectObjectSymmetries(const pcl::PointCloud<PointT>& cloud,
                                        const ObjectSymmetryOptions& options = {});

/// The same for a mesh, whose axes are exact: see objectSymmetries().
/// \param num_points points spread over the mesh, >= 1.
/// \throws pcl::BadArgumentException for bad options, and where the mesh refers to vertices that it does not have.
ObjectSymmetries detectObjectSymmetries(const pcl::PolygonMesh& mesh, const ObjectSymmetryOptions& options = {},
                                        int num_points = 10'000);

namespace detail {

/// ObjectSymmetries::reason of a scan.
inline constexpr const char* kOneSided = "a scan from one side, must be a whole object";

/// \param points 3 x N, finite.
/// \param is_scan whether they were seen from one side.
/// \param mesh the mesh that they are spread over, or none.
ObjectSymmetries objectSymmetriesOrNone(const Points& points, const ObjectSymmetryOptions& options, bool is_scan,
                                        const MeshSurface* mesh = nullptr);

}  // namespace detail

template <typename PointT>
ObjectSymmetries detectObjectSymmetries(const pcl::PointCloud<PointT>& cloud, const ObjectSymmetryOptions& options) {
  const Points points = detail::selectPoints(cloud, nullptr, cloud.size(), options.seed).points;
  const bool is_scan = points.cols() > 0 && detail::findSeenSpace(cloud, points, {}).visibility();
  return detail::objectSymmetriesOrNone(points, options, is_scan);
}

}  // namespace pcl_symmetry
