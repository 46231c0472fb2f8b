#include "core/transform/sampled_transform.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/base/simd.h"
#include "core/distance_transform/edt_samples.h"
#include "core/distance_transform/free_space.h"
#include "core/distance_transform/lookup_table.h"
#include "core/transform/line_kernel.h"
#include "pcl_symmetry/core/scan/visibility.h"

namespace pcl_symmetry {

namespace {

/// (S / |f|^2) mean g(gamma x_i) at every bin for each function g.
/// \param table of the functions.
std::vector<std::vector<float>> sampleMeans(const GaussianEdt& edt, const PlaneGrid& grid,
                                            const SampledTransformOptions& options, const LookupTable& table) {
  options.validate();
  const Eigen::Matrix3Xf points = drawPoints(edt, options.num_samples, options.seed, options.num_threads);
  const LineKernel accumulate = lineKernel(options.simd, table.numFunctions());

  // Everything below is in cells, relative to the middle of the EDT's cube.
  const double middle = 0.5 * (edt.numCells() - 1);
  const Eigen::Vector3f center =
      ((grid.center() - edt.origin()) / edt.cellSize()).cast<float>() - Eigen::Vector3f::Constant(middle);
  const float radius_step = static_cast<float>(grid.radiusStep() / edt.cellSize());
  const float first_offset = static_cast<float>(grid.offset(0) / edt.cellSize());
  const float sq_clip = static_cast<float>(std::pow(middle - 0.5, 2));
  const Eigen::Vector3f to_table = table.toTable(Eigen::Vector3d::Constant(middle)).cast<float>();
  const float one = static_cast<float>(1 << LookupTable::kFractionBits);

  std::vector<std::vector<float>> means(table.numFunctions(), std::vector<float>(grid.size()));
  const double scale = edt.sum() / (edt.sqNorm() * options.num_samples * LookupTable::kOne);
  const int num_radius = grid.numRadius();
  constexpr std::size_t kDirectionsPerBlock = 32;
  constexpr int kChunk = 1024;  // samples that are set up at a time
  parallelRanges(
      grid.numDirections(), kDirectionsPerBlock, options.num_threads, [&](std::size_t begin, std::size_t end) {
        std::vector<std::vector<std::int32_t>> sums(means.size(),
                                                    std::vector<std::int32_t>(num_radius + 2 * kLineLanes));
        std::vector<std::int32_t*> sum_of;
        for (auto& sum : sums) sum_of.push_back(sum.data());
        std::vector<std::int32_t> lines(5 * kChunk);
        Lines batch{lines.data(),
                    lines.data() + kChunk,
                    lines.data() + 2 * kChunk,
                    lines.data() + 3 * kChunk,
                    lines.data() + 4 * kChunk,
                    0,
                    {}};
        std::vector<std::vector<double>> totals(means.size(), std::vector<double>(num_radius));
        for (std::size_t direction = begin; direction < end; ++direction) {
          const Eigen::Vector3f n =
              grid.normal(static_cast<int>(direction / grid.numPhi()), static_cast<int>(direction % grid.numPhi()))
                  .cast<float>();
          const float offset = n.dot(center) + first_offset;  // of the first plane from the middle of the cube
          for (int axis = 0; axis < 3; ++axis)
            batch.step[axis] = static_cast<std::int32_t>(std::lround(2.0f * radius_step * n[axis] * one));
          for (auto& total : totals) std::fill(total.begin(), total.end(), 0.0);
          for (int first = 0; first < options.num_samples; first += kChunk) {
            batch.size = std::min(kChunk, options.num_samples - first);
            setUpLines(points.data() + 3 * first, static_cast<float>(middle), n.data(), offset, radius_step, num_radius,
                       sq_clip, to_table[0], one, batch);
            for (auto& sum : sums) std::fill(sum.begin(), sum.end(), 0);
            accumulate(batch, table.data(), table.bits(), sum_of.data());
            for (std::size_t g = 0; g < sums.size(); ++g)
              for (int k = 0; k < num_radius; ++k) totals[g][k] += sums[g][k];
          }
          for (std::size_t g = 0; g < means.size(); ++g)
            for (int k = 0; k < num_radius; ++k)
              means[g][direction * num_radius + k] = static_cast<float>(scale * totals[g][k]);
        }
      });
  return means;
}

std::vector<float> checkedFreeSpace(const GaussianEdt& edt, const std::vector<float>& free_space) {
  check(free_space.size() == edt.values().size(), "free_space size", free_space.size(), "one value per cell");
  return free_space;
}

}  // namespace

bool simdSupported(Simd simd) {
#if defined(__x86_64__)
  if (simd == Simd::Avx2) return __builtin_cpu_supports("avx2");
  if (simd == Simd::Avx512) return __builtin_cpu_supports("avx512f");
#endif
  return simd == Simd::Auto || simd == Simd::Scalar;
}

void SampledTransformOptions::validate() const {
  check(num_samples >= 1 && num_samples <= 10'000'000, "num_samples", num_samples, "in [1, 10000000]");
  checkNumThreads(num_threads);
  check(simdSupported(simd), "simd", static_cast<int>(simd), "one that this processor supports");
}

SymmetryMap sampledTransform(const GaussianEdt& edt, const PlaneGrid& grid, const SampledTransformOptions& options,
                             const std::vector<float>& free_space) {
  // Jitter within the cell and look-up of the nearest cell: two boxes.
  std::vector<std::vector<float>> functions{edt.sharpened(1.0 / 12.0, options.num_threads)};
  if (!free_space.empty()) functions.push_back(checkedFreeSpace(edt, free_space));
  const LookupTable table(functions, edt.numCells(), options.num_threads);
  std::vector<std::vector<float>> means = sampleMeans(edt, grid, options, table);
  SymmetryMap map;
  map.grid = grid;
  map.values = std::move(means[0]);
  map.method = TransformMethod::Sampled;
  map.sigma = edt.sigma();
  map.center_of_mass = grid.center();
  if (!free_space.empty()) weighSeen(map, means[1]);
  return map;
}

std::vector<float> freeOverlap(const GaussianEdt& edt, const PlaneGrid& grid, const std::vector<float>& free_space,
                               const SampledTransformOptions& options) {
  const LookupTable table({checkedFreeSpace(edt, free_space)}, edt.numCells(), options.num_threads);
  return std::move(sampleMeans(edt, grid, options, table)[0]);
}

void weighSeen(SymmetryMap& map, const std::vector<float>& free_overlap) {
  for (std::size_t i = 0; i < map.values.size(); ++i)
    map.values[i] = static_cast<float>(seenSymmetry(map.values[i], free_overlap[i]));
}

}  // namespace pcl_symmetry
