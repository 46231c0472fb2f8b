#include "core/detection/standing_object.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/constants.h"
#include "core/base/lists.h"
#include "core/base/statistics.h"
#include "core/detection/detection_rules.h"
#include "core/detection/plane_decision.h"
#include "core/geometry/directions.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/surface_normals.h"

namespace pcl_symmetry {

namespace {

struct UprightBoxRules {
  int num_angles = 180;   // angles that are tried, in steps of half a degree within a quarter turn
  double trimmed = 0.01;  // share of the points beyond each side of the box
  double near = 0.1;      // distance from a side within which a point is near it, in shorter sides of the box
  double meets = 0.03;    // distance within which a reflected point meets what a beam hit, in mean diagonals of the box
  // Distance within which a beam is informative, in median distances from a beam to its fourth nearest.
  double beam_reach = 2.0;
  int beams = 3;  // nearest beams by which a reflected point is judged
  // Points cut off at a side of the image:
  int rows = 12;            // number of rows between the lowest and the highest elevation
  int cut_rows = 4;         // least number of rows that end in one upright line of the image
  double cut_width = 0.02;  // width of that line, as a share of the width of the points in the image
  // Least difference of the ranges at which the rows end, as a share of the diagonal seen from above.
  double cut_depth = 0.25;
  // Logit of the confidence: a constant, and the weights of the share near a side and of the root of the share in free
  // space; fitted to virtual scans.
  double confidence = 0.7, of_near = 4.15, of_free = -15.6;
};
constexpr UprightBoxRules kBox;

/// A rectangle around points seen from above, and how far they are off its sides.
struct Rectangle {
  std::array<Eigen::Vector3d, 2> axes;  // unit, horizontal
  std::array<std::array<double, 2>, 2> sides;
  std::vector<double> distances;  // distance of each point from the nearest side
  double sq_error = 0.0;          // mean squared distance
};

Rectangle rectangleAt(const PointsRef& points, const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
  Rectangle rectangle{{u, v}, {}, std::vector<double>(points.cols(), 0.0), 0.0};
  for (std::size_t k = 0; k < 2; ++k) {
    const Eigen::RowVectorXf along = rectangle.axes[k].cast<float>().transpose() * points;
    const auto num_cut = static_cast<std::size_t>(std::lround(kBox.trimmed * static_cast<double>(along.size() - 1)));
    const auto [low, high] = trimmedExtent(std::vector<double>(along.data(), along.data() + along.size()), num_cut);
    rectangle.sides[k] = {low, high};
    for (Eigen::Index i = 0; i < along.size(); ++i) {
      double& distance = rectangle.distances[i];
      const double position = along[i], off = std::min(std::abs(position - low), std::abs(position - high));
      distance = k == 0 ? off : std::min(distance, off);
    }
  }
  for (const double distance : rectangle.distances) rectangle.sq_error += distance * distance;
  rectangle.sq_error /= static_cast<double>(points.cols());
  return rectangle;
}

Rectangle bestRectangle(const PointsRef& points, const Eigen::Vector3d& up) {
  std::optional<Rectangle> best;
  for (int k = 0; k < kBox.num_angles; ++k) {
    const Eigen::Vector3d u = directionAcross(up, 0.5 * kPi * k / kBox.num_angles);
    Rectangle tried = rectangleAt(points, u, up.cross(u));
    if (!best || tried.sq_error < best->sq_error) best = std::move(tried);
  }
  return *best;
}

/// The diagonal of an upright box that holds the points, averaged over its angles. kBox was fitted to boxes along the
/// axes of clouds, which lay at any angle.
double meanDiagonal(const PointsRef& points, const Eigen::Vector3d& up) {
  const auto width = [&](const Eigen::Vector3d& along) {
    const Eigen::RowVectorXf positions = along.cast<float>().transpose() * points;
    return static_cast<double>(positions.maxCoeff() - positions.minCoeff());
  };
  const double height = width(up);
  double sum = 0.0;
  for (int k = 0; k < kBox.num_angles; ++k) {
    const Eigen::Vector3d u = directionAcross(up, 0.5 * kPi * k / kBox.num_angles);
    sum += Eigen::Vector3d(width(u), width(up.cross(u)), height).norm();
  }
  return sum / kBox.num_angles;
}

/// Whether points were cut off at a side of the scanner's image: many of their rows end in one upright line of the
/// image, at very different ranges. No surface is seen that edge-on.
bool endAtImageBorder(const PointsRef& points, const Eigen::Vector3d& up, const Eigen::Vector3d& viewpoint) {
  const Eigen::Vector3d middle = centerOfMass(points) - viewpoint;
  const Eigen::Vector3d ahead = (middle - middle.dot(up) * up).normalized(), sideways = up.cross(ahead);
  const auto along = [&](const Eigen::Vector3d& axis) -> Eigen::ArrayXd {
    return (axis.transpose() * (points.cast<double>().colwise() - viewpoint)).transpose();
  };
  const Eigen::ArrayXd x = along(ahead), y = along(sideways), range = (x.square() + y.square()).sqrt();
  const Eigen::ArrayXd elevation = (along(up) / range).atan();
  Eigen::ArrayXd azimuth = y.binaryExpr(x, [](double b, double a) { return std::atan2(b, a); });
  const auto widthOf = [](const Eigen::ArrayXd& values) { return values.maxCoeff() - values.minCoeff(); };
  const double depth = kBox.cut_depth * std::hypot(widthOf(x), widthOf(y)), width = kBox.cut_width * widthOf(azimuth);
  if (!(widthOf(elevation) > 0.0)) return false;
  const Eigen::ArrayXd row = (elevation - elevation.minCoeff()) * (kBox.rows / widthOf(elevation));
  for (int side = 0; side < 2; ++side, azimuth = -azimuth) {
    std::vector<Eigen::Index> ends(kBox.rows, -1);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      Eigen::Index& end = ends[std::min(static_cast<int>(row[i]), kBox.rows - 1)];
      if (end < 0 || azimuth[i] > azimuth[end]) end = i;
    }
    std::vector<double> ranges;
    for (const Eigen::Index end : ends)
      if (end >= 0 && azimuth[end] > azimuth.maxCoeff() - width) ranges.push_back(range[end]);
    const auto [nearest, farthest] = std::minmax_element(ranges.begin(), ranges.end());
    if (static_cast<int>(ranges.size()) >= kBox.cut_rows && *farthest - *nearest > depth) return true;
  }
  return false;
}

/// Directions from a viewpoint to points, and their ranges.
Points directionsTo(const PointsRef& points, const Eigen::Vector3d& viewpoint, std::vector<double>& ranges) {
  Points directions(3, points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d ray = points.col(i).cast<double>() - viewpoint;
    ranges.push_back(ray.norm());
    directions.col(i) = (ray / ranges.back()).cast<float>();
  }
  return directions;
}

enum class Meets { Surface, Free, Unknown };

/// For each reflected point, whether the beams of a scanner hit a surface there, passed freely, or neither.
/// \param reach distance within which a beam hits a point.
std::vector<Meets> meetingsAt(const Points& reflected, const PointsRef& points, const Eigen::Vector3d& viewpoint,
                              double reach) {
  std::vector<double> ranges, reflected_ranges;
  const Points directions = directionsTo(points, viewpoint, ranges);
  const ClosestPointSearch::Ptr search = makeFlannSearch(directions);
  std::vector<int> beams, closest;
  std::vector<float> sq_beam_distances, sq_distances, sq_reaches;
  search->search(directions, kBox.beams + 2, beams, sq_beam_distances);
  for (std::size_t i = kBox.beams + 1; i < sq_beam_distances.size(); i += kBox.beams + 2)
    sq_reaches.push_back(sq_beam_distances[i]);
  const float sq_beam_reach = static_cast<float>(kBox.beam_reach * kBox.beam_reach) * median(std::move(sq_reaches));
  search->search(directionsTo(reflected, viewpoint, reflected_ranges), kBox.beams, beams, sq_beam_distances);
  makeFlannSearch(points)->search(reflected, 1, closest, sq_distances);
  std::vector<Meets> met(reflected_ranges.size(), Meets::Unknown);
  for (std::size_t i = 0; i < met.size(); ++i) {
    bool meets = sq_distances[i] <= reach * reach, all_pass = true;
    for (std::size_t k = kBox.beams * i; k < kBox.beams * (i + 1); ++k) {
      const double behind = reflected_ranges[i] - ranges[beams[k]];
      const bool is_close = sq_beam_distances[k] <= sq_beam_reach;
      meets |= is_close && std::abs(behind) <= reach;
      all_pass &= is_close && behind < -reach;
    }
    met[i] = meets ? Meets::Surface : all_pass ? Meets::Free : Meets::Unknown;
  }
  return met;
}

}  // namespace

