#include "core/evidence/missing_surface.h"

#include <algorithm>
#include <boost/pending/disjoint_sets.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "core/evidence/surface_samples.h"
#include "core/geometry/cloud_extent.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/surface_normals.h"
#include "core/scan/range_image.h"

namespace pcl_symmetry {

namespace {

/// The cell of each point, in a box that has as many cells along each side.
std::vector<int> cellsOf(const Points& points, int cells_per_side) {
  const Eigen::Vector3f least = points.rowwise().minCoeff(), extent = points.rowwise().maxCoeff() - least;
  const auto sides = static_cast<float>(cells_per_side);
  const Eigen::Vector3f per_unit = (extent.array() > 0.0f).select(sides / extent.array(), 0.0f);
  std::vector<int> cells(static_cast<std::size_t>(points.cols()));
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3f place = (points.col(i) - least).cwiseProduct(per_unit);
    int cell = 0;
    for (int k = 0; k < 3; ++k)
      cell = cell * cells_per_side + std::clamp(static_cast<int>(place[k]), 0, cells_per_side - 1);
    cells[static_cast<std::size_t>(i)] = cell;
  }
  return cells;
}

}  // namespace

OutermostPoints::OutermostPoints(const Points& points) : mean_(points.rowwise().mean()) {
  const auto size = static_cast<std::size_t>(points.cols());
  const int cells_per_side =
      std::max(1, static_cast<int>(std::sqrt(static_cast<double>(size) / kEvidence.points_per_square)));
  const std::vector<int> cells = cellsOf(points, cells_per_side);
  std::vector<std::size_t> place(static_cast<std::size_t>(cells_per_side * cells_per_side * cells_per_side) + 1, 0);
  for (const int cell : cells) ++place[static_cast<std::size_t>(cell) + 1];
  std::partial_sum(place.begin(), place.end(), place.begin());
  for (std::size_t c = 0; c + 1 < place.size(); ++c)
    if (place[c] < place[c + 1])
      cells_.push_back({Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero(), place[c], place[c + 1]});
  index_of_.resize(size);
  for (std::size_t i = 0; i < size; ++i)
    index_of_[place[static_cast<std::size_t>(cells[i])]++] = static_cast<Eigen::Index>(i);
  for (int k = 0; k < 3; ++k) {
    std::vector<float>& coordinates = coordinates_[static_cast<std::size_t>(k)];
    coordinates.resize(size);
    for (std::size_t i = 0; i < size; ++i) coordinates[i] = points(k, index_of_[i]);
    for (Cell& cell : cells_) {
      const auto [least, most] = std::minmax_element(coordinates.begin() + static_cast<std::ptrdiff_t>(cell.begin),
                                                     coordinates.begin() + static_cast<std::ptrdiff_t>(cell.end));
      cell.least[k] = *least;
      cell.most[k] = *most;
    }
  }
}

Eigen::Vector3f OutermostPoints::last(const Eigen::Vector3f& direction) const {
  float most = -std::numeric_limits<float>::infinity();
  std::size_t found = 0;
  const auto lookAt = [&](const Cell& cell) {
    for (std::size_t i = cell.begin; i < cell.end; ++i) {
      const float value = along(direction, i);
      if (value < most || (value == most && index_of_[i] > index_of_[found])) continue;
      most = value;
      found = i;
    }
  };
  // The cell that may hold the farthest point first: it leaves few others.
  const auto first = std::max_element(cells_.begin(), cells_.end(), [&](const Cell& a, const Cell& b) {
    return a.bound(direction) < b.bound(direction);
  });
  lookAt(*first);
  for (const Cell& cell : cells_)
    if (cell.bound(direction) >= most) lookAt(cell);
  return at(found);
}

