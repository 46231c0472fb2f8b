#include "pcl_symmetry/object_symmetries.h"

#include "pcl_symmetry/mesh_sampling.h"

namespace pcl_symmetry {

namespace detail {

ObjectSymmetries objectSymmetriesOrNone(const Points& points, const ObjectSymmetryOptions& options, bool is_scan,
                                        const MeshSurface* mesh) {
  return withBadArguments([&] {
    options.validate();
    std::string reason = reasonForNoAnswer(points);
    if (reason.empty() && is_scan) reason = kOneSided;
    if (reason.empty()) return mesh ? objectSymmetries(points, *mesh, options) : objectSymmetries(points, options);
    warnOfNoAnswer("detectObjectSymmetries", reason);
    ObjectSymmetries none;
    none.support = none.confidence = 0.0;
    none.reason = std::move(reason);
    return none;
  });
}

}  // namespace detail

ObjectSymmetries detectObjectSymmetries(const pcl::PolygonMesh& mesh, const ObjectSymmetryOptions& options,
                                        int num_points) {
  const auto points = sampleMesh(mesh, num_points, options.seed);
  if (points->empty()) return detectObjectSymmetries(*points, options);
  const MeshSurface surface = meshSurface(mesh);
  const Points all = detail::selectPoints(*points, nullptr, points->size(), options.seed).points;
  return detail::objectSymmetriesOrNone(all, options, false, &surface);
}

}  // namespace pcl_symmetry
