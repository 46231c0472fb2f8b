#include "core/matching/point_pair_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/constants.h"
#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/base/simd.h"
#include "core/matching/matching_rules.h"

namespace pcl_symmetry {

namespace {

// Step of the logarithm of a distance: 16 %, the spacing of the points on a shape.
constexpr double kPairDistanceStep = 0.15;
// Steps of 15 degrees of the angle between the first normal and the line, and of the angles of the second normal with
// the line and the first normal, which have no sign.
constexpr int kPairAngles = 12, kPairOtherAngles = kPairAngles / 2;
// Steps of a full rotation about the first normal: as many as a byte holds.
constexpr float kStepsOfTurn = 256.0f;
// Longest distance of a pair, radii: the diameter, with rounding.
constexpr double kLongestPair = 2.1;

/// Two points with their normals.
struct PointPair {
  double log_distance;       ///< logarithm of the distance, in steps
  double angle;              ///< angle between the first normal and the line, in steps
  int other_angle, between;  ///< in steps
  std::uint8_t rotation;     ///< rotation of the second point about the first normal, in steps
};

/// Pairs of one point with all points of its surface.
struct PairRow {
  Eigen::ArrayXf distance;                                             ///< radii
  Eigen::ArrayXi distance_step, angle_step, other_step, between_step;  ///< valid where distance > 0
  Eigen::ArrayXi rotation;                                             ///< in units of 1/256
};

// Added to divisors to avoid divisions by 0.
constexpr float kTiny = 1e-20f;

int angleStep(double cosine, int num_steps, double range) {
  const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
  return std::min(num_steps - 1, static_cast<int>(angle / range * num_steps));
}

/// The ends of the steps of an angle, as cosines.
template <int kSteps>
std::vector<float> cosineLimits(double range) {
  std::vector<float> limits;
  for (int k = 1; k < kSteps; ++k) limits.push_back(static_cast<float>(std::cos(range * k / kSteps)));
  return limits;
}

/// For each value, the number of limits that it is at or below.
Eigen::ArrayXi limitsReached(const Eigen::ArrayXf& values, const std::vector<float>& limits) {
  Eigen::ArrayXi count = Eigen::ArrayXi::Zero(values.size());
  for (const float limit : limits) count += (values <= limit).cast<int>();
  return count;
}

/// Angles of directions in a plane, in steps.
Eigen::ArrayXi anglesOf(const Eigen::ArrayXf& u, const Eigen::ArrayXf& v) {
  const Eigen::ArrayXf au = u.abs(), av = v.abs(), t = au.min(av) / (au.max(av) + kTiny), s = t * t;
  // Abramowitz and Stegun 4.4.47, with an error of 1e-5, divided by 2 pi.
  Eigen::ArrayXf angle = t * (0.159133f + s * (-0.0525688f + s * (0.0286703f + s * (-0.0135493f + s * 0.00331601f))));
  angle = (au < av).select(0.25f - angle, angle);
  angle = (u < 0.0f).select(0.5f - angle, angle);
  angle = (v < 0.0f).select(1.0f - angle, angle);
  return (kStepsOfTurn * angle)
      .unaryExpr([](float step) { return static_cast<std::uint8_t>(static_cast<int>(step)); })
      .cast<int>();
}

/// A point with its normal as a frame: the normal, and two directions perpendicular to it.
Eigen::Matrix3d frameOf(const Eigen::Vector3d& normal) {
  Eigen::Matrix3d frame;
  frame.col(0) = normal;
  frame.col(1) = normal.unitOrthogonal();
  frame.col(2) = normal.cross(frame.col(1));
  return frame;
}

/// \param frame frame of the first point.
/// \param second a point other than \p first.
PointPair pairOf(const Eigen::Matrix3d& frame, const Eigen::Vector3d& first, const Eigen::Vector3d& second,
                 const Eigen::Vector3d& second_normal) {
  const Eigen::Vector3d line = second - first;
  const double distance = line.norm();
  const Eigen::Vector3d direction = frame.transpose() * line / distance;
  PointPair pair;
  pair.log_distance = std::log(distance) / kPairDistanceStep;
  pair.angle = std::acos(std::clamp(direction.x(), -1.0, 1.0)) / kPi * kPairAngles;
  pair.other_angle = angleStep(std::abs(second_normal.dot(line)) / distance, kPairOtherAngles, 0.5 * kPi);
  pair.between = angleStep(std::abs(second_normal.dot(frame.col(0))), kPairOtherAngles, 0.5 * kPi);
  const double rotation = std::atan2(direction.z(), direction.y()) / (2.0 * kPi);
  pair.rotation = static_cast<std::uint8_t>(static_cast<int>(std::floor((rotation + 1.0) * kStepsOfTurn)));
  return pair;
}

/// Finds for all pairs of points of a surface, many at once, what pairOf() finds for one.
class PairedSurface {
public:
  /// \param normals unit.
  /// \param radius unit of the distances, > 0.
  PairedSurface(const PointsRef& points, const PointsRef& normals, double radius)
      : first_step_(static_cast<int>(std::floor(std::log(0.1 * radius) / kPairDistanceStep))) {
    const Eigen::Vector3f middle = points.rowwise().mean();
    points_ = ((points.colwise() - middle) / static_cast<float>(radius)).transpose();
    normals_ = normals.transpose();
    for (int step = first_step_ + 1;; ++step) {
      const double distance = std::exp(kPairDistanceStep * step) / radius;
      if (distance > kLongestPair) break;
      sq_distances_.push_back(static_cast<float>(distance * distance));
    }
  }

