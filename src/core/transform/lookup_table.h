#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace pcl_symmetry {

/// Functions on the cells of an EDT as bytes, for the hot loops: a look-up is three shifts and a load.
///
/// Positions are fixed-point numbers of cells. The table is padded to a power of two along each side and has at least
/// one empty cell all around, so that a clipped line needs no further test. Values are multiplied by kOne. Two
/// functions share a table, byte by byte, so that one load gets both.
class LookupTable {
public:
  static constexpr int kFractionBits = 16;  ///< 32 bits hold up to 2^15 cells with 1 / 65536 of a cell
  /// Byte of f = 1: with a sigma of two cells, sharpening lifts f to 1.11 at most (an isolated point); 255 /
  /// 200 leaves room.
  static constexpr double kOne = 200.0;
  static constexpr int kMaxFunctions = 2;  ///< f and the free space of a scan

  /// \param functions one or two functions, each num_cells^3 values in [0, 255 / kOne], x fastest; f is to be sharpened
  /// for the blur of the look-ups.
  LookupTable(const std::vector<const float*>& functions, int num_cells, int num_threads);

  /// \return n of the 2^n cells along each side of the table.
  int bits() const { return bits_; }
  int numFunctions() const { return num_functions_; }
  const std::uint8_t* data() const { return table_.data(); }

  /// \param p position in cells from the center of the EDT's cell (0, 0, 0).
  /// \return position in cells from the corner of the table.
  Eigen::Vector3d toTable(const Eigen::Vector3d& p) const { return p.array() + padding_ + 0.5; }

  /// \return index of the cell that contains a point, given in fixed-point table coordinates.
  static std::uint32_t index(std::int32_t x, std::int32_t y, std::int32_t z, int bits) {
    return (static_cast<std::uint32_t>(z >> kFractionBits) << (2 * bits)) +
           (static_cast<std::uint32_t>(y >> kFractionBits) << bits) + static_cast<std::uint32_t>(x >> kFractionBits);
  }
  /// \return a number of cells in fixed point.
  static std::int32_t toFixed(double cells) { return static_cast<std::int32_t>(cells * (1 << kFractionBits)); }

private:
  int bits_ = 0;
  int num_functions_;
  int padding_ = 0;
  std::vector<std::uint8_t> table_;
};

}  // namespace pcl_symmetry