std::vector<Eigen::Vector3d> supportNormals(const PointsRef& points, const Visibility& seen) {
  std::vector<double> heights;  // the least signed distance of the points from each support
  for (const Eigen::Vector4d& support : seen.supports())
    heights.push_back((support.head<3>().transpose().cast<float>() * points).minCoeff() + support[3]);
  if (heights.empty()) return {};
  const double reach = *std::min_element(heights.begin(), heights.end()) +
                       kDetection.decide.touching * 2.0 * boundingBall(points).radius;
  std::vector<Eigen::Vector3d> normals;
  for (std::size_t i = 0; i < heights.size(); ++i)
    if (heights[i] <= reach) normals.push_back(seen.supports()[i].head<3>().normalized());
  return normals;
}

bool isSlanted(const ReflectionPlane& plane, const std::vector<Eigen::Vector3d>& support_normals) {
  const auto isAlong = [&](const Eigen::Vector3d& normal) {
    const double angle = std::acos(std::min(1.0, std::abs(normal.dot(plane.normal()))));
    return angle <= kDetection.decide.upright || angle >= 0.5 * kPi - kDetection.decide.upright;
  };
  return !support_normals.empty() && std::none_of(support_normals.begin(), support_normals.end(), isAlong);
}

std::optional<SymmetryPlane> middlePlaneOfBox(const PointsRef& points, const Eigen::Vector3d& up,
                                              const Eigen::Vector3d& viewpoint) {
  const Rectangle box = bestRectangle(points, up.normalized());
  const auto width = [&](std::size_t k) { return box.sides[k][1] - box.sides[k][0]; };
  const std::size_t across = width(0) <= width(1) ? 0 : 1;
  const double reach = kBox.meets * meanDiagonal(points, up.normalized());
  if (!(width(across) > 2.0 * reach)) return std::nullopt;
  SymmetryPlane middle(ReflectionPlane(box.axes[across], 0.5 * (box.sides[across][0] + box.sides[across][1])));
  double num_moved = 0.0, num_met = 0.0, num_free = 0.0;
  const std::vector<Meets> met = meetingsAt(reflectedPoints(points, middle), points, viewpoint, reach);
  for (std::size_t i = 0; i < met.size(); ++i) {
    middle.point_support.push_back(met[i] == Meets::Surface ? 1.0f
                                   : met[i] == Meets::Free  ? 0.0f
                                                            : std::numeric_limits<float>::quiet_NaN());
    if (2.0 * std::abs(middle.signedDistance(points.col(i).cast<double>())) <= reach) continue;
    num_moved += 1.0;
    num_met += met[i] == Meets::Surface ? 1.0 : 0.0;
    num_free += met[i] == Meets::Free ? 1.0 : 0.0;
  }
  if (!(num_met > 0.0)) return std::nullopt;
  const auto num_near = std::count_if(box.distances.begin(), box.distances.end(),
                                      [&](double distance) { return distance < kBox.near * width(across); });
  const double near = static_cast<double>(num_near) / static_cast<double>(points.cols());
  middle.confidence = logistic(kBox.confidence + kBox.of_near * near + kBox.of_free * std::sqrt(num_free / num_moved));
  middle.share = num_met / (num_met + num_free);
  middle.share_low = middle.support = num_met / num_moved;
  middle.share_high = 1.0 - num_free / num_moved;
  middle.seen = (num_met + num_free) / num_moved;
  middle.residual = std::sqrt(box.sq_error);
  middle.converged = true;
  return middle;
}

