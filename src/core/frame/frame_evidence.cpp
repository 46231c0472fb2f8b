#include "core/frame/frame_evidence.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/lists.h"
#include "core/base/statistics.h"
#include "core/geometry/directions.h"
#include "core/geometry/surface_normals.h"
#include "core/transform/sampled_transform.h"

namespace pcl_symmetry {

namespace {

/// The width of the distance transform: as narrow as the grid and the spacing of the points allow, unless it is given.
GaussianEdtOptions edtOptions(const PointsRef& points, GaussianEdtOptions options, bool scanned) {
  if (options.sigma > 0.0 || points.cols() == 0) return options;
  const double radius = boundingBall(points).radius;
  const double cell = 2.2 * radius / options.num_cells;  // the side of the grid is 2 (1 + 2 sigma) radii
  // Point spacing if the points covered a sphere, or a hemisphere for a scan.
  const double spacing = radius * std::sqrt((scanned ? 2.0 : 4.0) * kPi / static_cast<double>(points.cols()));
  options.sigma = std::max((scanned ? kFrame.scan_sigma : kFrame.whole_sigma) * cell, kFrame.min_sigma * spacing);
  return options;
}

}  // namespace

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
  const float min_cosine = std::cos(static_cast<float>(kFrame.peak_width));
  for (Eigen::Index start = 0; start < normals_.cols(); start += stride) {
    Eigen::Vector3f direction = normals_.col(start);
    double share = 0.0;
    for (int step = 0; step < kFrame.num_peak_steps; ++step) {
      const Eigen::ArrayXf cosines = (normals_.transpose() * direction).array();
      const Eigen::ArrayXf weights =
          (cosines.abs() >= min_cosine).select(weights_.array(), Eigen::ArrayXf::Zero(cosines.size()));
      share = weights.sum();
      if (share < kFrame.min_peak) break;
      direction = (normals_ * (weights * cosines.sign()).matrix()).normalized();
    }
    if (share >= kFrame.min_peak) found.push_back({direction, share});
  }
  sortDescending(found, &Peak::share);
  std::vector<Eigen::Vector3f> peaks;
  const float same = static_cast<float>(std::cos(kFrame.peak_distance));
  for (const Peak& peak : found) {
    if (static_cast<int>(peaks.size()) >= max_peaks) break;
    if (!isNearAny(peaks, peak.direction, same)) peaks.push_back(peak.direction);
  }
  return peaks;
}

FrameEvidence::FrameEvidence(const PointsRef& cloud, const FrameOptions& options, const Visibility* visibility)
    : points(cloud),
      scanned(visibility != nullptr),
      weight(scanned ? kFrame.scan_weight : kFrame.whole_weight),
      edt(points, edtOptions(points, options.edtOptions(), scanned)),
      free_space(freeSpace(edt, visibility, options.num_threads)),
      profiles(edt, free_space, kFrame.num_profile_samples, options.seed, options.num_threads),
      directions(points, edt),
      center_samples(
          drawPoints(edt, scanned ? 0 : kFrame.num_center_samples, options.seed, options.num_threads).cast<double>()),
      middle(middleOf(edt)),
      reach(static_cast<float>(edt.radius() / edt.cellSize())),
      principal_axes(principalAxes(points)),
      center_of_mass(toCells(principal_axes.center)),
      push(visibility ? Eigen::Vector3f(static_cast<float>(kFrame.push) * reach *
                                        (principal_axes.center - visibility->viewpoint()).normalized().cast<float>())
                      : Eigen::Vector3f::Zero()) {}

CellPlane FrameEvidence::toCells(const ReflectionPlane& plane) const {
  return {plane.normal().cast<float>(), static_cast<float>(-plane.signedDistance(middle) / edt.cellSize())};
}

std::vector<float> FrameEvidence::profile(const Eigen::Vector3f& normal, const CellPlane* completed_across) const {
  const int half = static_cast<int>(reach);
  return profiles.scores(normal, static_cast<float>(-half), 1.0f, 2 * half + 1, completed_across);
}

ScoredOffset FrameEvidence::bestOffset(const Eigen::Vector3f& normal, const CellPlane* completed_across) const {
  const std::vector<float> s = profile(normal, completed_across);
  const auto at = std::max_element(s.begin(), s.end()) - s.begin();
  return {static_cast<float>(at - static_cast<int>(reach)), s[at]};
}

ScoredOffset FrameEvidence::nearbyOffset(const Eigen::Vector3f& normal, float offset,
                                         const CellPlane* completed_across) const {
  // The longest step of the search, 3 degrees, moves a plane by 1.5 cells at the rim of the grid.
  const int side = 3;
  const float step = 0.5f;
  const std::vector<float> s = profiles.scores(normal, offset - side * step, step, 2 * side + 1, completed_across);
  const auto at = std::max_element(s.begin(), s.end()) - s.begin();
  return {offset + (static_cast<float>(at) - side) * step, s[at]};
}

double FrameEvidence::spreadAlong(const Eigen::Vector3f& axis) const {
  return (principal_axes.axes.transpose() * axis.cast<double>()).cwiseAbs2().dot(principal_axes.variances);
}

double FrameEvidence::middleAlong(const Eigen::Vector3f& axis) const {
  std::vector<float> t(points.cols());
  for (std::size_t i = 0; i < t.size(); ++i) t[i] = axis.dot(toCells(points.col(i).cast<double>()));
  const auto tail = static_cast<std::size_t>(kFrame.tail * static_cast<double>(t.size() - 1));
  const auto [low, high] = trimmedExtent(std::move(t), tail);
  return 0.5 * (low + high) + axis.dot(push);
}

}  // namespace pcl_symmetry
