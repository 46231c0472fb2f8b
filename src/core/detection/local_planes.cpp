#include "core/detection/local_planes.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "core/base/parallel.h"
#include "core/detection/candidates.h"
#include "core/detection/part_search.h"
#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

std::vector<SymmetryPlane> localPlanes(const std::vector<SymmetryPlane>& known, const NormalizedCloud& cloud,
                                       const PlaneFit& fit, const PlaneJudge& judge, const DetectionOptions& options) {
  std::vector<SymmetryPlane> decided;
  std::copy_if(known.begin(), known.end(), std::back_inserter(decided), isDecided);
  const std::vector<SymmetricPart> parts =
      findSymmetricParts(cloud, fit, {options.expert.update, options.seed, options.num_threads});
  const std::vector<int> all = allOf(cloud.points.cols());
  std::vector<std::optional<SymmetryPlane>> of_parts(parts.size());
  parallelBlocks(parts.size(), options.num_threads, [&](std::size_t i) {
    const auto normalized = [&](const SymmetryPlane& plane) { return cloud.toNormalized(plane); };
    if (basinTolerance().anySame(decided, parts[i].plane, normalized)) return;
    SymmetryPlane plane = judge.decision.decide(judge.measure.of(parts[i].plane, all));
    if (plane.kind == PlaneKind::Symmetry) return;  // one of a family, which is known as its axis or center
    plane.kind = PlaneKind::Local;
    plane.iterations = parts[i].iterations;
    of_parts[i] = std::move(plane);
  });
  std::vector<SymmetryPlane> planes;
  for (std::optional<SymmetryPlane>& plane : of_parts)
    if (plane) planes.push_back(std::move(*plane));
  return planes;
}

}  // namespace pcl_symmetry
