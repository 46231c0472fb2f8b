#include "evaluate/frames/frame_difference.h"
#include "core/base/constants.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace pcl_symmetry::apps {

namespace {

/// Turning b about its column k maximises the trace of a^T b in closed form.
double angleBetween(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b, int revolution) {
  const Eigen::Matrix3d turn = b.transpose() * a;
  double trace = turn.trace();
  if (revolution >= 0) {
    const int i = (revolution + 1) % 3, j = (revolution + 2) % 3;
    trace = turn(revolution, revolution) + std::hypot(turn(i, i) + turn(j, j), turn(i, j) - turn(j, i));
  }
  return std::acos(std::clamp(0.5 * (trace - 1.0), -1.0, 1.0)) * 180.0 / kPi;
}

}  // namespace

double angleOfAxes(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b, int revolution) {
  if (revolution == 3) return 0.0;
  // derived: the permutations of three axes.
  constexpr int kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  double smallest = 180.0;
  for (const auto& order : kOrders) {
    const int column = static_cast<int>(std::find(order, order + 3, revolution) - order);
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d turned;
      for (int k = 0; k < 3; ++k) turned.col(k) = (signs >> k & 1 ? -1.0 : 1.0) * b.col(order[k]);
      if (turned.determinant() > 0.0)
        smallest = std::min(smallest, angleBetween(a, turned, revolution < 0 ? -1 : column));
    }
  }
  return smallest;
}

double angleToNearest(const Eigen::Matrix3d& frame, const std::vector<Eigen::Matrix3d>& frames, int revolution) {
  if (revolution == 3) return 0.0;
  double smallest = 180.0;
  for (const Eigen::Matrix3d& other : frames) smallest = std::min(smallest, angleBetween(frame, other, revolution));
  return smallest;
}

}  // namespace pcl_symmetry::apps
