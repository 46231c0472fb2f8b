#pragma once

#include <pcl/PolygonMesh.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstdint>

namespace pcl_symmetry {

/// A cloud of points spread over a mesh by area, in the frame of the mesh: how meshes enter the transform.
/// \param mesh polygons of any size, planar and convex, as a soup or connected.
/// \param num_points >= 1.
/// \throws pcl::BadArgumentException where the mesh has no area or refers to vertices it does not have.
pcl::PointCloud<pcl::PointXYZ>::Ptr sampleMesh(const pcl::PolygonMesh& mesh, int num_points, std::uint64_t seed = 1);

}  // namespace pcl_symmetry