  /// Pairs whose first point is point \p i.
  PairRow row(int i) const {
    static const std::vector<float> limits = cosineLimits<kPairAngles>(kPi);
    static const std::vector<float> other_limits = cosineLimits<kPairOtherAngles>(0.5 * kPi);
    const Eigen::Matrix3f frame = frameOf(normals_.row(i).matrix().transpose().cast<double>()).cast<float>();
    const Eigen::ArrayX3f lines = points_.rowwise() - points_.row(i);
    const auto along = [](const Eigen::Vector3f& axis, const Eigen::ArrayX3f& vectors) -> Eigen::ArrayXf {
      return axis.x() * vectors.col(0) + axis.y() * vectors.col(1) + axis.z() * vectors.col(2);
    };
    const auto dot = [](const Eigen::ArrayX3f& a, const Eigen::ArrayX3f& b) -> Eigen::ArrayXf {
      return a.col(0) * b.col(0) + a.col(1) * b.col(1) + a.col(2) * b.col(2);
    };
    const Eigen::ArrayXf sq_distances = dot(lines, lines), inverse = 1.0f / (sq_distances + kTiny).sqrt();
    PairRow row;
    row.distance = sq_distances.sqrt();
    row.distance_step = Eigen::ArrayXi::Constant(lines.rows(), first_step_);
    for (const float limit : sq_distances_) row.distance_step += (sq_distances >= limit).cast<int>();
    row.angle_step = limitsReached(along(frame.col(0), lines) * inverse, limits);
    row.other_step = limitsReached(dot(normals_, lines).abs() * inverse, other_limits);
    row.between_step = limitsReached(along(frame.col(0), normals_).abs(), other_limits);
    row.rotation = anglesOf(along(frame.col(1), lines), along(frame.col(2), lines));
    return row;
  }

private:
  Eigen::ArrayX3f points_, normals_;  // one per row
  int first_step_;                    // number of the step of the shortest distance
  std::vector<float> sq_distances_;   // where each further step begins, squared
};

// Number of rotations about a normal that are distinguished: 22.5 degrees apart, 4 of the 8 bits that store one.
constexpr int kNumRotations = 16;
constexpr std::uint32_t kRotationMask = std::numeric_limits<std::uint8_t>::max();
constexpr std::uint32_t kPairsAtOnce = 128;

/// Indices of the counters of pairs: the first point of each and the step of the rotation that it requires.
PCL_SYMMETRY_MULTIVERSION void findCounters(const std::uint32_t* __restrict pairs, std::uint32_t size,
                                            std::uint32_t rotation, std::uint32_t* __restrict counters) {
  for (std::uint32_t i = 0; i < size; ++i)
    counters[i] = ((pairs[i] & ~kRotationMask) | ((pairs[i] - rotation) & kRotationMask)) >> 4;
}

}  // namespace

int PointPairIndex::keyOf(int distance, int angle, int other_angle, int between) const {
  return (((distance - first_distance_) * kPairAngles + angle) * kPairOtherAngles + other_angle) * kPairOtherAngles +
         between;
}

PointPairIndex::PointPairIndex(const std::vector<SurfacePoints>& shapes, int num_threads) {
  for (const SurfacePoints& shape : shapes) begins_.push_back(begins_.back() + static_cast<int>(shape.points.cols()));
  points_.resize(3, begins_.back());
  normals_.resize(3, begins_.back());
  double nearest = std::numeric_limits<double>::infinity(), farthest = 0.0;
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    const Eigen::Index size = shapes[k].points.cols();
    points_.middleCols(begins_[k], size) = shapes[k].points;
    normals_.middleCols(begins_[k], size) = shapes[k].normals;
    radii_.push_back(boundingBall(shapes[k].points).radius);
    if (!(radii_.back() > 0.0)) continue;
    nearest = std::min(nearest, kMatching.min_pair_distance * radii_.back());
    farthest = std::max(farthest, kLongestPair * radii_.back());
  }
  if (!(farthest > 0.0)) return;
  first_distance_ = static_cast<int>(std::floor(std::log(nearest) / kPairDistanceStep));
  num_distances_ = static_cast<int>(std::floor(std::log(farthest) / kPairDistanceStep)) - first_distance_ + 1;
  weights_.resize(keyOf(first_distance_ + num_distances_, 0, 0, 0));
  const std::size_t block_size = 4;  // number of shapes whose votes and pairs fit into a cache
  blocks_.resize((shapes.size() + block_size - 1) / block_size);
  parallelRanges(shapes.size(), block_size, num_threads, [&](std::size_t begin, std::size_t end) {
    blocks_[begin / block_size] = blockOf(static_cast<int>(begin), static_cast<int>(end));
  });
  fillWeights();
}

