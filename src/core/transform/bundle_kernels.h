#pragma once

#include <cstdint>
#include <vector>

#include "core/transform/row_table.h"
#include "pcl_symmetry/core/planar_transform.h"

namespace pcl_symmetry {

/// Parallel lines of equally spaced points, through kRowLanes cells of each of some rows: point l of the first one of
/// row r is start[r] + l * step, in fixed-point cells, for l in [first, last). What lies beyond the cube is 0.
struct Bundle {
  std::int32_t start[kBundleRows][3];
  std::int32_t step[3];
  int first;
  int last;
};

/// Values v of the points of a bundle, in pairs whose products are added up by one instruction. What lies outside of
/// [first, last) is 0.
struct BundleValues {
  static constexpr int kPairs = 2 * kBundleLanes;  ///< numbers of a point: a pair for each lane
  /// Points before the first and behind the last one that kernels read, at most: sums about four points are
  /// worked out together, in as many steps of two as the longest of them needs.
  static constexpr int kMargin = 6;

  explicit BundleValues(int num_points)
      : ahead(static_cast<std::size_t>(num_points + 2 * kMargin) * kPairs),
        back(ahead.size()),
        offsets(static_cast<std::size_t>(num_points) * kBundleRows) {}

  /// \return 2 v[l] and 2 v[l + 1] of each lane, for l >= -kMargin: products of different points count twice.
  std::int16_t* aheadAt(int l) { return ahead.data() + (l + kMargin) * kPairs; }
  const std::int16_t* aheadAt(int l) const { return ahead.data() + (l + kMargin) * kPairs; }
  /// \return v[l] and v[l - 1] of each lane.
  std::int16_t* backAt(int l) { return back.data() + (l + kMargin) * kPairs; }
  const std::int16_t* backAt(int l) const { return back.data() + (l + kMargin) * kPairs; }

  std::vector<std::int16_t> ahead, back;
  std::vector<std::int32_t> offsets;  ///< of the points in their rows, row by row
  int first = 0;
  int last = 0;
};

/// Looks the points of a bundle up, each in the cell that contains it. first and last leave out what is 0 at both ends.
using LookUpBundle = void (*)(const Bundle& bundle, const RowTable::Rows& rows, BundleValues& values);
/// sums[s * kBundleLanes + j] += sum over a + b = s of v[a] v[b] of lane j, each pair of different points in both
/// orders. Up to kPlacesBehind s behind the last one are read and written as well, where 0 is added.
using CorrelateBundle = void (*)(const BundleValues& values, std::int32_t* sums);

constexpr int kPlacesBehind = 8;  // two for each of four points

/// The inner loops of the convolution for one instruction set. All give the same bytes.
struct BundleKernels {
  LookUpBundle look_up;
  CorrelateBundle correlate;
};

/// \return the kernels asked for; with Simd::Auto the fastest that this processor supports.
BundleKernels bundleKernels(Simd simd);

}  // namespace pcl_symmetry
