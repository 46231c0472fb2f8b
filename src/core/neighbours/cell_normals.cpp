#include "core/neighbours/cell_normals.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace pcl_symmetry {

namespace {

constexpr int kFewestPoints = 6;  // in the neighbourhood of a cell

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

CellNormals cellNormals(const PointsRef& points, const Eigen::Vector3d& origin, double cell_size, int num_cells) {
  const int n = num_cells + 2;  // a border of one cell
  std::vector<int> slot_of_cells(static_cast<std::size_t>(n) * n * n, -1);
  std::vector<Moments> moments;
  std::vector<int> occupied;
  CellNormals result;
  result.cell_of_points.resize(static_cast<std::size_t>(points.cols()));
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d x = (points.col(i).cast<double>() - origin) / cell_size;
    const Eigen::Array3i at = (x.array() + 1.0).cast<int>().max(1).min(n - 2);
    const int index = (at.z() * n + at.y()) * n + at.x();
    const Eigen::Vector3f p = (x - Eigen::Vector3d::Constant(0.5 * num_cells)).cast<float>();
    int& slot = slot_of_cells[static_cast<std::size_t>(index)];
    if (slot < 0) {
      slot = static_cast<int>(occupied.size());
      occupied.push_back(index);
      moments.emplace_back();
    }
    Moments& cell = moments[static_cast<std::size_t>(slot)];
    cell.count += 1.0f;
    cell.sum += p;
    cell.squares += p * p.transpose();
    result.cell_of_points[static_cast<std::size_t>(i)] = slot;
  }
  result.normals.resize(3, static_cast<Eigen::Index>(occupied.size()));
  result.flatness.setZero(result.normals.cols());
  for (std::size_t c = 0; c < occupied.size(); ++c) {
    Moments near;
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
          const int slot = slot_of_cells[static_cast<std::size_t>(occupied[c] + (z * n + y) * n + x)];
          if (slot >= 0) near += moments[static_cast<std::size_t>(slot)];
        }
    const auto column = static_cast<Eigen::Index>(c);
    result.normals.col(column).setUnit(2);
    if (near.count < kFewestPoints) continue;
    const Eigen::Matrix3f covariance = near.squares - near.sum * near.sum.transpose() / near.count;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
    solver.computeDirect(covariance);
    const Eigen::Vector3f values = solver.eigenvalues();
    if (!(values[2] > 0.0f) || !solver.eigenvectors().allFinite()) continue;
    result.normals.col(column) = solver.eigenvectors().col(0).normalized();
    result.flatness[column] = std::max(0.0f, (values[1] - values[0]) / values[2]);
  }
  return result;
}

}  // namespace pcl_symmetry
