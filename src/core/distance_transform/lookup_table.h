#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace pcl_symmetry {

/// f as bytes for the hot loops: positions are fixed-point numbers of cells, a look-up is three shifts and a load.
///
/// The table is padded to a power of two along each side, with at least one empty cell all around, so that a clipped
/// line needs no further test. Values are multiplied by kOne; f is given sharpened for the blur of the look-ups. Two
/// functions share a table, byte by byte, so that one load gets both.
class LookupTable {
public:
  static constexpr int kFractionBits = 16;
  static constexpr double kOne = 200.0;  ///< sharpening lifts f a little above 1

  static constexpr int kMaxFunctions = 2;

  /// \param functions one or two: values of the cells of an EDT, num_cells along each side, in [0, 255 / kOne].
  LookupTable(const std::vector<std::vector<float>>& functions, int num_cells, int num_threads);

  int bits() const { return bits_; }
  int numFunctions() const { return num_functions_; }
  const std::uint8_t* data() const { return table_.data(); }

  /// Table coordinates (cells, of a corner) of a point at \p p cells from the EDT's first cell center.
  Eigen::Vector3d toTable(const Eigen::Vector3d& p) const { return p.array() + padding_ + 0.5; }

  /// Index of the cell that holds a point given in fixed-point table coordinates.
  static std::uint32_t index(std::int32_t x, std::int32_t y, std::int32_t z, int bits) {
    return (static_cast<std::uint32_t>(z >> kFractionBits) << (2 * bits)) +
           (static_cast<std::uint32_t>(y >> kFractionBits) << bits) + static_cast<std::uint32_t>(x >> kFractionBits);
  }
  static std::int32_t toFixed(double cells) { return static_cast<std::int32_t>(cells * (1 << kFractionBits)); }

private:
  int bits_ = 0;
  int num_functions_;
  int padding_ = 0;
  std::vector<std::uint8_t> table_;
};

}  // namespace pcl_symmetry
