#include "core/transform/lookup_table.h"

#include "core/base/parallel.h"
#include "core/base/simd.h"

namespace pcl_symmetry {

namespace {

PCL_SYMMETRY_MULTIVERSION
void quantizeRow(const float* values, int num_cells, int stride, std::uint8_t* out) {
  for (int x = 1; x + 1 < num_cells; ++x) {
    const float scaled = values[x] * static_cast<float>(LookupTable::kOne) + 0.5f;
    out[x * stride] = static_cast<std::uint8_t>(static_cast<int>(scaled < 255.0f ? scaled : 255.0f));
  }
}

}  // namespace

LookupTable::LookupTable(const std::vector<const float*>& functions, int num_cells, int num_threads)
    : num_functions_(static_cast<int>(functions.size())) {
  const int n = num_cells;
  if (n == 0) return;
  while ((1 << bits_) < n) ++bits_;
  padding_ = ((1 << bits_) - n) / 2;
  const std::size_t side = std::size_t{1} << bits_;
  table_.assign(num_functions_ * side * side * side + sizeof(std::uint32_t), 0);  // a gather reads four bytes
  parallelBlocks(n - 2, num_threads, [&](std::size_t slice) {
    for (int y = 1; y + 1 < n; ++y) {
      const std::size_t cell = ((slice + 1 + padding_) * side + (y + padding_)) * side + padding_;
      for (int g = 0; g < num_functions_; ++g)
        quantizeRow(functions[g] + ((slice + 1) * n + y) * n, n, num_functions_,
                    table_.data() + num_functions_ * cell + g);
    }
  });
}

}  // namespace pcl_symmetry
