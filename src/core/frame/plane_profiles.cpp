#include "core/frame/plane_profiles.h"

#include <algorithm>

#include "core/distance_transform/edt_samples.h"
#include "core/distance_transform/free_space.h"
#include "pcl_symmetry/core/scan/visibility.h"

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
}

/// The image of a sample moves by twice the step of the offset along the normal: each profile is a walk through the
/// grid along one straight line per sample.
std::vector<float> PlaneProfiles::scores(const Eigen::Vector3f& normal, float first, float step, int count,
                                         const CellPlane* completed_across) const {
  std::vector<int> surface(count, 0), free(count, 0);
  int own = 0;
  const Eigen::Vector3f move = 2.0f * step * normal;
  const float to_index = middle_ + 0.5f;
  for (Eigen::Index s = 0; s < samples_.cols(); ++s) {
    const Eigen::Vector3f x = samples_.col(s);
    const float shift = 2.0f * (first - normal.dot(x));
    Eigen::Vector3f p = (x + shift * normal).array() + to_index;
    const Eigen::Vector3f here = x.array() + to_index;
    if (completed_across) {
      const Eigen::Vector3f y =
          x - 2.0f * (completed_across->normal.dot(x) - completed_across->offset) * completed_across->normal;
      Eigen::Vector3f q = (y + shift * normal).array() + to_index;
      const Eigen::Vector3f there = y.array() + to_index;
      own += std::max(at(here[0], here[1], here[2]).surface, at(there[0], there[1], there[2]).surface);
      for (int k = 0; k < count; ++k, p += move, q += move) {
        const Cell a = at(p[0], p[1], p[2]), b = at(q[0], q[1], q[2]);
        const int f = std::max(a.surface, b.surface);
        surface[k] += f;
        free[k] += std::min<int>(std::max(a.free, b.free), 255 - f);
      }
    } else {
      own += at(here[0], here[1], here[2]).surface;
      for (int k = 0; k < count; ++k, p += move) {
        const Cell a = at(p[0], p[1], p[2]);
        surface[k] += a.surface;
        free[k] += a.free;
      }
    }
  }
  // A plane that maps every sample onto the surface scores 1.
  std::vector<float> result(count);
  const double scale = 1.0 / std::max(own, 1);
  for (int k = 0; k < count; ++k)
    result[k] = static_cast<float>(scanned_ ? seenSymmetry(scale * surface[k], scale * free[k]) : scale * surface[k]);
  return result;
}

}  // namespace pcl_symmetry
