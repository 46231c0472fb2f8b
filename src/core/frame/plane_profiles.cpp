#include "core/frame/plane_profiles.h"

#include <algorithm>
#include <array>

#include "core/base/simd.h"
#include "core/base/x86_intrinsics.h"
#include "core/transform/edt_samples.h"
#include "core/transform/free_space.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

PlaneProfiles::PlaneProfiles(const GaussianEdt& edt, const std::vector<float>& free_space, int num_samples,
                             std::uint64_t seed, int num_threads)
    : size_(static_cast<std::uint32_t>(edt.numCells())),
      middle_(0.5f * static_cast<float>(edt.numCells() - 1)),
      scanned_(!free_space.empty()),
      outside_{0, static_cast<std::uint8_t>(scanned_ ? 255 : 0)},
      cells_(edt.values().size()),
      samples_(drawPoints(edt, num_samples, seed, num_threads).array() - middle_) {
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    cells_[i].surface = static_cast<std::uint8_t>(255.0f * edt.values()[i] + 0.5f);
    cells_[i].free = free_space.empty() ? 0 : static_cast<std::uint8_t>(255.0f * free_space[i] + 0.5f);
  }
  cells_.insert(cells_.end(), 2, outside_);  // two are read at once
}

/// The images of all samples on their way through the grid.
class PlaneProfiles::Walk {
public:
  explicit Walk(std::size_t size) : x_(size), y_(size), z_(size), cells_(size) {}

  /// \param place in cells from the corner of the grid.
  void start(std::size_t sample, const Eigen::Vector3f& place) {
    x_[sample] = place.x();
    y_[sample] = place.y();
    z_[sample] = place.z();
  }

  /// \return the cell of each image, size^3 outside the grid; afterwards each is moved.
  const std::uint32_t* cellsThenMove(const Eigen::Vector3f& move, std::uint32_t size) {
    step({x_.data(), y_.data(), z_.data()}, x_.size(), {move.x(), move.y(), move.z()}, size, cells_.data());
    return cells_.data();
  }

private:
  static void step(const std::array<float*, 3>& places, std::size_t count, const std::array<float, 3>& move,
                   std::uint32_t size, std::uint32_t* cells);

  std::vector<float> x_, y_, z_;
  std::vector<std::uint32_t> cells_;
};

PCL_SYMMETRY_MULTIVERSION
void PlaneProfiles::Walk::step(const std::array<float*, 3>& places, std::size_t count, const std::array<float, 3>& move,
                               std::uint32_t size, std::uint32_t* cells) {
  float *const x = places[0], *const y = places[1], *const z = places[2];
  const float dx = move[0], dy = move[1], dz = move[2];
  const std::uint32_t outside = size * size * size;
#pragma GCC ivdep
  for (std::size_t s = 0; s < count; ++s) {
    const auto i = static_cast<std::uint32_t>(static_cast<int>(x[s]));
    const auto j = static_cast<std::uint32_t>(static_cast<int>(y[s]));
    const auto k = static_cast<std::uint32_t>(static_cast<int>(z[s]));
    const std::uint32_t cell = (k * size + j) * size + i;
    cells[s] = ((i < size) & (j < size) & (k < size)) ? cell : outside;
    x[s] += dx;
    y[s] += dy;
    z[s] += dz;
  }
}

/// Sums over the images of the samples: of the surface, and of free space, 255 for one.
struct PlaneProfiles::Sums {
  int surface = 0, free = 0;
};

#if defined(__x86_64__)

