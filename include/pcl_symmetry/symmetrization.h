#pragma once

#include <pcl/PolygonMesh.h>
#include <pcl/correspondence.h>

#include <limits>
#include <vector>

#include "pcl_symmetry/completion.h"
#include "pcl_symmetry/core/symmetrized_shape.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// A cloud that a plane maps onto itself.
template <typename PointT>
struct SymmetrizedCloud {
  pcl::PointCloud<PointT> cloud;    ///< points of the input, moved, then their reflections; not organized
  pcl::Indices sources;             ///< for each point, the index of the input point that it is or is the reflection of
  std::vector<float> asymmetry;     ///< asymmetry of each point of the input, see SymmetrizedShape
  double mean_asymmetry = 0.0;      ///< mean absolute asymmetry, input units
  double greatest_asymmetry = 0.0;  ///< greatest absolute asymmetry, input units
};

/// Makes a cloud whose halves are the mean of both sides, or one side and its reflection. Reflected points have their
/// position and normal reflected; all other fields are those of their source.
/// \param cloud points that are not finite are left out; without a finite point the result is empty, and PCL_WARN says
/// so.
/// \param plane plane of symmetry, frame of the cloud; the left side is the one that its normal points away from.
template <typename PointT>
SymmetrizedCloud<PointT> symmetrize(const pcl::PointCloud<PointT>& cloud, const ReflectionPlane& plane,
                                    SymmetrizedHalf half = SymmetrizedHalf::Mean, int num_threads = 0) {
  return detail::withBadArguments([&] {
    SymmetrizedCloud<PointT> result;
    const detail::SelectedPoints all = detail::selectPoints(cloud, nullptr, cloud.size(), 0);
    result.asymmetry.assign(cloud.size(), std::numeric_limits<float>::quiet_NaN());
    if (all.points.cols() == 0) {
      detail::warnOfNoAnswer("symmetrize", "cloud: no finite point");
      return result;
    }
    const SymmetrizedShape shape = symmetrizedCloud(all.points, plane, half, num_threads);
    for (std::size_t i = 0; i < all.indices.size(); ++i)
      result.asymmetry[static_cast<std::size_t>(all.indices[i])] = shape.asymmetry[i];
    result.mean_asymmetry = shape.mean_asymmetry;
    result.greatest_asymmetry = shape.greatest_asymmetry;
    result.cloud.header = cloud.header;
    for (const bool is_reflected : {false, true})
      for (const int i : shape.kept) {
        PointT point = cloud[static_cast<std::size_t>(all.indices[i])];
        point.getVector3fMap() = shape.points.col(i);
        result.cloud.push_back(is_reflected ? detail::reflectPoint(point, plane) : point);
        result.sources.push_back(all.indices[i]);
      }
    return result;
  });
}

/// A mesh that a plane maps onto itself.
struct SymmetrizedMesh {
  pcl::PolygonMesh mesh;            ///< the polygons of the input; its vertices moved, with all their fields
  std::vector<float> asymmetry;     ///< asymmetry of each vertex of the input, see SymmetrizedShape
  double mean_asymmetry = 0.0;      ///< mean absolute asymmetry, input units
  double greatest_asymmetry = 0.0;  ///< greatest absolute asymmetry, input units
  double deviation = 0.0;           ///< see SymmetrizedShape
};

/// The same for a mesh, whose polygons stay. Its vertices have float coordinates x, y and z.
/// \throws pcl::BadArgumentException if no polygon has an extent, or the mesh refers to vertices that it does not have.
SymmetrizedMesh symmetrize(const pcl::PolygonMesh& mesh, const ReflectionPlane& plane,
                           SymmetrizedHalf half = SymmetrizedHalf::Mean, int num_threads = 0);

/// One side of a mesh, cut at the plane, and its reflection, see the core's function of this name. Vertices have the
/// fields of their sources.
/// \param[in,out] values one value per vertex of the mesh, replaced by those of the new vertices; may be null.
pcl::PolygonMesh mirroredHalf(const pcl::PolygonMesh& mesh, const ReflectionPlane& plane, bool left = true,
                              std::vector<float>* values = nullptr);

/// The counterpart of each point of a cloud: the point closest to its reflection.
/// \param max_distance greatest distance of a counterpart from the reflection, input units, >= 0; 0 = 1 % of the
/// diameter.
/// \return for each point that has a counterpart: the indices of both, and the squared distance of the counterpart
/// from the reflection, as in PCL's correspondences.
/// \throws pcl::BadArgumentException for a negative distance.
template <typename PointT>
pcl::Correspondences reflectedCorrespondences(const pcl::PointCloud<PointT>& cloud, const ReflectionPlane& plane,
                                              double max_distance = 0.0) {
  return detail::withBadArguments([&] {
    const detail::SelectedPoints all = detail::selectPoints(cloud, nullptr, cloud.size(), 0);
    const ReflectedPairs pairs = reflectedPairs(all.points, plane, max_distance);
    pcl::Correspondences result;
    for (std::size_t i = 0; i < pairs.index.size(); ++i)
      if (pairs.index[i] >= 0) result.emplace_back(all.indices[i], all.indices[pairs.index[i]], pairs.sq_distances[i]);
    return result;
  });
}

}  // namespace pcl_symmetry
