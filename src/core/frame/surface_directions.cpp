#include "core/frame/surface_directions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/frame/frame_evidence.h"
#include "core/geometry/cell_normals.h"

namespace pcl_symmetry {

SurfaceDirections::SurfaceDirections(const PointsRef& points, const GaussianEdt& edt) {
  const Eigen::Vector3d corner = edt.origin() - Eigen::Vector3d::Constant(0.5 * edt.cellSize());
  CellNormals cells = cellNormals(points, corner, 2.0 * edt.cellSize(), (edt.numCells() + 1) / 2);
  normals_ = std::move(cells.normals);
  by_axis_ = normals_.transpose();
  weights_ = std::move(cells.flatness);
  const float total = weights_.sum();
  if (total > 0.0f) weights_ /= total;
}

double SurfaceDirections::agreement(const Eigen::Vector3f& axis) const {
  const auto width = static_cast<float>(kFrame.face_width);
  const float inverse = 1.0f / (width * width);
  const Eigen::ArrayXf cosines =
      (axis[0] * by_axis_.col(0) + (axis[1] * by_axis_.col(1) + axis[2] * by_axis_.col(2))).abs();
  const auto across = (1.0f - inverse * cosines.square()).max(0.0f);
  const auto along = (1.0f - 2.0f * inverse * (1.0f - cosines)).max(0.0f);
  return (weights_.array() * (across + along)).sum();
}

std::vector<Eigen::Vector3f> SurfaceDirections::peaks(int max_peaks) const {
  struct Peak {
    Eigen::Vector3f direction;
    double share;
  };
  std::vector<Peak> found;
  const Eigen::Index stride = std::max<Eigen::Index>(1, normals_.cols() / kFrame.num_peak_starts);
  const float least = std::cos(static_cast<float>(kFrame.peak_width));
  for (Eigen::Index start = 0; start < normals_.cols(); start += stride) {
    Eigen::Vector3f direction = normals_.col(start);
    double share = 0.0;
    for (int step = 0; step < kFrame.num_peak_steps; ++step) {
      const Eigen::ArrayXf cosines = (normals_.transpose() * direction).array();
      const Eigen::ArrayXf weights =
          (cosines.abs() >= least).select(weights_.array(), Eigen::ArrayXf::Zero(cosines.size()));
      share = weights.sum();
      if (share < kFrame.min_peak) break;
      direction = (normals_ * (weights * cosines.sign()).matrix()).normalized();
    }
    if (share >= kFrame.min_peak) found.push_back({direction, share});
  }
  std::stable_sort(found.begin(), found.end(), [](const Peak& a, const Peak& b) { return a.share > b.share; });
  std::vector<Eigen::Vector3f> peaks;
  const float same = static_cast<float>(std::cos(kFrame.peak_distance));
  for (const Peak& peak : found) {
    if (static_cast<int>(peaks.size()) >= max_peaks) break;
    const bool known = std::any_of(peaks.begin(), peaks.end(), [&](const Eigen::Vector3f& other) {
      return std::abs(other.dot(peak.direction)) > same;
    });
    if (!known) peaks.push_back(peak.direction);
  }
  return peaks;
}

}  // namespace pcl_symmetry
