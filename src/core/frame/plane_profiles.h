#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/distance_transform/free_space.h"
#include "pcl_symmetry/core/distance_transform/gaussian_edt.h"

namespace pcl_symmetry {

/// A plane in the frame of a grid of cells: normal.x = offset, x in cells from the middle of the grid.
struct CellPlane {
  Eigen::Vector3f normal;
  float offset;
};

/// Scores of many planes of one normal: what the sampled transform tells at bin centers, for any plane, and of a scan
/// that has been completed across a first plane.
class PlaneProfiles {
public:
  /// \param free_space as of freeSpace(); empty: every point has been seen.
  PlaneProfiles(const GaussianEdt& edt, const std::vector<float>& free_space, int num_samples, std::uint64_t seed,
                int num_threads);

  /// D at, or of a scan seenSymmetry() of D and F at the planes with offsets first, first + step ..., \p count of them.
  /// \param across of a scan: surface and free space are known on both sides of this plane as they are seen on one of
  /// them; must be perpendicular to \p normal. Null: they are not.
  std::vector<float> scores(const Eigen::Vector3f& normal, float first, float step, int count,
                            const CellPlane* across = nullptr) const;
  float score(const CellPlane& plane, const CellPlane* across = nullptr) const {
    return scores(plane.normal, plane.offset, 0.0f, 1, across)[0];
  }

  const Eigen::Matrix3Xf& samples() const { return samples_; }

private:
  struct Cell {
    std::uint8_t surface, free;
  };
  Cell at(float x, float y, float z) const {
    const auto i = static_cast<std::uint32_t>(static_cast<int>(x));
    const auto j = static_cast<std::uint32_t>(static_cast<int>(y));
    const auto k = static_cast<std::uint32_t>(static_cast<int>(z));
    return i < size_ && j < size_ && k < size_ ? cells_[(k * size_ + j) * size_ + i] : outside_;
  }

  std::uint32_t size_;
  float middle_;
  bool scanned_;
  Cell outside_;
  std::vector<Cell> cells_;
  Eigen::Matrix3Xf samples_;  // cells from the middle
};

}  // namespace pcl_symmetry