/// sumsAt() for 16 samples at a time.
__attribute__((target("avx512f"))) PlaneProfiles::Sums PlaneProfiles::sumsAvx512(const std::uint32_t* images,
                                                                                 const std::uint32_t* completed) const {
  constexpr int lanes = 16;  // numbers of 32 bits in a register
  static_assert(sizeof(Cell) == 2);
  const __m512i byte = _mm512_set1_epi32(255);
  __m512i surface = _mm512_setzero_si512(), free = surface;
  const auto size = static_cast<int>(samples_.cols());
  for (int s = 0; s < size; s += lanes) {
    const auto there = static_cast<__mmask16>((1u << std::min(lanes, size - s)) - 1u);
    const auto at = [&](const std::uint32_t* places) __attribute__((target("avx512f"), always_inline)) {
      const __m512i place = _mm512_maskz_loadu_epi32(there, places + s);
      return _mm512_mask_i32gather_epi32(_mm512_setzero_si512(), there, place, cells_.data(), sizeof(Cell));
    };
    const auto freeOf = [&](__m512i cell) __attribute__((target("avx512f"), always_inline)) {
      return _mm512_and_epi32(_mm512_srli_epi32(cell, 8), byte);
    };
    const __m512i a = at(images);
    __m512i f = _mm512_and_epi32(a, byte), seen = freeOf(a);
    if (completed) {
      const __m512i b = at(completed);
      f = _mm512_max_epi32(f, _mm512_and_epi32(b, byte));
      seen = _mm512_min_epi32(_mm512_max_epi32(seen, freeOf(b)), _mm512_sub_epi32(byte, f));
    }
    surface = _mm512_mask_add_epi32(surface, there, surface, f);
    free = _mm512_mask_add_epi32(free, there, free, seen);
  }
  return {_mm512_reduce_add_epi32(surface), _mm512_reduce_add_epi32(free)};
}

#endif

PlaneProfiles::Sums PlaneProfiles::sumsAt(const std::uint32_t* images, const std::uint32_t* completed) const {
#if defined(__x86_64__)
  static const bool has_avx512 = __builtin_cpu_supports("avx512f");
  if (has_avx512) return sumsAvx512(images, completed);
#endif
  Sums sums;
  for (Eigen::Index s = 0; s < samples_.cols(); ++s) {
    const Cell a = cells_[images[s]];
    if (!completed) {
      sums.surface += a.surface;
      sums.free += a.free;
      continue;
    }
    const Cell b = cells_[completed[s]];
    const int f = std::max(a.surface, b.surface);
    sums.surface += f;
    sums.free += std::min<int>(std::max(a.free, b.free), 255 - f);
  }
  return sums;
}

/// The image of a sample moves by twice the step of the offset along the normal: each profile is a walk through the
/// grid along one straight line per sample.
std::vector<float> PlaneProfiles::scores(const Eigen::Vector3f& normal, float first, float step, int count,
                                         const CellPlane* completed_across) const {
  const auto num_samples = static_cast<std::size_t>(samples_.cols());
  Walk images(num_samples), completed(completed_across ? num_samples : 0);
  int own = 0;
  const float to_index = middle_ + 0.5f;
  for (std::size_t s = 0; s < num_samples; ++s) {
    const Eigen::Vector3f x = samples_.col(static_cast<Eigen::Index>(s));
    const float shift = 2.0f * (first - normal.dot(x));
    images.start(s, (x + shift * normal).array() + to_index);
    const Eigen::Vector3f here = x.array() + to_index;
    int surface = at(here[0], here[1], here[2]).surface;
    if (completed_across) {
      const Eigen::Vector3f y =
          x - 2.0f * (completed_across->normal.dot(x) - completed_across->offset) * completed_across->normal;
      completed.start(s, (y + shift * normal).array() + to_index);
      const Eigen::Vector3f there = y.array() + to_index;
      surface = std::max<int>(surface, at(there[0], there[1], there[2]).surface);
    }
    own += surface;
  }
  // A plane that maps every sample onto the surface scores 1.
  std::vector<float> result(count);
  const double scale = 1.0 / std::max(own, 1);
  const Eigen::Vector3f move = 2.0f * step * normal;
  for (int k = 0; k < count; ++k) {
    const std::uint32_t* const at_images = images.cellsThenMove(move, size_);
    const Sums sums = sumsAt(at_images, completed_across ? completed.cellsThenMove(move, size_) : nullptr);
    result[k] =
        static_cast<float>(scanned_ ? seenSymmetry(scale * sums.surface, scale * sums.free) : scale * sums.surface);
  }
  return result;
}

}  // namespace pcl_symmetry
