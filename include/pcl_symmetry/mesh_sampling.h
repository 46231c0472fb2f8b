#pragma once

#include <pcl/PolygonMesh.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstdint>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/mesh_surface.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Spreads points over a mesh by area: this is how meshes enter the transform.
/// \param mesh polygons of any number of corners, planar and convex, as a soup or connected.
/// \param num_points >= 1; equal shares of the total area get one point each.
/// \return the points, in the frame of the mesh; empty if no polygon has an area, which PCL_WARN reports.
/// \throws pcl::BadArgumentException if \p num_points is less than 1 or the mesh refers to vertices that it does not
/// have.
pcl::PointCloud<pcl::PointXYZ>::Ptr sampleMesh(const pcl::PolygonMesh& mesh, int num_points, std::uint64_t seed = 1);

/// The mesh as the exact surface that refineOnMesh() takes; polygons are cut into triangles.
/// \throws pcl::BadArgumentException if no polygon has an area, or the mesh refers to vertices that it does not have.
MeshSurface meshSurface(const pcl::PolygonMesh& mesh);

}  // namespace pcl_symmetry
