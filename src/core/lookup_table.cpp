#include "lookup_table.h"

#include <algorithm>

namespace pcl_symmetry {

LookupTable::LookupTable(const GaussianEdt& edt, double sharpening) {
  const int n = edt.numCells();
  while ((1 << bits_) < n) ++bits_;
  padding_ = ((1 << bits_) - n) / 2;
  const std::vector<float> values = edt.sharpened(sharpening);
  const std::size_t side = std::size_t{1} << bits_;
  table_.assign(side * side * side + sizeof(std::uint32_t), 0);  // a gather reads four bytes
  for (int z = 1; z + 1 < n; ++z) {
    for (int y = 1; y + 1 < n; ++y) {
      const float* row = values.data() + (static_cast<std::size_t>(z) * n + y) * n;
      std::uint8_t* out = table_.data() + ((z + padding_) * side + (y + padding_)) * side + padding_;
      for (int x = 1; x + 1 < n; ++x)
        out[x] = static_cast<std::uint8_t>(std::min(255.0f, row[x] * static_cast<float>(kOne) + 0.5f));
    }
  }
}

}  // namespace pcl_symmetry
