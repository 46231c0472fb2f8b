#include "core/geometry/open_borders.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/geometry/geometry_rules.h"
#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

namespace {

constexpr std::size_t points_of_block = 512;

/// Whether the neighbors of a sample leave a gap in its tangent plane.
bool isAtBorder(int self, const int* neighbors, int count, const Points& samples, const Points& normals) {
  const Eigen::Vector3f n = normals.col(self), u = n.unitOrthogonal(), v = n.cross(u);
  std::array<float, kGeometry.border_neighbors + 1> angles;
  int num_angles = 0, num_off = 0;
  for (int k = 0; k < count; ++k) {
    if (neighbors[k] == self) continue;
    const Eigen::Vector3f difference = samples.col(neighbors[k]) - samples.col(self);
    if (std::abs(n.dot(difference)) > kGeometry.off_plane * difference.norm()) {
      ++num_off;
      continue;
    }
    angles[num_angles++] = std::atan2(v.dot(difference), u.dot(difference));
  }
  if (num_off > kGeometry.max_off_plane || num_angles == 0) return false;
  std::sort(angles.begin(), angles.begin() + num_angles);
  float gap = angles[0] + 2.0f * static_cast<float>(kPi) - angles[num_angles - 1];
  for (int k = 1; k < num_angles; ++k) gap = std::max(gap, angles[k] - angles[k - 1]);
  return gap > kGeometry.border_gap;
}

}  // namespace

std::vector<char> openBorders(const Points& samples, const ClosestPointSearch& search, const Points& normals,
                              int num_threads, const FoundNeighbors* known) {
  const auto size = static_cast<std::size_t>(samples.cols());
  const int count = static_cast<int>(std::min<Eigen::Index>(samples.cols(), kGeometry.border_neighbors + 1));
  const int num_known = known ? std::min(count, static_cast<int>(known->indices.size() / size)) : 0;
  std::vector<char> borders(size);
  parallelRanges(size, points_of_block, num_threads, [&](std::size_t begin, std::size_t end) {
    std::vector<int> open, indices;
    std::vector<float> sq_distances;
    // More neighbors only fill gaps, or fold the surface: what is inside by some of them is inside by all.
    for (std::size_t i = begin; i < end; ++i) {
      const auto self = static_cast<int>(i);
      const int* const nearest = known ? known->indices.data() + i * known->indices.size() / size : nullptr;
      if (!known || isAtBorder(self, nearest, num_known, samples, normals)) open.push_back(self);
    }
    search.search(pointsAt(samples, open), count, indices, sq_distances);
    for (std::size_t k = 0; k < open.size(); ++k)
      borders[open[k]] = isAtBorder(open[k], &indices[k * static_cast<std::size_t>(count)], count, samples, normals);
  });
  return borders;
}

std::vector<char> nearBorders(const std::vector<char>& borders, const LocalGeometry& geometry) {
  std::vector<char> near = borders;
  for (int step = 0; step < 2; ++step) {
    const std::vector<char> before = near;
    for (std::size_t i = 0; i < near.size(); ++i)
      for (const int j : geometry.nearest[i]) near[i] |= before[j];
  }
  return near;
}

double shareNearBorders(const std::vector<char>& borders, const LocalGeometry& geometry) {
  const std::vector<char> near = nearBorders(borders, geometry);
  std::size_t num_pairs = 0, num_near = 0;
  for (std::size_t i = 0; i < near.size(); ++i) {
    num_pairs += geometry.nearest[i].size();
    for (const int j : geometry.nearest[i]) num_near += near[i] || near[j] ? 1 : 0;
  }
  return num_pairs > 0 ? static_cast<double>(num_near) / static_cast<double>(num_pairs) : 0.0;
}

}  // namespace pcl_symmetry
