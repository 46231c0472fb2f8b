#include "core/geometry/diameter.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/constants.h"
#include "core/base/simd.h"

namespace pcl_symmetry {

namespace {

constexpr int points_per_node = 8;

/// The point farthest from a position.
struct Farthest {
  Eigen::Index index;
  float sq_distance;
};

/// Squared distances of points from a position.
/// \param points three coordinates each, \p stride numbers from one to the next.
PCL_SYMMETRY_MULTIVERSION
void sqDistancesFrom(const float* position, const float* points, std::ptrdiff_t stride, Eigen::Index size,
                     float* sq_distances) {
  const float x = position[0], y = position[1], z = position[2];
#pragma GCC ivdep
  for (Eigen::Index i = 0; i < size; ++i) {
    const float dx = points[stride * i] - x, dy = points[stride * i + 1] - y, dz = points[stride * i + 2] - z;
    sq_distances[i] = dx * dx + dy * dy + dz * dz;
  }
}

Farthest farthestOf(const Eigen::Vector3f& position, const PointsRef& points) {
  std::vector<float> sq_distances(static_cast<std::size_t>(points.cols()));
  sqDistancesFrom(position.data(), points.data(), points.outerStride(), points.cols(), sq_distances.data());
  const auto greatest = std::max_element(sq_distances.begin(), sq_distances.end());
  return {greatest - sq_distances.begin(), *greatest};
}

/// A binary tree that halves the points at each node. Each node knows a box around its points, and a cone from the
/// center of the bounding ball.
class HalvingTree {
public:
  explicit HalvingTree(const PointsRef& points)
      : center_(boundingBall(points).center), sq_of_hops_(sqDistanceOfHops(points)), ends_(possibleEnds(points)) {
    nodes_.push_back(around(0, static_cast<int>(ends_.size())));
  }

  double greatestSqDistance() {
    double best = sq_of_hops_;
    search(0, 0, best);
    return best;
  }

private:
  /// A point that can be an end of the greatest distance.
  struct End {
    Eigen::Vector3d point;
    double reach;  ///< from the center
  };

  struct Node {
    Eigen::AlignedBox3d box;
    Eigen::Vector3d axis;     // axis of the cone, unit
    double half_angle = 0.0;  // half opening angle of the cone, radians
    double reach = 0.0;       // greatest distance of a point from the center
    int begin = 0, end = 0;   // range of the points in ends_
    std::size_t child = 0;    // the first of two, side by side; 0 before it is split

    int size() const { return end - begin; }
    bool isLeaf() const { return size() <= points_per_node; }
  };

  Node around(int begin, int end) const {
    constexpr double slack = 1e-9;        // far above the rounding of doubles
    constexpr double angle_slack = 1e-6;  // the same of an angle near 0 that comes from its cosine
    Node node;
    node.begin = begin;
    node.end = end;
    for (int i = begin; i < end; ++i) node.box.extend(ends_[i].point);
    const Eigen::Vector3d middle = node.box.center() - center_;
    node.axis = middle.norm() > 0.0 ? middle.normalized() : Eigen::Vector3d::UnitZ().eval();
    double least_cosine = 1.0;
    for (int i = begin; i < end; ++i) {
      node.reach = std::max(node.reach, ends_[i].reach);
      const double along = node.axis.dot(ends_[i].point - center_);
      if (along < least_cosine * ends_[i].reach) least_cosine = along / ends_[i].reach;
    }
    node.reach *= 1.0 + slack;
    node.half_angle = std::acos(std::max(-1.0, least_cosine)) + angle_slack;
    return node;
  }

  /// Gives a node its children, which few nodes need.
  void split(std::size_t index) {
    if (nodes_[index].child > 0) return;
    const int begin = nodes_[index].begin, end = nodes_[index].end, middle = begin + (end - begin) / 2;
    int axis = 0;
    nodes_[index].box.sizes().maxCoeff(&axis);
    std::nth_element(ends_.begin() + begin, ends_.begin() + middle, ends_.begin() + end,
                     [&](const End& a, const End& b) { return a.point[axis] < b.point[axis]; });
    nodes_[index].child = nodes_.size();
    nodes_.push_back(around(begin, middle));
    nodes_.push_back(around(middle, end));
  }

