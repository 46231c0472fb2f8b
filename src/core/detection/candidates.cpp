#include "core/detection/candidates.h"

#include "core/detection/plane_lattice.h"
#include "core/geometry/principal_axes.h"

namespace pcl_symmetry {

std::vector<Candidate> gatherCandidates(const NormalizedCloud& cloud, const SymmetryMap& map,
                                        const DetectionOptions& options) {
  std::vector<Candidate> candidates;
  LocalMaximaOptions maxima = options.expert.maxima;
  maxima.num_threads = options.num_threads;
  for (const LocalMaximum& maximum : findLocalMaxima(map, maxima)) {
    if (static_cast<int>(candidates.size()) >= options.expert.max_candidates) break;
    const ReflectionPlane plane = cloud.toNormalized(maximum.plane);
    if (kSameBasin.anySame(candidates, plane, [](const Candidate& candidate) { return candidate.plane; })) continue;
    candidates.push_back({plane, true});
  }
  for (const ReflectionPlane& plane : principalPlanes(cloud.principal_axes)) candidates.push_back({plane, false});
  return candidates;
}

std::vector<Candidate> GroupClosure::next(const std::vector<SymmetryPlane>& planes) {
  std::vector<ReflectionPlane> symmetries;
  for (const SymmetryPlane& plane : planes)
    if (plane.kind == PlaneKind::Symmetry) symmetries.push_back(cloud_.toNormalized(plane));
  std::vector<Candidate> found;
  if (!cloud_.rules().completes_groups) return found;
  tried_.insert(tried_.end(), symmetries.begin(), symmetries.end());
  const auto add = [&](const ReflectionPlane& plane) {
    if (kSamePlane.anySame(tried_, plane)) return;
    tried_.push_back(plane);
    found.push_back({plane, false});
  };
  // The planes of a regular polygon, from those of them that are known.
  if (const std::optional<PlaneLattice> lattice = findLattice(symmetries))
    for (int k = 0; k < lattice->fold; ++k) add(lattice->plane(k));
  if (symmetries.size() > kDetection.candidates.most_closed) return found;
  for (const ReflectionPlane& plane : symmetries) {
    for (const ReflectionPlane& across : symmetries) {
      const Eigen::Vector3d normal = plane.normal() - 2.0 * plane.normal().dot(across.normal()) * across.normal();
      const ReflectionPlane image(normal, normal.dot(across.reflect(plane.offset() * plane.normal())));
      add(image);
    }
  }
  return found;
}

}  // namespace pcl_symmetry
