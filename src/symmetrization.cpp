#include "pcl_symmetry/symmetrization.h"

#include <cstring>

#include "mesh_conversion.h"

namespace pcl_symmetry {

SymmetrizedMesh symmetrize(const pcl::PolygonMesh& mesh, const ReflectionPlane& plane, SymmetrizedHalf half,
                           int num_threads) {
  return detail::withBadArguments([&] {
    const MeshArrays arrays = toArrays(mesh);
    SymmetrizedShape shape = symmetrizedMesh(arrays.vertices, fansOf(arrays), plane, half, num_threads);
    SymmetrizedMesh result{mesh, std::move(shape.asymmetry), shape.mean_asymmetry, shape.greatest_asymmetry,
                           shape.deviation};
    for (const pcl::PCLPointField& field : result.mesh.cloud.fields)
      for (int axis = 0; axis < 3; ++axis)
        if (field.name == std::string(1, "xyz"[axis]))
          for (Eigen::Index i = 0; i < shape.points.cols(); ++i)
            std::memcpy(&result.mesh.cloud.data[static_cast<std::size_t>(i) * mesh.cloud.point_step + field.offset],
                        &shape.points(axis, i), sizeof(float));
    return result;
  });
}

}  // namespace pcl_symmetry