void decideByUprightBox(const PointsRef& points, const Visibility& seen, const DetectionOptions& options,
                        Detection& found) {
  const std::vector<Eigen::Vector3d> up = supportNormals(points, seen);
  if (up.empty()) return;
  const double spacing = median(localGeometry(points, *makeFlannSearch(points), options.num_threads).spacing);
  const bool is_sparse = spacing > kDetection.decide.no_surface * found.tolerance;
  const bool is_decided =
      found.hasFamily() || (!found.planes.empty() && found.planes.front().kind == PlaneKind::Symmetry);
  if (is_decided && !is_sparse) return;
  std::optional<SymmetryPlane> plane = middlePlaneOfBox(points, up.front(), seen.viewpoint());
  if (plane) {
    const CloudLimits limits(points, principalAxes(points), CloudKind::Scan, &seen,
                             {found.tolerance, found.resolution, spacing, found.diameter});
    for (const char* rule : limits.rulesAgainst(*plane, points)) limitToPossible(*plane, rule);
    if (endAtImageBorder(points, up.front(), seen.viewpoint()))
      limitToPossible(*plane, "the picture cuts the points off");
    setConfidence(*plane, plane->confidence, "the sides of the upright box around the points", options);
  }
  if (is_sparse) {
    found.planes.clear();
    found.axes.clear();
    found.centers.clear();
    found.rotations.clear();
    found.best = plane;
  }
  if (!plane || plane->confidence < (is_sparse ? options.min_possible : options.min_confidence)) return;
  // An earlier result for this plane was at most possible.
  const BoundingBall ball = boundingBall(points);
  const auto inBall = [&](const ReflectionPlane& other) { return other.normalized(ball.center, ball.radius); };
  eraseIf(found.planes, [&](const SymmetryPlane& other) { return kSamePlane.same(inBall(other), inBall(*plane)); });
  found.planes.insert(found.planes.begin(), std::move(*plane));
  found.planes = sortPlanes(std::move(found.planes), options);
  if (static_cast<int>(found.planes.size()) > options.max_planes) found.planes.resize(options.max_planes);
  found.best.reset();
}

}  // namespace pcl_symmetry
