#include "pcl_symmetry/core/diameter.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <vector>

namespace pcl_symmetry {

namespace {

constexpr int kLeafSize = 16;

/// Boxes around halves of halves of the points.
class BoxTree {
public:
  explicit BoxTree(const PointsRef& points) : points_(points), order_(static_cast<std::size_t>(points.cols())) {
    std::iota(order_.begin(), order_.end(), 0);
    build(0, static_cast<int>(order_.size()));
  }

  /// \return squared.
  double greatestDistance() const {
    double best = 0.0;
    std::priority_queue<Pair> open;
    const auto consider = [&](int a, int b) {
      const double bound = sqBound(nodes_[a], nodes_[b]);
      if (bound > best) open.push({bound, a, b});
    };
    consider(0, 0);
    while (!open.empty() && open.top().bound > best) {
      const Pair pair = open.top();
      open.pop();
      const Node &a = nodes_[pair.a], &b = nodes_[pair.b];
      if (a.right < 0 && b.right < 0) {
        best = std::max(best, greatestDistance(a, b));
      } else if (pair.a == pair.b) {
        consider(pair.a + 1, pair.a + 1);
        consider(pair.a + 1, a.right);
        consider(a.right, a.right);
      } else if (b.right < 0 || (a.right >= 0 && a.end - a.begin >= b.end - b.begin)) {
        consider(pair.a + 1, pair.b);
        consider(a.right, pair.b);
      } else {
        consider(pair.a, pair.b + 1);
        consider(pair.a, b.right);
      }
    }
    return best;
  }

private:
  struct Node {
    Eigen::AlignedBox3f box;
    int begin, end;  // of order_
    int right;       // the left child is the next node; -1: a leaf
  };
  struct Pair {
    double bound;
    int a, b;
    bool operator<(const Pair& other) const { return bound < other.bound; }
  };

  int build(int begin, int end) {
    const int index = static_cast<int>(nodes_.size());
    Node node{Eigen::AlignedBox3f(), begin, end, -1};
    for (int i = begin; i < end; ++i) node.box.extend(Eigen::Vector3f(points_.col(order_[i])));
    nodes_.push_back(node);
    if (end - begin <= kLeafSize) return index;
    int axis = 0;
    node.box.sizes().maxCoeff(&axis);
    const int middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](int a, int b) { return points_(axis, a) < points_(axis, b); });
    build(begin, middle);
    const int right = build(middle, end);
    nodes_[index].right = right;
    return index;
  }

  /// No two points of the boxes are farther apart.
  static double sqBound(const Node& a, const Node& b) {
    const Eigen::Vector3d one = (a.box.max().cast<double>() - b.box.min().cast<double>()).cwiseAbs();
    const Eigen::Vector3d other = (b.box.max().cast<double>() - a.box.min().cast<double>()).cwiseAbs();
    return one.cwiseMax(other).squaredNorm();
  }

  double greatestDistance(const Node& a, const Node& b) const {
    double best = 0.0;
    for (int i = a.begin; i < a.end; ++i) {
      const Eigen::Vector3d x = points_.col(order_[i]).cast<double>();
      for (int j = b.begin; j < b.end; ++j)
        best = std::max(best, (points_.col(order_[j]).cast<double>() - x).squaredNorm());
    }
    return best;
  }

  const PointsRef& points_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace

double diameter(const PointsRef& points) {
  return points.cols() < 2 ? 0.0 : std::sqrt(BoxTree(points).greatestDistance());
}

}  // namespace pcl_symmetry