PointPairIndex::Block PointPairIndex::blockOf(int first_shape, int end_shape) const {
  std::vector<std::uint32_t> keys, pairs;
  for (int k = first_shape; k < end_shape; ++k) {
    const double radius = radii_[k];
    if (!(radius > 0.0)) continue;
    const int begin = begins_[k], size = begins_[static_cast<std::size_t>(k) + 1] - begin;
    const PairedSurface surface(points_.middleCols(begin, size), normals_.middleCols(begin, size), radius);
    for (int i = 0; i < size; ++i) {
      const PairRow row = surface.row(i);
      const auto point = static_cast<std::uint32_t>(begin + i - begins_[first_shape]);
      for (int j = 0; j < size; ++j) {
        if (!(row.distance[j] > kMatching.min_pair_distance)) continue;
        keys.push_back(static_cast<std::uint32_t>(keyOf(std::max(row.distance_step[j], first_distance_),
                                                        row.angle_step[j], row.other_step[j], row.between_step[j])));
        pairs.push_back(point << 8 | static_cast<std::uint32_t>(row.rotation[j]));
      }
    }
  }
  Block block{first_shape, end_shape, std::vector<std::uint32_t>(numKeys() + 1, 0), {}};
  for (const std::uint32_t key : keys) ++block.key_begins[key + 1];
  std::partial_sum(block.key_begins.begin(), block.key_begins.end(), block.key_begins.begin());
  std::vector<std::uint32_t> ends(block.key_begins.begin(), block.key_begins.end() - 1);
  block.pairs.resize(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) block.pairs[ends[keys[i]]++] = pairs[i];
  return block;
}

