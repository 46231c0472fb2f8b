/// How close each place is to a mesh: a table for searches that look up millions of places.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "evaluate/mesh/mesh_distance.h"

namespace pcl_symmetry::apps {

/// Holds (1 - d^2 / reach^2)^2 of the distance d to the mesh at the middle of each cell, 0 beyond the reach. Works in
/// the frame of the TriangleScene; distances are exact ones to the triangles.
class ClosenessGrid {
public:
  static constexpr int kCells = 96;         ///< along an edge; chosen: half blurs by more than a step of planes
  static constexpr double kHalfEdge = 0.6;  ///< diagonals; derived: the mesh lies within 0.5, the reach is up to 0.1

  /// \param reach diagonals, > 0, at most 0.1.
  ClosenessGrid(const TriangleScene& scene, double reach, int num_threads);

  /// \return in [0, 255]; 0 outside the grid.
  int at(const Eigen::Vector3f& x) const {
    constexpr float kScale = kCells / (2.0f * static_cast<float>(kHalfEdge));  // derived: cells in a diagonal
    const Eigen::Vector3f cell = (x.array() + static_cast<float>(kHalfEdge)) * kScale;
    if (!(cell.minCoeff() >= 0.0f && cell.maxCoeff() < static_cast<float>(kCells))) return 0;
    return values_[(static_cast<std::size_t>(cell.z()) * kCells + static_cast<std::size_t>(cell.y())) * kCells +
                   static_cast<std::size_t>(cell.x())];
  }

private:
  void fillBlock(const MeshDistance& distance, double reach, const std::array<int, 3>& first);

  std::vector<std::uint8_t> values_;
};

}  // namespace pcl_symmetry::apps
