#include "core/transform/row_table.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/transform/lookup_table.h"

namespace pcl_symmetry {

RowTable::RowTable(const std::vector<float>& f, int num_cells, double clip, int step, int num_threads)
    : num_cells_(num_cells), step_(step) {
  const int n = num_cells;
  stride_ = (n + step - 1) / step + kRowLanes;  // the lanes before a row are those after the one before
  const std::size_t of_phase = static_cast<std::size_t>(n) * n * stride_;
  size_ = of_phase * step;
  for (int x = -kRowLanes * step; x < n; ++x) {
    const int shifted = x + kRowLanes * step;
    of_x_.push_back(static_cast<std::int32_t>((shifted % step) * of_phase) + shifted / step);
  }
  bytes_.assign(3 * size_ + 2 * kRowLanes, 0);
  const double middle = 0.5 * (n - 1);
  parallelBlocks(static_cast<std::size_t>(n), num_threads, [&](std::size_t slice) {
    const int c = static_cast<int>(slice);
    for (int b = 0; b < n; ++b) {
      const double sq_left = clip * clip - (b - middle) * (b - middle) - (c - middle) * (c - middle);
      if (sq_left < 0.0) continue;
      const int first = static_cast<int>(std::ceil(middle - std::sqrt(sq_left)));
      const int last = static_cast<int>(std::floor(middle + std::sqrt(sq_left)));
      const float* row = f.data() + (slice * n + b) * n;
      for (int a = first; a <= last; ++a) {
        const float scaled = row[a] * static_cast<float>(LookupTable::kOne) + 0.5f;
        const auto byte = static_cast<std::uint8_t>(static_cast<int>(std::min(scaled, 255.0f)));
        const auto put = [&](int axis, int x, int y, int z) {
          const Rows rows = along(axis);
          bytes_[axis * size_ + static_cast<std::size_t>(z * rows.of_z + y * rows.of_y + rows.of_x[x])] = byte;
        };
        put(0, a, b, c);
        put(1, b, c, a);
        put(2, c, a, b);
      }
    }
  });
}

}  // namespace pcl_symmetry
