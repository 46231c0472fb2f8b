#include "core/neighbours/diameter.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/constants.h"

namespace pcl_symmetry {

namespace {

constexpr int kPointsPerNode = 8;  // points; chosen: half and twice as many shift work between bounds and distances

/// A binary tree that halves the points at each node. Each node knows a box around its points, and a cone from the
/// center of the bounding ball.
class HalvingTree {
public:
  explicit HalvingTree(const PointsRef& points)
      : points_(points), center_(boundingBall(points).center), sq_of_hops_(sqDistanceOfHops()), order_(possibleEnds()) {
    build(0, static_cast<int>(order_.size()));
  }

  double greatestSqDistance() const {
    double best = sq_of_hops_;
    search(0, 0, best);
    return best;
  }

private:
  struct Node {
    Eigen::AlignedBox3d box;
    Eigen::Vector3d axis;     // axis of the cone, unit
    double half_angle = 0.0;  // half opening angle of the cone, radians
    double reach = 0.0;       // greatest distance of a point from the center
    int begin = 0, end = 0;   // range of the points in order_
    int right = -1;           // index of the right child, the left one is the next node; -1 for a leaf
  };

  Node around(int begin, int end) const {
    constexpr double kSlack = 1e-9;  // derived: far above the rounding of doubles, so that bounds stay bounds
    Node node;
    node.begin = begin;
    node.end = end;
    for (int i = begin; i < end; ++i) node.box.extend(Eigen::Vector3d(points_.col(order_[i]).cast<double>()));
    const Eigen::Vector3d middle = node.box.center() - center_;
    node.axis = middle.norm() > 0.0 ? middle.normalized() : Eigen::Vector3d::UnitZ().eval();
    for (int i = begin; i < end; ++i) {
      const Eigen::Vector3d x = points_.col(order_[i]).cast<double>() - center_;
      node.reach = std::max(node.reach, x.norm());
      node.half_angle = std::max(node.half_angle, angleBetween(node.axis, x));
    }
    node.reach *= 1.0 + kSlack;
    node.half_angle += kSlack;
    return node;
  }

  static double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
  }

  int build(int begin, int end) {
    const int index = static_cast<int>(nodes_.size());
    const Node node = around(begin, end);
    nodes_.push_back(node);
    if (end - begin <= kPointsPerNode) return index;
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

  /// A first guess that is mostly close to the diameter: from a point to the farthest one, and on from there.
  double sqDistanceOfHops() const {
    constexpr int kNumHops = 4;  // chosen: fewer start the search lower, more rarely find a greater distance
    double best = 0.0;
    Eigen::Index at = 0;
    for (int k = 0; k < kNumHops; ++k) {
      const Eigen::Vector3f from = points_.col(at);
      (points_.colwise() - from).colwise().squaredNorm().maxCoeff(&at);
      best = std::max(best, (points_.col(at).cast<double>() - from.cast<double>()).squaredNorm());
    }
    return best;
  }

  /// The points that can be an end of the greatest distance: no point is farther from one of them than its own distance
  /// from the center and the greatest one together.
  std::vector<int> possibleEnds() const {
    constexpr double kSlack = 1e-9;  // derived: as in around()
    std::vector<double> reaches(static_cast<std::size_t>(points_.cols()));
    for (std::size_t i = 0; i < reaches.size(); ++i)
      reaches[i] = (points_.col(static_cast<Eigen::Index>(i)).cast<double>() - center_).norm();
    const double least =
        std::sqrt(sq_of_hops_) * (1.0 - kSlack) - *std::max_element(reaches.begin(), reaches.end()) * (1.0 + kSlack);
    std::vector<int> ends;
    for (std::size_t i = 0; i < reaches.size(); ++i)
      if (reaches[i] >= least) ends.push_back(static_cast<int>(i));
    return ends;
  }

  /// Raises \p best to the greatest squared distance between a point of node \p a and one of node \p b.
  void search(int a, int b, double& best) const {
    const Node &first = nodes_[a], &second = nodes_[b];
    if (sqBoundOfBoxes(first, second) <= best || sqBoundOfCones(first, second) <= best) return;
    if (first.right < 0 && second.right < 0) {
      best = std::max(best, greatestSqDistance(first, second));
    } else if (a == b) {
      search(a + 1, first.right, best);
      search(a + 1, a + 1, best);
      search(first.right, first.right, best);
    } else if (second.right < 0 || (first.right >= 0 && first.end - first.begin >= second.end - second.begin)) {
      search(a + 1, b, best);
      search(first.right, b, best);
    } else {
      search(a, b + 1, best);
      search(a, second.right, best);
    }
  }

  /// Upper bound of the squared distance between points of two boxes.
  static double sqBoundOfBoxes(const Node& a, const Node& b) {
    return (a.box.max() - b.box.min()).cwiseAbs().cwiseMax((b.box.max() - a.box.min()).cwiseAbs()).squaredNorm();
  }

  /// The same bound from the cones. It decides on round shapes, where opposite boxes are all equally far apart.
  static double sqBoundOfCones(const Node& a, const Node& b) {
    const double angle = std::min(kPi, angleBetween(a.axis, b.axis) + a.half_angle + b.half_angle);
    const double cosine = std::cos(angle);
    return a.reach * a.reach + b.reach * b.reach - 2.0 * std::min(0.0, cosine) * a.reach * b.reach;
  }

  double greatestSqDistance(const Node& a, const Node& b) const {
    double best = 0.0;
    for (int i = a.begin; i < a.end; ++i) {
      const Eigen::Vector3d x = points_.col(order_[i]).cast<double>();
      for (int j = b.begin; j < b.end; ++j)
        best = std::max(best, (points_.col(order_[j]).cast<double>() - x).squaredNorm());
    }
    return best;
  }

  const PointsRef& points_;
  Eigen::Vector3d center_;
  double sq_of_hops_;
  std::vector<int> order_;  ///< of the possible ends
  std::vector<Node> nodes_;
};

}  // namespace

double diameter(const PointsRef& points) {
  return points.cols() < 2 ? 0.0 : std::sqrt(HalvingTree(points).greatestSqDistance());
}

double farthestPair(const PointsRef& points) {
  if (points.cols() < 2) return 0.0;
  Eigen::Vector3f from = centerOfMass(points).cast<float>();
  Eigen::Index farthest = 0;
  (points.colwise() - from).colwise().squaredNorm().maxCoeff(&farthest);
  double distance = -1.0;
  for (double longer = 0.0; longer > distance;) {
    distance = longer;
    from = points.col(farthest);
    longer = std::sqrt(static_cast<double>((points.colwise() - from).colwise().squaredNorm().maxCoeff(&farthest)));
  }
  return distance;
}

}  // namespace pcl_symmetry