void PointPairIndex::fillWeights() {
  std::vector<std::uint32_t> sizes(numKeys(), 0);
  std::size_t num_pairs = 0;
  for (const Block& block : blocks_) {
    num_pairs += block.pairs.size();
    for (std::size_t key = 0; key < sizes.size(); ++key)
      sizes[key] += block.key_begins[key + 1] - block.key_begins[key];
  }
  const double num_used = 1.0 + static_cast<double>(sizes.size()) -
                          static_cast<double>(std::count(sizes.begin(), sizes.end(), std::uint32_t{0}));
  for (std::size_t key = 0; key < sizes.size(); ++key) {
    const double share = static_cast<double>(num_pairs) / num_used / std::max<std::uint32_t>(1, sizes[key]);
    weights_[key] =
        static_cast<std::uint8_t>(std::clamp(kMatching.mean_weight * std::sqrt(share), 1.0, kMatching.max_weight));
  }
}

PointPairIndex::Reference PointPairIndex::referenceOf(const SurfacePoints& scan, int index, int sign) const {
  Reference reference{
      frameOf(sign * scan.normals.col(index).cast<double>().normalized()), scan.points.col(index).cast<double>(), {}};
  for (Eigen::Index j = 0; j < scan.points.cols(); ++j) {
    const Eigen::Vector3d second = scan.points.col(j).cast<double>();
    if (j == index || !((second - reference.point).norm() > 0.0)) continue;
    const PointPair pair = pairOf(reference.frame, reference.point, second, scan.normals.col(j).cast<double>());
    const int distance = static_cast<int>(std::floor(pair.log_distance - 0.5)),
              angle = static_cast<int>(std::floor(pair.angle - 0.5));
    for (int d = std::max(distance, first_distance_); d <= std::min(distance + 1, first_distance_ + num_distances_ - 1);
         ++d)
      for (int a = std::max(0, angle); a <= std::min(angle + 1, kPairAngles - 1); ++a)
        reference.look_ups.push_back(
            {static_cast<std::uint32_t>(keyOf(d, a, pair.other_angle, pair.between)), pair.rotation});
  }
  // Look-ups in the order of memory.
  std::sort(reference.look_ups.begin(), reference.look_ups.end(),
            [](const LookUp& a, const LookUp& b) { return a.key < b.key; });
  return reference;
}

/// Votes of one point of the scan, for each point of the shapes that it may be and each rotation about its normal.
void PointPairIndex::count(const Block& block, const std::vector<LookUp>& look_ups,
                           std::vector<std::int32_t>& votes) const {
  std::fill(votes.begin(), votes.end(), 0);
  std::array<std::uint32_t, kPairsAtOnce> counters;
  for (const LookUp& look_up : look_ups) {
    const std::int32_t weight = weights_[look_up.key];
    const std::uint32_t end = block.key_begins[look_up.key + 1];
    for (std::uint32_t at = block.key_begins[look_up.key]; at < end; at += kPairsAtOnce) {
      const std::uint32_t size = std::min(kPairsAtOnce, end - at);
      findCounters(block.pairs.data() + at, size, look_up.rotation, counters.data());
      for (std::uint32_t i = 0; i < size; ++i) votes[counters[i]] += weight;
    }
  }
}

/// Collects the poses of a shape with most votes of a point of the scan.
/// \param votes votes for the points of the shape.
void PointPairIndex::collect(int shape, const Reference& reference, const Eigen::Vector3d& center,
                             const std::int32_t* votes, std::vector<Vote>& poses) const {
  struct Peak {
    int weight, point, rotation;
  };
  std::array<Peak, 3> best{};
  const int begin = begins_[shape], end = begins_[static_cast<std::size_t>(shape) + 1];
  for (int i = begin; i < end; ++i, votes += kNumRotations) {
    std::int32_t most = 0;
    for (int t = 0; t < kNumRotations; ++t) most = std::max(most, votes[t]);
    if (2 * most <= best.back().weight) continue;  // votes for two neighboring steps of the rotation are added
    Peak peak{0, i, 0};
    for (int t = 0; t < kNumRotations; ++t) {
      const int weight = votes[t] + votes[(t + 1) % kNumRotations];
      if (weight > peak.weight) peak = {weight, i, t};
    }
    if (peak.weight <= best.back().weight) continue;
    best.back() = peak;
    std::sort(best.begin(), best.end(), [](const Peak& a, const Peak& b) { return a.weight > b.weight; });
  }
  for (const Peak& peak : best) {
    if (peak.weight == 0) continue;
    // The middle of the two steps.
    const double angle = 2.0 * kPi * (peak.rotation + 1.0) / kNumRotations;
    const Eigen::Matrix3d R_shape_scan = frameOf(normals_.col(peak.point).cast<double>().normalized()) *
                                         Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()) *
                                         reference.frame.transpose();
    poses.push_back({Eigen::Quaterniond(R_shape_scan),
                     points_.col(peak.point).cast<double>() + R_shape_scan * (center - reference.point),
                     static_cast<double>(peak.weight)});
  }
}

