#pragma once

#include <pcl/PolygonMesh.h>
#include <pcl/point_cloud.h>

#include "pcl_symmetry/core/rotation/rotational_symmetry.h"

namespace pcl_symmetry {

/// The rotations that map the shape of a cloud onto itself: what pose estimation has to know of an object, as two poses
/// that differ by one of them look the same. Points that are not finite are left out.
/// \throws pcl::BadArgumentException for bad options, or where the finite points are too few or on a line.
template <typename PointT>
ObjectSymmetries detectObjectSymmetries(const pcl::PointCloud<PointT>& cloud,
                                        const ObjectSymmetryOptions& options = {});

/// The same for a mesh, by points spread over it.
ObjectSymmetries detectObjectSymmetries(const pcl::PolygonMesh& mesh, const ObjectSymmetryOptions& options = {},
                                        int num_points = 10'000);

}  // namespace pcl_symmetry
