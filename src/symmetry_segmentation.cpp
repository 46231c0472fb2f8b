#include "pcl_symmetry/symmetry_segmentation.h"

#include "pcl_symmetry/impl/cloud_conversion.hpp"

namespace pcl_symmetry {

bool detail::hasArea(const pcl::PolygonMesh& mesh) {
  return detail::toArrays(mesh).hasArea();
}

SurfaceGraph meshGraph(const pcl::PolygonMesh& mesh) {
  const detail::MeshArrays arrays = detail::toArrays(mesh);
  return meshGraph(arrays.vertices, arrays.polygons);
}

}  // namespace pcl_symmetry