/// Joins votes for similar poses.
ShapeOfPairs PointPairIndex::clustered(int shape, std::vector<Vote> votes, const Eigen::Vector3d& center,
                                       int num_poses) const {
  sortDescending(votes, &Vote::weight);
  struct Cluster {
    Vote first;
    Eigen::Vector4d rotation;
    Eigen::Vector3d position;
    double weight;
  };
  const double cosine = std::cos(0.5 * kMatching.same_angle), distance = kMatching.same_position * radii_[shape];
  std::vector<Cluster> clusters;
  for (const Vote& vote : votes) {
    const auto same = std::find_if(clusters.begin(), clusters.end(), [&](const Cluster& cluster) {
      return std::abs(cluster.first.rotation.dot(vote.rotation)) > cosine &&
             (cluster.first.position - vote.position).norm() < distance;
    });
    if (same == clusters.end()) {
      clusters.push_back({vote, vote.weight * vote.rotation.coeffs(), vote.weight * vote.position, vote.weight});
      continue;
    }
    const double sign = same->first.rotation.dot(vote.rotation) < 0.0 ? -1.0 : 1.0;
    same->rotation += sign * vote.weight * vote.rotation.coeffs();
    same->position += vote.weight * vote.position;
    same->weight += vote.weight;
  }
  sortDescending(clusters, &Cluster::weight);
  ShapeOfPairs found{shape, clusters.empty() ? 0.0 : clusters.front().weight, {}};
  for (const Cluster& cluster : clusters) {
    if (found.T_shape_scan.size() == static_cast<std::size_t>(num_poses)) break;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = Eigen::Quaterniond(cluster.rotation).normalized().toRotationMatrix();
    pose.translation() = cluster.position / cluster.weight - pose.linear() * center;
    found.T_shape_scan.push_back(pose);
  }
  return found;
}

std::vector<ShapeOfPairs> PointPairIndex::nearest(const SurfacePoints& scan, const PairSearchOptions& options) const {
  const Eigen::Vector3d center = centerOfMass(scan.points);
  std::vector<Reference> references;
  if (!blocks_.empty())
    for (int i = 0; i < std::min<int>(kMatching.num_references, static_cast<int>(scan.points.cols())); ++i)
      for (const int sign : {1, -1}) references.push_back(referenceOf(scan, i, sign));
  std::vector<ShapeOfPairs> found(radii_.size());
  for (std::size_t k = 0; k < found.size(); ++k) found[k].shape = static_cast<int>(k);
  parallelBlocks(blocks_.size(), options.num_threads, [&](std::size_t b) {
    const Block& block = blocks_[b];
    const auto begin = static_cast<std::size_t>(block.first_shape), end = static_cast<std::size_t>(block.end_shape);
    std::vector<std::int32_t> votes(static_cast<std::size_t>(begins_[end] - begins_[begin]) * kNumRotations);
    std::vector<std::vector<Vote>> poses(end - begin);
    for (const Reference& reference : references) {
      count(block, reference.look_ups, votes);
      for (std::size_t k = begin; k < end; ++k)
        collect(static_cast<int>(k), reference, center,
                votes.data() + static_cast<std::size_t>(begins_[k] - begins_[begin]) * kNumRotations, poses[k - begin]);
    }
    for (std::size_t k = begin; k < end; ++k)
      found[k] = clustered(static_cast<int>(k), std::move(poses[k - begin]), center, options.num_poses);
  });
  sortDescending(found, &ShapeOfPairs::votes);
  found.resize(std::min(found.size(), static_cast<std::size_t>(options.num_nearest)));
  return found;
}

}  // namespace pcl_symmetry
