#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/gaussian_edt.h"

namespace pcl_symmetry {

/// A plane in the frame of a grid of cells: normal . x = offset, x in cells from the middle of the grid.
struct CellPlane {
  Eigen::Vector3f normal;  ///< unit
  float offset;            ///< cells
};

/// Scores of all planes of one normal at any offsets: a profile along the normal.
///
/// The sampled transform (Section 4.3) gives scores at bin centers. Profiles give them for any plane, and for a scan
/// that has been completed by its reflection in a first plane. Values are kept in 8 bits: before sampling, D is exact
/// to 0.002.
class PlaneProfiles {
public:
  /// \param free_space one value in [0, 1] per cell, from freeSpace(); empty: the points show the object from all
  /// sides.
  /// \param num_samples points drawn from the distance transform, >= 1.
  PlaneProfiles(const GaussianEdt& edt, const std::vector<float>& free_space, int num_samples, std::uint64_t seed,
                int num_threads);

  /// Scores at evenly spaced offsets.
  /// \param normal unit.
  /// \param first first offset, cells from the middle of the grid.
  /// \param step distance between neighboring offsets, cells.
  /// \param completed_across a plane perpendicular to \p normal. The surface and the free space on each side of it then
  /// also count on the other side: the completed cloud of a scan. Null: the points are taken as they are.
  /// \return \p count values: D for a whole cloud, seenSymmetry() of D and F for a scan.
  std::vector<float> scores(const Eigen::Vector3f& normal, float first, float step, int count,
                            const CellPlane* completed_across = nullptr) const;

  /// The score of one plane.
  float score(const CellPlane& plane) const { return scores(plane.normal, plane.offset, 0.0f, 1)[0]; }

private:
  /// Sums over the images of the samples, in units of 1/255.
  struct Sums {
    int surface, free;
  };

  static Sums sumsOf(const std::uint32_t* cells, const std::uint32_t* images, const std::uint32_t* completed,
                     int count);
  static int surfaceOf(std::uint32_t cell) { return static_cast<int>(cell & 255u); }
  static int freeOf(std::uint32_t cell) { return static_cast<int>(cell >> 8); }

  int surfaceAt(const Eigen::ArrayX3f& samples, Eigen::Index s) const {
    const auto index = [&](int axis) {
      return static_cast<std::uint32_t>(static_cast<int>(samples(s, axis) + (middle_ + 0.5f)));
    };
    const std::uint32_t i = index(0), j = index(1), k = index(2);
    return surfaceOf(i < size_ && j < size_ && k < size_ ? cells_[(k * size_ + j) * size_ + i] : outside_);
  }

  std::uint32_t size_;
  float middle_;
  bool scanned_;
  std::uint32_t outside_;
  // 255 times f, and from bit 8 on 255 times free space; the last one is for all positions outside.
  std::vector<std::uint32_t> cells_;
  Eigen::ArrayX3f samples_;  // cells from the middle of the grid
  std::vector<int> own_;     // 255 times f at each sample
};

}  // namespace pcl_symmetry
