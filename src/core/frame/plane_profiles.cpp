#include "core/frame/plane_profiles.h"

#include <algorithm>
#include <numeric>

#include "core/base/simd.h"
#include "core/transform/sampled_transform.h"

namespace pcl_symmetry {

PlaneProfiles::PlaneProfiles(const GaussianEdt& edt, const std::vector<float>& free_space, int num_samples,
                             std::uint64_t seed, int num_threads)
    : size_(static_cast<std::uint32_t>(edt.numCells())),
      middle_(static_cast<float>(middleCell(edt))),
      scanned_(!free_space.empty()),
      outside_(scanned_ ? 255u << 8 : 0u),
      cells_(edt.values().size()),
      samples_(drawPoints(edt, num_samples, seed, num_threads).transpose().array() - middle_) {
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const auto surface = static_cast<std::uint32_t>(255.0f * edt.values()[i] + 0.5f);
    const auto free = free_space.empty() ? 0 : static_cast<std::uint32_t>(255.0f * free_space[i] + 0.5f);
    cells_[i] = free << 8 | surface;
  }
  cells_.push_back(outside_);
  for (Eigen::Index s = 0; s < samples_.rows(); ++s) own_.push_back(surfaceAt(samples_, s));
}

namespace {

/// Finds the cell of each image (size^3 outside the grid), then moves the images.
/// \param positions in cells from the corner of the grid.
PCL_SYMMETRY_MULTIVERSION
void advance(float* positions, std::size_t count, const float* move, std::uint32_t size, std::uint32_t* cells) {
  float *const x = positions, *const y = x + count, *const z = y + count;
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

}  // namespace

/// Sums over the images of the samples.
/// \param images cells of the images.
/// \param completed cells of the images reflected in the plane that completes a scan; null = there is none.
PCL_SYMMETRY_MULTIVERSION
PlaneProfiles::Sums PlaneProfiles::sumsOf(const std::uint32_t* __restrict cells, const std::uint32_t* __restrict images,
                                          const std::uint32_t* __restrict completed, int count) {
  int surface = 0, free = 0;
  if (!completed) {
    for (int s = 0; s < count; ++s) {
      surface += surfaceOf(cells[images[s]]);
      free += freeOf(cells[images[s]]);
    }
    return {surface, free};
  }
  for (int s = 0; s < count; ++s) {
    const std::uint32_t a = cells[images[s]], b = cells[completed[s]];
    const int there = std::max(surfaceOf(a), surfaceOf(b));
    surface += there;
    free += std::min(std::max(freeOf(a), freeOf(b)), 255 - there);
  }
  return {surface, free};
}

/// The image of a sample moves by twice the step of the offset along the normal: each profile is a walk through the
/// grid along one straight line per sample.
std::vector<float> PlaneProfiles::scores(const Eigen::Vector3f& normal, float first, float step, int count,
                                         const CellPlane* completed_across) const {
  const Eigen::Index num_samples = samples_.rows();
  std::vector<std::uint32_t> image_cells(num_samples), completed_cells(completed_across ? num_samples : 0);
  const auto heights = [&](const Eigen::Vector3f& n) -> Eigen::ArrayXf {
    return n[0] * samples_.col(0) + (n[1] * samples_.col(1) + n[2] * samples_.col(2));
  };
  const auto moved = [&](const Eigen::ArrayX3f& from, const Eigen::ArrayXf& way, const Eigen::Vector3f& n) {
    Eigen::ArrayX3f to(num_samples, 3);
    for (int axis = 0; axis < 3; ++axis) to.col(axis) = from.col(axis) + way * n[axis];
    return to;
  };
  const Eigen::ArrayXf shift = 2.0f * (first - heights(normal));
  Eigen::ArrayX3f images = moved(samples_, shift, normal) + (middle_ + 0.5f), completed;
  int own = std::accumulate(own_.begin(), own_.end(), 0);
  if (completed_across) {
    const Eigen::Vector3f& n = completed_across->normal;
    const Eigen::ArrayX3f other = moved(samples_, 2.0f * (completed_across->offset - heights(n)), n);
    completed = moved(other, shift, normal) + (middle_ + 0.5f);
    own = 0;
    for (Eigen::Index s = 0; s < num_samples; ++s) own += std::max(own_[s], surfaceAt(other, s));
  }
  // A plane that maps every sample onto the surface scores 1.
  std::vector<float> result(count);
  const double scale = 1.0 / std::max(own, 1);
  const Eigen::Vector3f move = 2.0f * step * normal;
  for (int k = 0; k < count; ++k) {
    advance(images.data(), image_cells.size(), move.data(), size_, image_cells.data());
    advance(completed.data(), completed_cells.size(), move.data(), size_, completed_cells.data());
    const Sums sums = sumsOf(cells_.data(), image_cells.data(), completed_across ? completed_cells.data() : nullptr,
                             static_cast<int>(num_samples));
    result[k] =
        static_cast<float>(scanned_ ? seenSymmetry(scale * sums.surface, scale * sums.free) : scale * sums.surface);
  }
  return result;
}

}  // namespace pcl_symmetry
