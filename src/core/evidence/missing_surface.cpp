#include "core/evidence/missing_surface.h"

#include <algorithm>
#include <boost/pending/disjoint_sets.hpp>
#include <cmath>

#include "core/base/statistics.h"
#include "core/evidence/surface_samples.h"
#include "core/geometry/cloud_extent.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/surface_normals.h"
#include "core/scan/range_image.h"

namespace pcl_symmetry {

namespace {

/// The coordinates of points, each side by side.
using Coordinates = Eigen::Array<float, Eigen::Dynamic, 3>;

Coordinates coordinatesOf(const Points& points) {
  return points.transpose().array();
}

Eigen::ArrayXf along(const Coordinates& points, const Eigen::Vector3f& direction) {
  return direction.x() * points.col(0) + direction.y() * points.col(1) + direction.z() * points.col(2);
}

/// The point that is farthest along a direction; of several, the first one.
Eigen::Vector3f farthestAlong(const Coordinates& points, const Eigen::Vector3f& direction) {
  const Eigen::ArrayXf reached = along(points, direction);  // maxCoeff() with an index is not vectorized
  return points.row(std::find(reached.begin(), reached.end(), reached.maxCoeff()) - reached.begin());
}

/// The direction along which two clouds are farthest apart: the one between the closest points of their convex hulls
/// (Gilbert 1966) or, if these overlap, a direction of little overlap.
Eigen::Vector3f separatingDirection(const Points& cloud, const Points& piece, float spacing) {
  const Coordinates of_cloud = coordinatesOf(cloud), of_piece = coordinatesOf(piece);
  Eigen::Vector3f between = piece.rowwise().mean() - cloud.rowwise().mean();
  for (int step = 0; step < kEvidence.max_steps; ++step) {
    const Eigen::Vector3f nearest = farthestAlong(of_piece, -between) - farthestAlong(of_cloud, between);
    if (between.dot(nearest) >= (1.0f - kEvidence.min_gain) * between.squaredNorm()) break;
    const Eigen::Vector3f change = nearest - between;
    const Eigen::Vector3f next = between - std::min(1.0f, between.dot(change) / change.squaredNorm()) * change;
    if (next.norm() < kEvidence.no_distance * spacing) break;
    between = next;
  }
  return between.normalized();
}

/// 0 up to the value \p none, 1 from the value \p all on.
float ramp(float value, float none, float all) {
  return std::clamp((value - none) / (all - none), 0.0f, 1.0f);
}

/// Lower limit of a proportion (Wilson).
float lowerLimit(float count, float total) {
  const float share = count / total, sq = kEvidence.standard_errors * kEvidence.standard_errors / total;
  return (share + 0.5f * sq - std::sqrt(sq * (share * (1.0f - share) + 0.25f * sq))) / (1.0f + sq);
}

/// Regions of samples that are joined as neighbors.
using Regions = boost::disjoint_sets<int*, int*>;

/// The samples of each region; regions by their smallest index.
std::vector<std::vector<int>> membersOf(Regions& regions, const std::vector<char>& matched) {
  std::vector<std::vector<int>> members;
  std::vector<int> number(matched.size(), -1);
  for (std::size_t i = 0; i < matched.size(); ++i) {
    if (matched[i]) continue;
    int& of_root = number[regions.find_set(static_cast<int>(i))];
    if (of_root < 0) {
      of_root = static_cast<int>(members.size());
      members.emplace_back();
    }
    members[of_root].push_back(static_cast<int>(i));
  }
  return members;
}

/// Whether each line along the shortest principal axis meets the surface once, as for open ground: it ends all around,
/// and its end is not a cut.
bool isOpenSheet(const Points& points) {
  const PrincipalAxes axes = principalAxes(points);
  const double far = kEvidence.far_view * boundingBall(points).radius;
  return layeredShare(points, axes.center + far * axes.axes.col(2)) < kEvidence.layered_sheet;
}

}  // namespace

float beyondEnd(const Points& cloud, const Points& normals, const Points& piece, double spacing) {
  const auto unit = static_cast<float>(spacing);
  const Eigen::Vector3f normal = separatingDirection(cloud, piece, unit);
  const Eigen::ArrayXf distances = along(coordinatesOf(cloud), normal);
  const float gap = (along(coordinatesOf(piece), normal).minCoeff() - distances.maxCoeff()) / unit;
  const float is_beyond = ramp(gap, -kEvidence.behind, -kEvidence.in_front);
  if (is_beyond <= 0.0f) return 0.0f;
  // The surface has to end beside the piece, or within 60 degrees of the way to it.
  const float reach = (kEvidence.behind + 2.0f * std::max(0.0f, gap)) * unit;
  const float last_but_outliers =
      quantile(std::vector<float>(distances.begin(), distances.end()), 1.0 - kEvidence.outliers);
  const float end = last_but_outliers - kEvidence.last_points * unit;
  float cosines = 0.0f, count = 0.0f, cosines_before = 0.0f, count_before = 0.0f;
  for (Eigen::Index i = 0; i < cloud.cols(); ++i) {
    if (distances[i] < end) continue;
    const float cosine = std::abs(normal.dot(normals.col(i)));
    cosines += cosine;
    count += 1.0f;
    if ((piece.colwise() - cloud.col(i)).colwise().squaredNorm().minCoeff() > reach * reach) continue;
    cosines_before += cosine;
    count_before += 1.0f;
  }
  if (count_before == 0.0f) return 0.0f;
  return is_beyond *
         ramp(-std::max(cosines / count, cosines_before / count_before), -kEvidence.closes, -kEvidence.runs_into);
}

std::vector<float> missingCounterparts(const SampledSurface& surface, const std::vector<char>& matched,
                                       const std::vector<int>& closest, const Points& reflected) {
  const std::size_t size = matched.size();
  const auto& nearest = surface.geometry.nearest;
  const std::vector<char> near = nearBorders(surface.borders, surface.geometry);
  const auto ends = [&](int i) { return near[i] || (closest[i] >= 0 && near[closest[i]]); };
  std::vector<int> ranks(size, 0), parents = allIndices(static_cast<Eigen::Index>(size));
  Regions regions(ranks.data(), parents.data());
  for (std::size_t i = 0; i < size; ++i)
    for (const int j : nearest[i])
      if (!matched[i] && !matched[j]) regions.union_set(static_cast<int>(i), j);
  std::vector<float> edges(size, 0.0f), explained(size, 0.0f);  // values of the region with this root
  for (std::size_t i = 0; i < size; ++i) {
    for (const int j : nearest[i]) {
      if (matched[i] == matched[j]) continue;
      const int region = regions.find_set(matched[i] ? j : static_cast<int>(i));
      edges[region] += 1.0f;
      explained[region] += ends(static_cast<int>(i)) || ends(j) ? 1.0f : 0.0f;
    }
  }
  const auto min_samples =
      std::max(kEvidence.min_of_piece, static_cast<std::size_t>(kEvidence.min_piece * static_cast<double>(size)));
  std::vector<float> missing(size, 0.0f);
  for (const std::vector<int>& members : membersOf(regions, matched)) {
    const int region = regions.find_set(members.front());
    float value = 0.0f;
    if (edges[region] > 0.0f) {
      const auto at_borders = std::count_if(members.begin(), members.end(), [&](int i) { return near[i] != 0; });
      // The edge of a region that lies entirely near borders, such as a wire, is near borders for any plane.
      const float chance = std::min(0.99f, static_cast<float>(at_borders) / static_cast<float>(members.size()));
      const float share = (lowerLimit(explained[region], edges[region]) - chance) / (1.0f - chance);
      value =
          std::clamp((share - kEvidence.min_explained) / (kEvidence.explained - kEvidence.min_explained), 0.0f, 1.0f);
    }
    if (value < 1.0f && members.size() >= min_samples)
      value = std::max(
          value, beyondEnd(surface.points, surface.geometry.normals, pointsAt(reflected, members), surface.spacing));
    for (const int i : members) missing[i] = value;
  }
  return missing;
}

SurfaceEnds::SurfaceEnds(const Points& points, const LocalGeometry& geometry, const ClosestPointSearch& search,
                         const FoundNeighbors& found, int num_threads)
    : borders(openBorders(points, search, geometry.normals, num_threads, &found)),
      trust(isOpenSheet(points) ? 0.0
                                : std::clamp((kEvidence.borders_everywhere - shareNearBorders(borders, geometry)) /
                                                 (kEvidence.borders_everywhere - kEvidence.few_borders),
                                             0.0, 1.0)) {}

}  // namespace pcl_symmetry
