#include "pcl_symmetry/symmetry_segmentation.h"

#include "mesh_conversion.h"

namespace pcl_symmetry {

bool detail::hasArea(const pcl::PolygonMesh& mesh) {
  return toArrays(mesh).hasArea();
}

SurfaceGraph meshGraph(const pcl::PolygonMesh& mesh) {
  const MeshArrays arrays = toArrays(mesh);
  return meshGraph(arrays.vertices, arrays.polygons);
}

}  // namespace pcl_symmetry
