#include "pcl_symmetry/core/viewpoint_score.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/geometry/directions.h"

namespace pcl_symmetry {

namespace {

/// Climbs from a direction to the local maximum of S.
Eigen::Vector3d climb(const std::vector<ViewPlane>& planes, Eigen::Vector3d v) {
  for (int step = 0; step < 100; ++step) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const ViewPlane& plane : planes) sum += std::copysign(plane.weight, v.dot(plane.normal)) * plane.normal;
    const Eigen::Vector3d next = sum.normalized();
    if (next.dot(v) > 1.0 - 1e-15) break;
    v = next;
  }
  return v;
}

}  // namespace

std::vector<ViewPlane> viewPlanes(std::vector<ViewPlane> planes, const std::vector<ViewPlane>& axes,
                                  const std::vector<ViewPlane>& maxima) {
  const int fan = 8;             // planes that represent an axis: S varies about it by 2 %
  const double min_score = 0.2;  // share of the best score below which a direction shows too little
  // Greatest cosine between the normal of an added maximum and those of the planes so far.
  const double max_across = 0.5;
  for (const ViewPlane& axis : axes)
    for (int k = 0; k < fan; ++k)
      planes.push_back({directionAcross(axis.normal, kPi * k / fan), 2.0 * axis.weight / fan});
  for (const ViewPlane& maximum : maxima) {
    if (isNearAny(planes, maximum.normal, max_across, &ViewPlane::normal)) continue;
    const std::vector<RankedView> best = bestViews(planes);
    if (!best.empty() && worstView(planes).score >= min_score * best[0].score) break;
    planes.push_back(maximum);
  }
  sortDescending(planes, [](const auto& entry) { return entry.weight; });
  return planes;
}

double viewpointScore(const std::vector<ViewPlane>& planes, const Eigen::Vector3d& direction) {
  double score = 0.0;
  for (const ViewPlane& plane : planes) score += plane.weight * std::abs(direction.dot(plane.normal));
  return score;
}

std::vector<RankedView> bestViews(const std::vector<ViewPlane>& planes) {
  std::vector<RankedView> views;
  const bool all_equal = std::none_of(planes.begin(), planes.end(), [](const ViewPlane& p) { return p.weight > 0.0; });
  if (all_equal) return views;
  const int num_directions = 4096;  // fewer may miss a maximum in a small cell between many planes
  for (const Eigen::Vector3d& start : evenDirections(num_directions)) {
    checkCancelled();
    const Eigen::Vector3d v = climb(planes, start);
    const bool known = std::any_of(views.begin(), views.end(),
                                   [&](const RankedView& view) { return view.direction.dot(v) > 1.0 - 1e-9; });
    if (known) continue;
    const double score = viewpointScore(planes, v);
    views.push_back({v, score});
    views.push_back({-v, score});
  }
  sortDescending(views, [](const auto& entry) { return entry.score; });
  return views;
}

RankedView worstView(const std::vector<ViewPlane>& planes) {
  check(!planes.empty(), "number of planes", planes.size(), ">= 1");
  RankedView worst{planes[0].normal.unitOrthogonal(), 0.0};
  worst.score = viewpointScore(planes, worst.direction);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    checkCancelled();
    for (std::size_t j = i + 1; j < planes.size(); ++j) {
      const Eigen::Vector3d along = planes[i].normal.cross(planes[j].normal);
      if (along.norm() < 1e-6) continue;
      const double score = viewpointScore(planes, along.normalized());
      if (score < worst.score) worst = {along.normalized(), score};
    }
  }
  return worst;
}

}  // namespace pcl_symmetry
