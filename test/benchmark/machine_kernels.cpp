#include "speed/machine_kernels.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "core/base/random.h"
#include "core/base/simd.h"
#include "speed/processor_time.h"

namespace pcl_symmetry::benchmarks {

namespace {

constexpr int kRepeats = 15;  // chosen: half leaves the least times apart by a tenth, twice takes twice the time
constexpr int kSide = 64;     // cells along a side of the tables. derived: those of the default options

/// Keeps the compiler from leaving out what nobody reads.
template <typename Value>
void use(const Value& value) {
  asm volatile("" : : "g"(&value) : "memory");
}

/// Nanoseconds of one of \p count steps that body() takes.
template <typename Body>
double nanosecondsOf(std::size_t count, const Body& body) {
  return 1e6 * leastMilliseconds(kRepeats, body) / static_cast<double>(count);
}

/// Indices of cells along straight lines through a table, two cells a step, as reflected samples move.
std::vector<std::int32_t> cellsOnLines(int num_lines, int num_steps) {
  RandomStream random(1);
  std::vector<std::int32_t> cells;
  for (int line = 0; line < num_lines; ++line) {
    double place[3], step[3], length = 0.0;
    for (double& s : step) s = random.uniform() - 0.5;
    for (const double s : step) length += s * s;
    for (int axis = 0; axis < 3; ++axis) {
      step[axis] *= 2.0 / std::sqrt(length);
      place[axis] = kSide * random.uniform();
    }
    for (int k = 0; k < num_steps; ++k) {
      std::int32_t cell = 0;
      for (int axis = 2; axis >= 0; --axis)
        cell = kSide * cell + (static_cast<std::int32_t>(place[axis] + k * step[axis]) & (kSide - 2));
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

/// Time of one query that keeps the \p kept nearest of \p shown points, which lie side by side.
double timeOfNearest(int shown, int kept) {
  constexpr int kNumStored = 4096;  // derived: 48 kB, those of a part of a cloud
  constexpr int kNumQueries = 2048;
  RandomStream random(2);
  std::vector<float> coordinates(3 * kNumStored);
  for (float& value : coordinates) value = static_cast<float>(random.uniform());
  const float *const x = coordinates.data(), *const y = x + kNumStored, *const z = y + kNumStored;
  std::vector<float> sq_distances(shown), nearest(kept);
  return nanosecondsOf(kNumQueries, [&] {
    for (int q = 0; q < kNumQueries; ++q) {
      const int first = q * 37 % (kNumStored - shown);
      const float query[3] = {x[q], y[q], z[q]};
      distancesFrom(x + first, y + first, z + first, shown, query, sq_distances.data());
      std::fill(nearest.begin(), nearest.end(), std::numeric_limits<float>::max());
      for (const float sq_distance : sq_distances) {
        if (!(sq_distance < nearest.back())) continue;
        int i = kept - 1;
        for (; i > 0 && nearest[i - 1] > sq_distance; --i) nearest[i] = nearest[i - 1];
        nearest[i] = sq_distance;
      }
      use(nearest);
    }
  });
}

PCL_SYMMETRY_MULTIVERSION
std::int64_t sumOf(const std::int64_t* values, std::size_t count) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += values[i];
  return sum;
}

/// Time of one byte of \p num_bytes that are read again and again.
double timeOfByte(std::size_t num_bytes, int rounds) {
  const std::vector<std::int64_t> values(num_bytes / sizeof(std::int64_t), 1);
  return nanosecondsOf(rounds * num_bytes, [&] {
    for (int round = 0; round < rounds; ++round) use(sumOf(values.data(), values.size()));
  });
}

}  // namespace

std::vector<MachineStep> measureMachine() {
  constexpr int kNumLines = 64, kNumLineSteps = 32, kRounds = 200;
  const std::vector<std::int32_t> cells = cellsOnLines(kNumLines, kNumLineSteps);
  const int num_cells = static_cast<int>(cells.size());
  // A slice more than the cells, as interpolation reads the next ones.
  constexpr std::size_t kTableSize = static_cast<std::size_t>(kSide) * kSide * (kSide + 2);
  const std::vector<std::uint8_t> bytes(kTableSize, 1);
  const std::vector<float> floats(kTableSize, 1.0f);
  std::vector<double> exponents(4096);
  for (std::size_t i = 0; i < exponents.size(); ++i) exponents[i] = -9.0 * static_cast<double>(i) / 4096.0;
  const auto num_look_ups = static_cast<std::size_t>(kRounds * num_cells);
  return {{"look-up of a byte on a line", nanosecondsOf(num_look_ups,
                                                        [&] {
                                                          for (int round = 0; round < kRounds; ++round)
                                                            use(sumOfBytes(bytes.data(), cells.data(), num_cells));
                                                        })},
          {"look-up between eight values", nanosecondsOf(num_look_ups,
                                                         [&] {
                                                           for (int round = 0; round < kRounds; ++round)
                                                             use(sumOfInterpolated(floats.data(), cells.data(),
                                                                                   num_cells, 0.5f));
                                                         })},
          {"exponential", nanosecondsOf(exponents.size(),
                                        [&] {
                                          double sum = 0.0;
                                          for (const double x : exponents) sum += std::exp(x);
                                          use(sum);
                                        })},
          {"nearest of 32 points", timeOfNearest(32, 1)},
          {"nine nearest of 64 points", timeOfNearest(64, 9)},
          {"byte of the second cache", timeOfByte(256u << 10, 64)},
          {"byte of memory", timeOfByte(256u << 20, 1)}};
}

}  // namespace pcl_symmetry::benchmarks
