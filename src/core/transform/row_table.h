#pragma once

#include <cstdint>
#include <vector>

namespace pcl_symmetry {

/// Lines of a bundle: 32-bit integers in an AVX-512 register.
constexpr int kBundleLanes = 16;
/// Lines of a bundle through cells of the same row, which are looked up by one load: 4 take a quarter more
/// time, of 16 more lie outside of small shapes.
constexpr int kRowLanes = 8;
constexpr int kBundleRows = kBundleLanes / kRowLanes;  // lanes of each of these rows make a bundle

/// The cells of an EDT as bytes in rows along each of the three axes, for points that are many cells of a row: of every
/// step-th cell of a row, kRowLanes lie side by side, whichever is the first. Values are multiplied by
/// LookupTable::kOne; cells beyond a ball and beyond the cube are 0.
class RowTable {
public:
  /// \param f num_cells^3 values in [0, 255 / LookupTable::kOne], x fastest.
  /// \param clip cells whose centers are farther from the middle of the cube are 0, in cells.
  /// \param step between the cells of a row that lie side by side, >= 1.
  /// \param num_threads 0 = one per core.
  RowTable(const std::vector<float>& f, int num_cells, double clip, int step, int num_threads);

  /// Rows along one axis. Cell (x, y, z) has x along it, y along the next axis and z along the one after that,
  /// cyclically. Its byte is bytes[z * of_z + y * of_y + of_x[x]]; x may lie in
  /// [-kRowLanes * step, num_cells), y and z in [0, num_cells).
  struct Rows {
    const std::uint8_t* bytes;
    const std::int32_t* of_x;
    int of_y, of_z;
    int least_x;  ///< that x may have
    int last;     ///< cell of a row
  };
  Rows along(int axis) const {
    return {bytes_.data() + axis * size_,
            of_x_.data() + kRowLanes * step_,
            stride_,
            num_cells_ * stride_,
            -kRowLanes * step_,
            num_cells_ - 1};
  }

private:
  int num_cells_;
  int step_;
  int stride_;        ///< bytes of a row: cells of one phase between kRowLanes cells of nothing
  std::size_t size_;  ///< bytes of one axis
  std::vector<std::int32_t> of_x_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace pcl_symmetry