bool OutermostPoints::reach(const Eigen::Vector3f& x, float distance) const {
  const float sq_distance = distance * distance;
  return std::any_of(cells_.begin(), cells_.end(), [&](const Cell& cell) {
    if ((x - x.cwiseMax(cell.least).cwiseMin(cell.most)).squaredNorm() > sq_distance) return false;
    for (std::size_t i = cell.begin; i < cell.end; ++i)
      if ((x - at(i)).squaredNorm() <= sq_distance) return true;
    return false;
  });
}

namespace {

/// The direction along which two clouds are farthest apart: that between the closest points of their convex hulls
/// (Gilbert 1966). Where these overlap, a direction in which they overlap little.
Eigen::Vector3f separatingDirection(const OutermostPoints& points, const OutermostPoints& piece, float spacing) {
  Eigen::Vector3f between = piece.mean() - points.mean();
  for (int step = 0; step < kEvidence.max_steps; ++step) {
    const Eigen::Vector3f nearest = piece.last(-between) - points.last(between);
    if (between.dot(nearest) >= (1.0f - kEvidence.min_gain) * between.squaredNorm()) break;
    const Eigen::Vector3f change = nearest - between;
    const Eigen::Vector3f next = between - std::min(1.0f, between.dot(change) / change.squaredNorm()) * change;
    if (next.norm() < kEvidence.no_distance * spacing) break;
    between = next;
  }
  return between.normalized();
}

/// The distance along a direction that all but outliers stay behind.
/// \param farthest that of all points.
float lastOf(const OutermostPoints& points, const Eigen::Vector3f& direction, float farthest, float spacing) {
  const auto size = static_cast<std::size_t>(points.size());
  const std::size_t num_beyond =
      size - 1 - static_cast<std::size_t>((1.0 - kEvidence.outliers) * static_cast<double>(size - 1));
  std::vector<float> distances;
  for (const float from : {farthest - kEvidence.outliers_within * spacing, -std::numeric_limits<float>::infinity()}) {
    distances.clear();
    points.visitFrom(direction, from,
                     [&](Eigen::Index, const Eigen::Vector3f&, float distance) { distances.push_back(distance); });
    if (distances.size() > num_beyond) break;
  }
  const auto last = distances.begin() + static_cast<std::ptrdiff_t>(num_beyond);
  std::nth_element(distances.begin(), last, distances.end(), std::greater<float>());
  return *last;
}

/// 0 up to the first value, 1 from the second on.
float ramp(float value, float none, float all) {
  return std::clamp((value - none) / (all - none), 0.0f, 1.0f);
}

}  // namespace

float beyondEnd(const OutermostPoints& cloud, const Points& normals, const OutermostPoints& piece, double spacing) {
  const auto unit = static_cast<float>(spacing);
  const Eigen::Vector3f normal = separatingDirection(cloud, piece, unit);
  const float farthest = normal.dot(cloud.last(normal));
  const float gap = (normal.dot(piece.last(-normal)) - farthest) / unit;
  const float is_beyond = ramp(gap, -kEvidence.behind, -kEvidence.in_front);
  if (is_beyond <= 0.0f) return 0.0f;
  // The surface has to end beside the piece, or within 60 degrees of the way to it.
  const float reach = (kEvidence.behind + 2.0f * std::max(0.0f, gap)) * unit;
  float cosines = 0.0f, count = 0.0f, cosines_before = 0.0f, count_before = 0.0f;
  cloud.visitFrom(normal, lastOf(cloud, normal, farthest, unit) - kEvidence.last_points * unit,
                  [&](Eigen::Index i, const Eigen::Vector3f& x, float) {
                    const float cosine = std::abs(normal.dot(normals.col(i)));
                    cosines += cosine;
                    count += 1.0f;
                    if (!piece.reach(x, reach)) return;
                    cosines_before += cosine;
                    count_before += 1.0f;
                  });
  if (count_before == 0.0f) return 0.0f;
  return is_beyond *
         ramp(-std::max(cosines / count, cosines_before / count_before), -kEvidence.closes, -kEvidence.runs_into);
}