  /// A first guess that is mostly close to the diameter: from a point to the farthest one, and on from there.
  static double sqDistanceOfHops(const PointsRef& points) {
    constexpr int num_hops = 4;
    double best = 0.0;
    Eigen::Index at = 0;
    for (int k = 0; k < num_hops; ++k) {
      const Eigen::Vector3f from = points.col(at);
      at = farthestOf(from, points).index;
      best = std::max(best, (points.col(at).cast<double>() - from.cast<double>()).squaredNorm());
    }
    return best;
  }

  /// The points that can be an end of the greatest distance: no point is farther from one of them than its own distance
  /// from the center and the greatest one together.
  std::vector<End> possibleEnds(const PointsRef& points) const {
    constexpr double slack = 1e-9;  // far above the rounding of doubles
    std::vector<double> reaches(static_cast<std::size_t>(points.cols()));
    for (std::size_t i = 0; i < reaches.size(); ++i)
      reaches[i] = (points.col(static_cast<Eigen::Index>(i)).cast<double>() - center_).norm();
    const double least =
        std::sqrt(sq_of_hops_) * (1.0 - slack) - *std::max_element(reaches.begin(), reaches.end()) * (1.0 + slack);
    std::vector<End> ends;
    for (std::size_t i = 0; i < reaches.size(); ++i)
      if (reaches[i] >= least) ends.push_back({points.col(static_cast<Eigen::Index>(i)).cast<double>(), reaches[i]});
    return ends;
  }

  /// Raises \p best to the greatest squared distance between a point of node \p a and one of node \p b.
  void search(std::size_t a, std::size_t b, double& best) {
    if (sqBoundOfBoxes(nodes_[a], nodes_[b]) <= best || sqBoundOfCones(nodes_[a], nodes_[b]) <= best) return;
    if (nodes_[a].isLeaf() && nodes_[b].isLeaf()) {
      best = std::max(best, greatestSqDistance(nodes_[a], nodes_[b]));
      return;
    }
    const bool splits_b = nodes_[a].isLeaf() || (!nodes_[b].isLeaf() && nodes_[b].size() > nodes_[a].size());
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
  static double sqBoundOfBoxes(const Node& a, const Node& b) {
    return (a.box.max() - b.box.min()).cwiseAbs().cwiseMax((b.box.max() - a.box.min()).cwiseAbs()).squaredNorm();
  }

  /// The same bound from the cones. It decides on round shapes, where opposite boxes are all equally far apart.
  static double sqBoundOfCones(const Node& a, const Node& b) {
    const double between = std::atan2(a.axis.cross(b.axis).norm(), a.axis.dot(b.axis));
    const double angle = std::min(kPi, between + a.half_angle + b.half_angle);
    const double cosine = std::cos(angle);
    return a.reach * a.reach + b.reach * b.reach - 2.0 * std::min(0.0, cosine) * a.reach * b.reach;
  }

  double greatestSqDistance(const Node& a, const Node& b) const {
    double best = 0.0;
    for (int i = a.begin; i < a.end; ++i)
      for (int j = b.begin; j < b.end; ++j) best = std::max(best, (ends_[j].point - ends_[i].point).squaredNorm());
    return best;
  }

  Eigen::Vector3d center_;
  double sq_of_hops_;
  std::vector<End> ends_;
  std::vector<Node> nodes_;
};

}  // namespace

double diameter(const PointsRef& points) {
  return points.cols() < 2 ? 0.0 : std::sqrt(HalvingTree(points).greatestSqDistance());
}

double farthestPair(const PointsRef& points) {
  if (points.cols() < 2) return 0.0;
  Farthest farthest = farthestOf(centerOfMass(points).cast<float>(), points);
  double distance = -1.0;
  for (double longer = 0.0; longer > distance;) {
    distance = longer;
    farthest = farthestOf(points.col(farthest.index), points);
    longer = std::sqrt(static_cast<double>(farthest.sq_distance));
  }
  return distance;
}

}  // namespace pcl_symmetry
