#include "core/frame/plane_profiles.h"

#include <algorithm>

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
}

/// The image of a sample moves by twice the step of the offset along the normal: each profile is a walk through the
/// grid along one straight line per sample.
std::vector<float> PlaneProfiles::scores(const Eigen::Vector3f& normal, float first, float step, int count,
                                         const CellPlane* completed_across) const {
  const float to_index = middle_ + 0.5f;
  Eigen::Matrix3Xf images(3, samples_.cols()), completed(3, completed_across ? samples_.cols() : 0);
  int own = 0;
  for (Eigen::Index s = 0; s < samples_.cols(); ++s) {
    const Eigen::Vector3f x = samples_.col(s);
    const float shift = 2.0f * (first - normal.dot(x));
    images.col(s) = (x + shift * normal).array() + to_index;
    int surface = at(x.array() + to_index).surface;
    if (completed_across) {
      const Eigen::Vector3f y =
          x - 2.0f * (completed_across->normal.dot(x) - completed_across->offset) * completed_across->normal;
      completed.col(s) = (y + shift * normal).array() + to_index;
      surface = std::max<int>(surface, at(y.array() + to_index).surface);
    }
    own += surface;
  }
  // A plane that maps every sample onto the surface scores 1.
  std::vector<float> result(count);
  const double scale = 1.0 / std::max(own, 1);
  const Eigen::Vector3f move = 2.0f * step * normal;
  for (float& score : result) {
    int surface = 0, free = 0;
    for (Eigen::Index s = 0; s < images.cols(); ++s) {
      const Cell a = at(images.col(s));
      int f = a.surface, seen = a.free;
      if (completed_across) {
        const Cell b = at(completed.col(s));
        f = std::max(a.surface, b.surface);
        seen = std::min<int>(std::max(a.free, b.free), 255 - f);
      }
      surface += f;
      free += seen;
    }
    images.colwise() += move;
    completed.colwise() += move;
    score = static_cast<float>(scanned_ ? seenSymmetry(scale * surface, scale * free) : scale * surface);
  }
  return result;
}

}  // namespace pcl_symmetry
