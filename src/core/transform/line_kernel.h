#pragma once

#include <cstdint>

#include "pcl_symmetry/core/transform/planar_transform.h"

namespace pcl_symmetry {

/// The widest vector of any kernel; result arrays are padded by twice as many.
constexpr int kLineLanes = 16;

/// Straight lines through a LookupTable, one for each sample: point k of line i is start_i + k * step, in fixed-point
/// table coordinates, inside the table for k in [k_begin_i, k_end_i).
struct Lines {
  std::int32_t* x;
  std::int32_t* y;
  std::int32_t* z;
  std::int32_t* k_begin;
  std::int32_t* k_end;
  int size;
  std::int32_t step[3];
};

/// Fills the lines of the reflections of \p points in the planes of one normal.
/// \param points 3 x size, cells from the first cell center. \param middle the middle of the cube in the same units.
/// \param n unit normal. \param offset of the first plane from the middle. \param step between planes.
/// \param sq_clip squared radius of the ball about the middle beyond which f is taken as 0.
/// \param to_table table coordinate of the middle. \param one fixed-point unit.
void setUpLines(const float* points, float middle, const float* n, float offset, float step, int num_planes,
                float sq_clip, float to_table, float one, Lines& lines);

/// sums[g][k] += sum over lines of function g of the table at point k. Integers: every kernel gives the same bytes.
using LineKernel = void (*)(const Lines& lines, const std::uint8_t* table, int bits, std::int32_t* const* sums);

/// \param num_functions of the table. \return the kernel asked for, or the fastest that this processor runs.
LineKernel lineKernel(Simd simd, int num_functions);

}  // namespace pcl_symmetry
