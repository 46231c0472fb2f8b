#include "surface_directions.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace pcl_symmetry {

namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr int kFewestPoints = 6;         // in the neighbourhood of a cell
const float kWidth = 6.0f * kDegree;     // of agreement, where it falls to 0
const float kPeakWidth = 5.0 * kDegree;  // of normals that make one peak
constexpr int kPeakStarts = 150, kPeakSteps = 5;
const double kPeakDistance = 15.0 * kDegree;
constexpr double kLeastPeak = 0.03;  // of the surface

struct Moments {
  float count = 0.0f;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();

  void operator+=(const Moments& other) {
    count += other.count;
    sum += other.sum;
    squares += other.squares;
  }
};

}  // namespace

SurfaceDirections::SurfaceDirections(const PointsRef& points, const GaussianEdt& edt) {
  const int n = (edt.numCells() + 1) / 2 + 2;  // a border of one cell
  const double cell_size = 2.0 * edt.cellSize();
  std::vector<Moments> cells(static_cast<std::size_t>(n) * n * n);
  std::vector<int> occupied;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d x = (points.col(i).cast<double>() - edt.origin()) / cell_size;
    const Eigen::Array3i at = (x.array() + 1.25).cast<int>().max(1).min(n - 2);
    const int index = (at.z() * n + at.y()) * n + at.x();
    const Eigen::Vector3f p = (x - Eigen::Vector3d::Constant(0.25 * n)).cast<float>();
    Moments& cell = cells[index];
    if (cell.count == 0.0f) occupied.push_back(index);
    cell.count += 1.0f;
    cell.sum += p;
    cell.squares += p * p.transpose();
  }
  normals_.resize(3, static_cast<Eigen::Index>(occupied.size()));
  weights_.setZero(normals_.cols());
  for (std::size_t c = 0; c < occupied.size(); ++c) {
    Moments near;
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) near += cells[occupied[c] + (z * n + y) * n + x];
    const auto column = static_cast<Eigen::Index>(c);
    normals_.col(column).setUnit(2);
    if (near.count < kFewestPoints) continue;
    const Eigen::Matrix3f covariance = near.squares - near.sum * near.sum.transpose() / near.count;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
    solver.computeDirect(covariance);
    const Eigen::Vector3f values = solver.eigenvalues();
    if (!(values[2] > 0.0f) || !solver.eigenvectors().allFinite()) continue;
    normals_.col(column) = solver.eigenvectors().col(0).normalized();
    weights_[column] = std::max(0.0f, (values[1] - values[0]) / values[2]);
  }
  const float total = weights_.sum();
  if (total > 0.0f) weights_ /= total;
}

double SurfaceDirections::agreement(const Eigen::Vector3f& axis) const {
  const float inverse = 1.0f / (kWidth * kWidth);
  const Eigen::ArrayXf cosines = (normals_.transpose() * axis).array().abs();
  const Eigen::ArrayXf across = (1.0f - inverse * cosines.square()).max(0.0f);
  const Eigen::ArrayXf along = (1.0f - 2.0f * inverse * (1.0f - cosines)).max(0.0f);
  return (weights_.array() * (across + along)).sum();
}

std::vector<Eigen::Vector3f> SurfaceDirections::peaks(int max_peaks) const {
  struct Peak {
    Eigen::Vector3f direction;
    double share;
  };
  std::vector<Peak> found;
  const Eigen::Index stride = std::max<Eigen::Index>(1, normals_.cols() / kPeakStarts);
  const float least = std::cos(kPeakWidth);
  for (Eigen::Index start = 0; start < normals_.cols(); start += stride) {
    Eigen::Vector3f direction = normals_.col(start);
    double share = 0.0;
    for (int step = 0; step < kPeakSteps; ++step) {
      const Eigen::ArrayXf cosines = (normals_.transpose() * direction).array();
      const Eigen::ArrayXf weights =
          (cosines.abs() >= least).select(weights_.array(), Eigen::ArrayXf::Zero(cosines.size()));
      share = weights.sum();
      if (share < kLeastPeak) break;
      direction = (normals_ * (weights * cosines.sign()).matrix()).normalized();
    }
    if (share >= kLeastPeak) found.push_back({direction, share});
  }
  std::stable_sort(found.begin(), found.end(), [](const Peak& a, const Peak& b) { return a.share > b.share; });
  std::vector<Eigen::Vector3f> peaks;
  const float same = static_cast<float>(std::cos(kPeakDistance));
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
