#pragma once

#include <pcl/common/point_tests.h>
#include <pcl/point_cloud.h>

#include <cstdint>

#include "core/base/random.h"
#include "pcl_symmetry/core/geometry/point_set.h"

namespace pcl_symmetry {

/// The points of a cloud that an analysis uses.
struct SelectedPoints {
  Points points;         ///< 3 x N, finite
  pcl::Indices indices;  ///< N indices into the cloud
};

/// The finite points of a cloud, or of its \p indices where not null; of more than \p max_points one from each of
/// max_points equal runs is drawn, so that neither time nor memory grow with the cloud.
template <typename PointT>
SelectedPoints selectPoints(const pcl::PointCloud<PointT>& cloud, const pcl::Indices* indices, std::size_t max_points,
                            std::uint64_t seed) {
  const std::size_t size = indices ? indices->size() : cloud.size();
  const auto at = [&](std::size_t i) { return indices ? (*indices)[i] : static_cast<pcl::index_t>(i); };
  std::size_t num_finite = 0;
  for (std::size_t i = 0; i < size; ++i) num_finite += pcl::isXYZFinite(cloud[at(i)]) ? 1 : 0;

  const std::size_t num_selected = std::min(num_finite, max_points);
  SelectedPoints selected{Points(3, num_selected), pcl::Indices(num_selected)};
  RandomStream random(seed);
  const auto target = [&](std::size_t slot) {
    if (num_selected == num_finite) return slot;
    const double run = static_cast<double>(num_finite) / static_cast<double>(num_selected);
    return std::min(num_finite - 1, static_cast<std::size_t>((static_cast<double>(slot) + random.uniform()) * run));
  };
  std::size_t slot = 0, finite = 0;
  std::size_t next = num_selected > 0 ? target(0) : 0;
  for (std::size_t i = 0; i < size && slot < num_selected; ++i) {
    const PointT& point = cloud[at(i)];
    if (!pcl::isXYZFinite(point) || finite++ < next) continue;
    selected.points.col(slot) = point.getVector3fMap();
    selected.indices[slot] = at(i);
    if (++slot < num_selected) next = std::max(target(slot), finite);
  }
  return selected;
}

}  // namespace pcl_symmetry
