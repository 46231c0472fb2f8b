#include "core/transform/moved_lines.h"

#include <algorithm>
#include <cmath>

#include "core/base/simd.h"
#include "core/transform/free_space.h"
#include "core/transform/sampled_transform.h"

namespace pcl_symmetry {

namespace {

/// Fills lines that run along start + moved + k * step, within the ball of the cube.
/// \param moved 3 x lines.size.
PCL_SYMMETRY_MULTIVERSION
void setUpMoved(const float* moved, const float* start, const float* step, float begin, float end,
                const CubeInTable& cube, Lines& lines) {
  const float one = static_cast<float>(1 << LookupTable::kFractionBits);
  const float sx = start[0], sy = start[1], sz = start[2], tx = step[0], ty = step[1], tz = step[2];
  const float sq_clip = cube.sq_clip, to_table = cube.to_table;
  const float inverse = 1.0f / (tx * tx + ty * ty + tz * tz);
  std::int32_t *const lx = lines.x, *const ly = lines.y, *const lz = lines.z;
  std::int32_t *const k_begin = lines.k_begin, *const k_end = lines.k_end;
  const int size = lines.size;
  for (int i = 0; i < size; ++i) {
    const float x = moved[3 * i] + sx, y = moved[3 * i + 1] + sy, z = moved[3 * i + 2] + sz;
    lx[i] = static_cast<std::int32_t>((x + to_table) * one);
    ly[i] = static_cast<std::int32_t>((y + to_table) * one);
    lz[i] = static_cast<std::int32_t>((z + to_table) * one);
    // |x + k step|^2 <= sq_clip, a quadratic inequality in k
    const float middle = -(x * tx + y * ty + z * tz) * inverse;
    const float sq_reach = (sq_clip - (x * x + y * y + z * z)) * inverse + middle * middle;
    const float reach = std::sqrt(std::max(0.0f, sq_reach));
    const float first = std::ceil(middle - reach), last = std::floor(middle + reach) + 1.0f;
    k_begin[i] = static_cast<std::int32_t>(std::min(std::max(first, begin), end));
    k_end[i] = sq_reach > 0.0f ? static_cast<std::int32_t>(std::min(std::max(last, begin), end)) : 0;
  }
}

}  // namespace

MovedLines::MovedLines(const GaussianEdt& edt, const LookupTable& table, LineKernel accumulate, int num_steps)
    : table_(table),
      accumulate_(accumulate),
      sums_(table.numFunctions(), std::vector<std::int32_t>(num_steps + 2 * kLineLanes)),
      storage_(5 * kMostLines) {
  const double middle = 0.5 * (edt.numCells() - 1);
  cube_.middle = static_cast<float>(middle);
  cube_.sq_clip = static_cast<float>(std::pow(middle - 0.5, 2));
  cube_.to_table = table.toTable(Eigen::Vector3d::Constant(middle)).cast<float>()[0];
  for (auto& sums : sums_) sums_of_.push_back(sums.data());
}

void MovedLines::add(const Eigen::Matrix3Xf& moved, const Eigen::Vector3f& start, const Eigen::Vector3f& step,
                     int begin, int end, std::vector<std::vector<double>>& totals) {
  const float one = static_cast<float>(1 << LookupTable::kFractionBits);
  std::int32_t* const data = storage_.data();
  Lines lines{data, data + kMostLines, data + 2 * kMostLines, data + 3 * kMostLines, data + 4 * kMostLines, 0, {}};
  Eigen::Vector3f rounded;
  for (int axis = 0; axis < 3; ++axis) {
    lines.step[axis] = static_cast<std::int32_t>(std::lround(step[axis] * one));
    rounded[axis] = static_cast<float>(lines.step[axis]) / one;
  }
  const int num_samples = static_cast<int>(moved.cols());
  for (int first = 0; first < num_samples; first += kMostLines) {
    lines.size = std::min(kMostLines, num_samples - first);
    setUpMoved(moved.data() + 3 * first, start.data(), rounded.data(), static_cast<float>(begin),
               static_cast<float>(end), cube_, lines);
    for (auto& sums : sums_) std::fill(sums.begin(), sums.end(), 0);
    accumulate_(lines, table_.data(), table_.bits(), sums_of_.data());
    for (std::size_t g = 0; g < totals.size(); ++g)
      for (int k = begin; k < end; ++k) totals[g][k] += sums_[g][k];
  }
}

LookupTable tableOf(const GaussianEdt& edt, const Visibility* visibility, int num_threads) {
  // Sharpened by 1/12: a sample's uniform position in its cell and the look-up of the nearest cell are two boxes.
  std::vector<const float*> functions{edt.interpolation().data()};
  std::vector<float> free_space;
  if (visibility) free_space = freeSpace(edt, *visibility, num_threads);
  if (visibility) functions.push_back(free_space.data());
  return LookupTable(functions, edt.numCells(), num_threads);
}

Eigen::Matrix3Xf centeredSamples(const GaussianEdt& edt, int num_samples, std::uint64_t seed, int num_threads) {
  Eigen::Matrix3Xf samples = drawPoints(edt, num_samples, seed, num_threads);
  samples.array() -= 0.5f * static_cast<float>(edt.numCells() - 1);
  return samples;
}

Eigen::Vector3d toCells(const GaussianEdt& edt, const Eigen::Vector3d& x) {
  return ((x - edt.origin()) / edt.cellSize()).array() - 0.5 * (edt.numCells() - 1);
}

}  // namespace pcl_symmetry
