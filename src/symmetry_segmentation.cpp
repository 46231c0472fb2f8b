#include "pcl_symmetry/impl/symmetry_segmentation.hpp"

#include <pcl/point_types.h>
#include <pcl/impl/instantiate.hpp>

#include "mesh_conversion.h"

namespace pcl_symmetry {

bool detail::hasArea(const pcl::PolygonMesh& mesh) {
  return pcl_symmetry::hasArea(toArrays(mesh));
}

SurfaceGraph meshGraph(const pcl::PolygonMesh& mesh) {
  const MeshArrays arrays = toArrays(mesh);
  return meshGraph(arrays.vertices, arrays.polygons);
}

}  // namespace pcl_symmetry

PCL_INSTANTIATE(SymmetrySegmentation, PCL_XYZ_POINT_TYPES)
