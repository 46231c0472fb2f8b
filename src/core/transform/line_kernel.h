#pragma once

#include <cstddef>
#include <cstdint>

#include "pcl_symmetry/core/planar_transform.h"

namespace pcl_symmetry {

/// Lanes of the widest kernel, 32-bit integers in an AVX2 register; arrays of results are padded by twice as many.
constexpr int kLineLanes = 8;

/// Lines that a kernel adds up at a time, at most: they stay in the first cache (30 kB), and sums of bytes fit
/// in 32 bits.
constexpr int kMostLines = 1024;

/// Equally spaced planes of one normal: n.x = offset + k * step for k in [0, count).
struct ParallelPlanes {
  float normal[3];
  float offset;  ///< cells from the middle of the EDT's cube
  float step;    ///< cells
  int count;
};

/// The EDT's cube of cells and its place in a LookupTable.
struct CubeInTable {
  float middle;    ///< coordinate of its middle, in cells from the first cell center
  float sq_clip;   ///< squared radius of the ball about the middle beyond which f is taken as 0, in cells
  float to_table;  ///< table coordinate of the middle, in cells
};

/// Straight lines through a LookupTable, one for each sample: point k of line i is start_i + k * step, in fixed-point
/// table coordinates, inside the ball for k in [k_begin_i, k_end_i).
struct Lines {
  std::int32_t* x;        ///< start of each line
  std::int32_t* y;        ///< start of each line
  std::int32_t* z;        ///< start of each line
  std::int32_t* k_begin;  ///< of each line
  std::int32_t* k_end;    ///< of each line
  int size;               ///< number of lines, <= kMostLines
  std::int32_t step[3];   ///< of all lines
};

/// Coordinates of samples, each in an array of its own: vectors of several samples are loaded at once.
struct SampleCoordinates {
  const float *x, *y, *z;
};

/// Fills the lines that the images of points run along when the points are reflected in parallel planes.
/// \param points lines.size of them, in cells from the first cell center.
/// \param[out] lines size is given; all but step are filled.
void setUpLines(const SampleCoordinates& points, const ParallelPlanes& planes, const CubeInTable& cube, Lines& lines);

/// sums[g][k] += sum over lines of function g of the table at point k. The sums are integers, so that every kernel
/// gives the same bytes.
using LineKernel = void (*)(const Lines& lines, const std::uint8_t* table, int bits, std::int32_t* const* sums);

/// \param num_functions functions in the table, 1 or 2.
/// \return the kernel asked for; with Simd::Auto the fastest that this processor supports.
LineKernel lineKernel(Simd simd, int num_functions);

}  // namespace pcl_symmetry
