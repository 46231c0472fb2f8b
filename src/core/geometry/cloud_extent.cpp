#include "core/geometry/cloud_extent.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/base/symmetric_solvers.h"
#include "core/geometry/geometry_rules.h"

namespace pcl_symmetry {

PrincipalAxes principalAxes(const PointsRef& points) {
  if (points.cols() == 0) throw std::invalid_argument("points: 0 given, must be >= 1");
  PrincipalAxes axes;
  axes.center = centerOfMass(points);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d d = points.col(i).cast<double>() - axes.center;
    covariance += d * d.transpose();
  }
  covariance /= static_cast<double>(points.cols());
  const SymmetricEigen<Eigen::Matrix3d> solver(covariance);
  axes.axes = solver.eigenvectors().rowwise().reverse();
  axes.variances = solver.eigenvalues().reverse().cwiseMax(0.0);
  if (axes.axes.determinant() < 0.0) axes.axes.col(2) *= -1.0;
  return axes;
}

std::vector<ReflectionPlane> principalPlanes(const PrincipalAxes& axes) {
  std::vector<ReflectionPlane> planes;
  for (int i = 0; i < 3; ++i) planes.emplace_back(axes.axes.col(i), axes.axes.col(i).dot(axes.center));
  return planes;
}

Thinness thinnessOf(const PointsRef& points, const PrincipalAxes& axes, double plane_tolerance, double line_tolerance) {
  Eigen::Index num_near_plane = 0, num_near_line = 0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d x = axes.axes.transpose() * (points.col(i).cast<double>() - axes.center);
    num_near_plane += std::abs(x.z()) <= plane_tolerance ? 1 : 0;
    num_near_line += x.tail<2>().norm() <= line_tolerance ? 1 : 0;
  }
  const double least = kSymmetricShare * static_cast<double>(points.cols());
  if (static_cast<double>(num_near_line) >= least) return Thinness::Line;
  return static_cast<double>(num_near_plane) >= least ? Thinness::Sheet : Thinness::Solid;
}

namespace {

/// Index and squared distance of the point farthest from a position.
std::pair<Eigen::Index, float> farthestOf(const Eigen::Vector3f& position, const PointsRef& points) {
  Eigen::Index index = 0;
  const auto squares = (points.colwise() - position).array().square();
  const float sq_distance = (squares.row(0) + squares.row(1) + squares.row(2)).maxCoeff(&index);
  return {index, sq_distance};
}

/// A binary tree that halves the points at each node, with a box around those of each node.
class HalvingTree {
public:
  explicit HalvingTree(const PointsRef& points) {
    for (Eigen::Index i = 0; i < points.cols(); ++i) points_.push_back(points.col(i).cast<double>());
    nodes_.push_back(around(0, static_cast<int>(points_.size())));
  }

  /// \param at_least a squared distance between two of the points: what is not above it is not looked at.
  double greatestSqDistance(double at_least) {
    double best = at_least;
    search(0, 0, best);
    return best;
  }

private:
  struct Node {
    Eigen::AlignedBox3d box;
    int begin = 0, end = 0;  // range of its points
    std::size_t child = 0;   // the first of two, side by side; 0 before it is split

    int size() const { return end - begin; }
    bool isLeaf() const { return size() <= 8; }
  };

  Node around(int begin, int end) const {
    Node node{{}, begin, end};
    for (int i = begin; i < end; ++i) node.box.extend(points_[i]);
    return node;
  }

  /// Gives a node its children, which few nodes need.
  void split(std::size_t index) {
    if (nodes_[index].child > 0) return;
    const int begin = nodes_[index].begin, end = nodes_[index].end, middle = begin + (end - begin) / 2;
    int axis = 0;
    nodes_[index].box.sizes().maxCoeff(&axis);
    std::nth_element(points_.begin() + begin, points_.begin() + middle, points_.begin() + end,
                     [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a[axis] < b[axis]; });
    nodes_[index].child = nodes_.size();
    nodes_.push_back(around(begin, middle));
    nodes_.push_back(around(middle, end));
  }

  /// Raises \p best to the greatest squared distance between a point of node \p a and one of node \p b.
  void search(std::size_t a, std::size_t b, double& best) {
    if (sqBound(nodes_[a].box, nodes_[b].box) <= best) return;
    if (nodes_[a].isLeaf() && nodes_[b].isLeaf()) {
      for (int i = nodes_[a].begin; i < nodes_[a].end; ++i)
        for (int j = nodes_[b].begin; j < nodes_[b].end; ++j)
          best = std::max(best, (points_[j] - points_[i]).squaredNorm());
      return;
    }
    const bool splits_b = nodes_[b].size() > nodes_[a].size();
    const std::size_t halved = splits_b ? b : a, other = splits_b ? a : b;
    split(halved);
    const std::size_t left = nodes_[halved].child, right = left + 1;
    if (a == b) {
      search(left, right, best);
      search(left, left, best);
      search(right, right, best);
    } else {
      search(left, other, best);
      search(right, other, best);
    }
  }

  /// Upper bound of the squared distance between points of two boxes.
  static double sqBound(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) {
    return (a.max() - b.min()).cwiseAbs().cwiseMax((b.max() - a.min()).cwiseAbs()).squaredNorm();
  }

  std::vector<Eigen::Vector3d> points_;
  std::vector<Node> nodes_;
};

}  // namespace

double diameter(const PointsRef& points) {
  if (points.cols() < 2) return 0.0;
  // From a point to the farthest one, and on from there: mostly close to the diameter.
  double hops = 0.0;
  Eigen::Index at = 0;
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector3f from = points.col(at);
    at = farthestOf(from, points).first;
    hops = std::max(hops, (points.col(at).cast<double>() - from.cast<double>()).squaredNorm());
  }
  return std::sqrt(HalvingTree(points).greatestSqDistance(hops));
}

double farthestPair(const PointsRef& points) {
  if (points.cols() < 2) return 0.0;
  Eigen::Index at = farthestOf(centerOfMass(points).cast<float>(), points).first;
  double distance = -1.0;
  for (double longer = 0.0; longer > distance;) {
    distance = longer;
    const auto [farthest, sq_distance] = farthestOf(points.col(at), points);
    at = farthest;
    longer = std::sqrt(static_cast<double>(sq_distance));
  }
  return distance;
}

}  // namespace pcl_symmetry
