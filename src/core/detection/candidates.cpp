#include "core/detection/plane_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/lists.h"
#include "core/geometry/cloud_extent.h"
#include "core/geometry/directions.h"

namespace pcl_symmetry {

std::vector<Candidate> gatherCandidates(const NormalizedCloud& cloud, const SymmetryMap& map,
                                        const DetectionOptions& options) {
  std::vector<Candidate> candidates;
  for (const LocalMaximum& maximum : findLocalMaxima(map, options.expert.maxima, options.num_threads))
    candidates.push_back({cloud.toNormalized(maximum.plane), true});
  candidates = kSameMaximum.distinct(std::move(candidates), &Candidate::plane, options.expert.max_candidates);
  for (const ReflectionPlane& plane : principalPlanes(cloud.principal_axes)) candidates.push_back({plane});
  return candidates;
}

std::vector<ReflectionPlane> planesOf(const std::vector<SymmetryPlane>& planes, std::initializer_list<PlaneKind> kinds,
                                      const NormalizedCloud& cloud) {
  std::vector<ReflectionPlane> found;
  for (const SymmetryPlane& plane : planes)
    if (std::find(kinds.begin(), kinds.end(), plane.kind) != kinds.end()) found.push_back(cloud.toNormalized(plane));
  return found;
}

std::vector<Candidate> reflectSymmetries(const std::vector<SymmetryPlane>& planes, const NormalizedCloud& cloud,
                                         std::vector<ReflectionPlane>& tried) {
  const std::vector<ReflectionPlane> symmetries = planesOf(planes, {PlaneKind::Symmetry}, cloud);
  std::vector<Candidate> found;
  append(tried, symmetries);
  const auto add = [&](const ReflectionPlane& plane) {
    if (kSamePlane.anySame(tried, plane)) return;
    tried.push_back(plane);
    found.push_back({plane});
  };
  if (symmetries.size() > kDetection.closure.max_closed) return found;
  for (const ReflectionPlane& plane : symmetries) {
    for (const ReflectionPlane& across : symmetries) {
      const Eigen::Vector3d normal = plane.normal() - 2.0 * plane.normal().dot(across.normal()) * across.normal();
      add(ReflectionPlane(normal, normal.dot(across.reflect(plane.offset() * plane.normal()))));
    }
  }
  return found;
}

std::vector<Candidate> proposeAtRightAngles(const std::vector<SymmetryPlane>& planes,
                                            const std::vector<Eigen::Vector3d>& support_normals,
                                            const NormalizedCloud& cloud) {
  std::vector<Eigen::Vector3d> normals, tried;
  for (const SymmetryPlane& plane : planes)
    if (plane.kind == PlaneKind::Symmetry) normals.push_back(plane.normal());
  tried = normals;
  const std::size_t num_symmetries = normals.size();
  append(normals, support_normals);
  std::vector<Candidate> found;
  for (std::size_t i = 0; i < num_symmetries; ++i) {
    for (std::size_t k = i + 1; k < normals.size(); ++k) {
      if (std::abs(normals[i].dot(normals[k])) > std::sin(kDetection.decide.upright)) continue;
      const Eigen::Vector3d normal = normals[i].cross(normals[k]).normalized();
      if (isNearAny(tried, normal, std::cos(kDetection.decide.upright))) continue;
      tried.push_back(normal);
      const Eigen::RowVectorXd along = normal.transpose() * cloud.points.cast<double>();
      const double low = along.minCoeff(), step = (along.maxCoeff() - low) / kDetection.closure.offsets_tried;
      for (int s = 0; s < kDetection.closure.offsets_tried; ++s)
        found.push_back({ReflectionPlane(normal, low + (s + 0.5) * step)});
    }
  }
  return found;
}

}  // namespace pcl_symmetry
