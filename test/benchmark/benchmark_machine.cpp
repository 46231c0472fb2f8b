/// The smallest steps of the library's work, as fast as a loop of nothing else runs them: the units of roofline.py.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/random.h"
#include "core/base/simd.h"

namespace {

using pcl_symmetry::RandomStream;

constexpr int kSide = 64;  // cells along a side of the tables: those of the default options

/// Indices of cells along straight lines through a table, two cells a step, as reflected samples move.
std::vector<std::int32_t> cellsOnLines() {
  RandomStream random(1);
  std::vector<std::int32_t> cells;
  for (int line = 0; line < 64; ++line) {
    double start[3], step[3], length = 0.0;
    for (double& s : step) s = random.uniform() - 0.5;
    for (const double s : step) length += s * s;
    for (int axis = 0; axis < 3; ++axis) {
      step[axis] *= 2.0 / std::sqrt(length);
      start[axis] = kSide * random.uniform();
    }
    for (int k = 0; k < 32; ++k) {
      std::int32_t cell = 0;
      for (int axis = 2; axis >= 0; --axis)
        cell = kSide * cell + (static_cast<std::int32_t>(start[axis] + k * step[axis]) & (kSide - 2));
      cells.push_back(cell);
    }
  }
  return cells;
}

PCL_SYMMETRY_MULTIVERSION
std::int32_t sumOfBytes(const std::uint8_t* table, const std::int32_t* cells, int count) {
  std::int32_t sum = 0;
  for (int i = 0; i < count; ++i) sum += table[cells[i]];
  return sum;
}

float sumOfInterpolated(const float* f, const std::int32_t* cells, int count, float t) {
  constexpr int kRow = kSide, kSlice = kSide * kSide;
  float sum = 0.0f;
  for (int i = 0; i < count; ++i) {
    const float* v = f + cells[i];
    const auto along = [&](int offset) { return v[offset] + t * (v[offset + 1] - v[offset]); };
    const float near = along(0) + t * (along(kRow) - along(0));
    const float far = along(kSlice) + t * (along(kSlice + kRow) - along(kSlice));
    sum += near + t * (far - near);
  }
  return sum;
}

PCL_SYMMETRY_MULTIVERSION
void distancesFrom(const float* x, const float* y, const float* z, int count, const float* query, float* sq_distances) {
  const float qx = query[0], qy = query[1], qz = query[2];
  for (int i = 0; i < count; ++i) {
    const float dx = x[i] - qx, dy = y[i] - qy, dz = z[i] - qz;
    sq_distances[i] = dx * dx + dy * dy + dz * dz;
  }
}

PCL_SYMMETRY_MULTIVERSION
std::int64_t sumOf(const std::int64_t* values, std::size_t count) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += values[i];
  return sum;
}

/// \param num_steps of one call of body().
template <typename Body>
void runSteps(benchmark::State& state, std::size_t num_steps, const Body& body) {
  for (auto _ : state) body();
  state.counters["steps"] = static_cast<double>(num_steps);
}

void Machine_look_up(benchmark::State& state) {
  const std::vector<std::int32_t> cells = cellsOnLines();
  const std::vector<std::uint8_t> table(kSide * kSide * kSide, 1);
  runSteps(state, cells.size(),
           [&] { benchmark::DoNotOptimize(sumOfBytes(table.data(), cells.data(), static_cast<int>(cells.size()))); });
}

void Machine_trilinear(benchmark::State& state) {
  const std::vector<std::int32_t> cells = cellsOnLines();
  const std::vector<float> table(kSide * kSide * (kSide + 2), 1.0f);  // interpolation reads the next slice too
  runSteps(state, cells.size(), [&] {
    benchmark::DoNotOptimize(sumOfInterpolated(table.data(), cells.data(), static_cast<int>(cells.size()), 0.5f));
  });
}

void Machine_exponential(benchmark::State& state) {
  std::vector<double> exponents(4096);
  for (std::size_t i = 0; i < exponents.size(); ++i) exponents[i] = -9.0 * static_cast<double>(i) / 4096.0;
  runSteps(state, exponents.size(), [&] {
    double sum = 0.0;
    for (const double x : exponents) sum += std::exp(x);
    benchmark::DoNotOptimize(sum);
  });
}

/// A query that keeps the nearest of points that lie side by side: a cell of a grid and those about it.
void Machine_nearest(benchmark::State& state) {
  constexpr int kNumStored = 4096, kNumQueries = 2048;  // 48 kB, those of a part of a cloud
  const auto shown = static_cast<std::size_t>(state.range(0)), kept = static_cast<std::size_t>(state.range(1));
  RandomStream random(2);
  std::vector<float> coordinates(3 * kNumStored);
  for (float& value : coordinates) value = static_cast<float>(random.uniform());
  const float *const x = coordinates.data(), *const y = x + kNumStored, *const z = y + kNumStored;
  std::vector<float> sq_distances(shown), nearest(kept);
  runSteps(state, kNumQueries, [&] {
    for (std::size_t q = 0; q < kNumQueries; ++q) {
      const std::size_t first = q * 37 % (kNumStored - shown);
      const float query[3] = {x[q], y[q], z[q]};
      distancesFrom(x + first, y + first, z + first, static_cast<int>(shown), query, sq_distances.data());
      std::fill(nearest.begin(), nearest.end(), std::numeric_limits<float>::max());
      for (const float sq_distance : sq_distances) {
        if (!(sq_distance < nearest.back())) continue;
        std::size_t i = kept - 1;
        for (; i > 0 && nearest[i - 1] > sq_distance; --i) nearest[i] = nearest[i - 1];
        nearest[i] = sq_distance;
      }
      benchmark::DoNotOptimize(nearest.data());
    }
  });
}

/// Bytes that are read again and again: from the second cache, and from memory.
void Machine_byte(benchmark::State& state) {
  const std::vector<std::int64_t> values(static_cast<std::size_t>(state.range(0)) << 7, 1);
  runSteps(state, values.size() * sizeof(std::int64_t),
           [&] { benchmark::DoNotOptimize(sumOf(values.data(), values.size())); });
}

BENCHMARK(Machine_look_up);
BENCHMARK(Machine_trilinear);
BENCHMARK(Machine_exponential);
BENCHMARK(Machine_nearest)->ArgNames({"of", "kept"})->Args({32, 1})->Args({64, 9});
BENCHMARK(Machine_byte)->ArgName("kB")->Arg(256)->Arg(256 << 10);

}  // namespace
