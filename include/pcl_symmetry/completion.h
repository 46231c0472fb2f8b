#pragma once

#include <pcl/point_cloud.h>

#include "pcl_symmetry/core/registration/symmetric_completion.h"
#include "pcl_symmetry/viewpoint.h"

namespace pcl_symmetry {

/// A cloud and what its symmetry adds to it.
template <typename PointT>
struct CompletedCloud {
  pcl::PointCloud<PointT> cloud;  ///< the points of the input in their order, then those added; not organized
  pcl::Indices added;             ///< of the points added
  pcl::Indices sources;           ///< of each point added, the point of the input that it is the reflection of
};

/// Mirrors a partial scan across a plane of symmetry where free space allows it: points whose reflections fall onto the
/// surface that was measured, or into space that the scanner saw to be empty, add nothing. Normals of added points are
/// reflected, and so is the viewpoint that a point may carry; all other fields are those of the source.
/// \param viewpoint where the scanner stood; by default the data decide, as in SymmetryMaximaRefinement.
/// \throws pcl::BadArgumentException for bad options.
template <typename PointT>
CompletedCloud<PointT> completeBySymmetry(const pcl::PointCloud<PointT>& cloud, const ReflectionPlane& plane,
                                          const CompletionOptions& options = {}, const Viewpoint& viewpoint = {});

}  // namespace pcl_symmetry
