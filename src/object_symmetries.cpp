#include "pcl_symmetry/object_symmetries.h"

#include "pcl_symmetry/mesh_sampling.h"

namespace pcl_symmetry {

namespace detail {

ObjectSymmetries objectSymmetriesOrNone(const Points& points, const ObjectSymmetryOptions& options) {
  return withBadArguments([&] {
    options.validate();
    std::string reason = reasonForNoAnswer(points);
    if (reason.empty()) return objectSymmetries(points, options);
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
  ObjectSymmetries found = detectObjectSymmetries(*points, options);
  if (!points->empty()) refineOnMesh(meshSurface(mesh), found);
  return found;
}

}  // namespace pcl_symmetry
