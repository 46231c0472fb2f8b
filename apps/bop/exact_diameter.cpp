#include "bop/exact_diameter.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/geometry/cloud_extent.h"

namespace pcl_symmetry::apps {

namespace {

/// A binary tree that halves the points at each node, with a box around the points of each node.
class HalvingTree {
public:
  explicit HalvingTree(const PointsRef& points) {
    for (Eigen::Index i = 0; i < points.cols(); ++i) points_.push_back(points.col(i).cast<double>());
    nodes_.push_back(around(0, static_cast<int>(points_.size())));
  }

  /// \param at_least a squared distance between two of the points: pairs that do not exceed it are skipped.
  double greatestSqDistance(double at_least) {
    double best = at_least;
    search(0, 0, best);
    return best;
  }

private:
  struct Node {
    Eigen::AlignedBox3d box;
    int begin = 0, end = 0;  // range of its points
    std::size_t child = 0;   // index of the first of two successive children; 0 before the node is split

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

double exactDiameter(const PointsRef& points) {
  if (points.cols() < 2) return 0.0;
  // Usually close to the diameter; slightly less, because it is rounded.
  const double at_least = 0.9999 * approximateDiameter(points);
  return std::sqrt(HalvingTree(points).greatestSqDistance(at_least * at_least));
}

}  // namespace pcl_symmetry::apps