namespace {

/// Lower limit of a proportion (Wilson).
float lowerLimit(float count, float total) {
  const float share = count / total, sq = kEvidence.standard_errors * kEvidence.standard_errors / total;
  return (share + 0.5f * sq - std::sqrt(sq * (share * (1.0f - share) + 0.25f * sq))) / (1.0f + sq);
}

/// Regions of samples that are joined as neighbors.
using Regions = boost::disjoint_sets<int*, int*>;

/// The samples of each region, those of the smallest index first.
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

}  // namespace

std::vector<float> missingCounterparts(const SampledSurface& surface, const std::vector<char>& matched,
                                       const std::vector<int>& closest, const Points& reflected) {
  const std::size_t size = matched.size();
  const auto& nearest = surface.geometry.nearest;
  const std::vector<char> near = nearBorders(surface.borders, surface.geometry);
  const auto ends = [&](int i) { return near[i] || (closest[i] >= 0 && near[closest[i]]); };
  std::vector<int> ranks(size, 0), parents = allOf(static_cast<Eigen::Index>(size));
  Regions regions(ranks.data(), parents.data());
  for (std::size_t i = 0; i < size; ++i)
    for (const int j : nearest[i])
      if (!matched[i] && !matched[j]) regions.union_set(static_cast<int>(i), j);
  std::vector<float> edges(size, 0.0f), explained(size, 0.0f);  // of the region with this root
  for (std::size_t i = 0; i < size; ++i) {
    for (const int j : nearest[i]) {
      if (matched[i] == matched[j]) continue;
      const int region = regions.find_set(matched[i] ? j : static_cast<int>(i));
      edges[region] += 1.0f;
      explained[region] += ends(static_cast<int>(i)) || ends(j) ? 1.0f : 0.0f;
    }
  }
  const auto least =
      std::max(kEvidence.min_of_piece, static_cast<std::size_t>(kEvidence.min_piece * static_cast<double>(size)));
  std::vector<float> missing(size, 0.0f);
  for (const std::vector<int>& members : membersOf(regions, matched)) {
    const int region = regions.find_set(members.front());
    float value = 0.0f;
    if (edges[region] > 0.0f) {
      const auto at_borders = std::count_if(members.begin(), members.end(), [&](int i) { return near[i] != 0; });
      // A region all of which lies near borders, as a wire, has its edge near them whatever the plane.
      const float chance = std::min(0.99f, static_cast<float>(at_borders) / static_cast<float>(members.size()));
      const float share = (lowerLimit(explained[region], edges[region]) - chance) / (1.0f - chance);
      value =
          std::clamp((share - kEvidence.min_explained) / (kEvidence.explained - kEvidence.min_explained), 0.0f, 1.0f);
    }
    if (value < 1.0f && members.size() >= least)
      value = std::max(value, beyondEnd(surface.points, surface.geometry.normals,
                                        OutermostPoints(pointsAt(reflected, members)), surface.spacing));
    for (const int i : members) missing[i] = value;
  }
  return missing;
}

namespace {

/// Whether each line along the shortest principal axis meets the surface once, as open ground: it ends all around, and
/// its end is no cut.
bool isOpenSheet(const Points& points) {
  const PrincipalAxes axes = principalAxes(points);
  const double far = kEvidence.far_view * boundingBall(points).radius;
  return layeredShare(points, axes.center + far * axes.axes.col(2)) < kEvidence.layered_sheet;
}

}  // namespace

SurfaceEnds::SurfaceEnds(const Points& points, const LocalGeometry& geometry, const ClosestPointSearch& search,
                         const FoundNeighbors& found, double spacing, int num_threads)
    : geometry_(geometry),
      spacing_(spacing),
      borders_(openBorders(points, search, geometry.normals, num_threads, &found)),
      outermost_(points),
      trust_(isOpenSheet(points) ? 0.0
                                 : std::clamp((kEvidence.borders_everywhere - shareNearBorders(borders_, geometry)) /
                                                  (kEvidence.borders_everywhere - kEvidence.few_borders),
                                              0.0, 1.0)) {}

}  // namespace pcl_symmetry
