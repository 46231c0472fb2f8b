#include "core/matching/pairs/point_pair_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/constants.h"
#include "core/base/parallel.h"

namespace pcl_symmetry {

namespace {

// Step of the logarithm of a distance. chosen: 16 %, as the points of a shape are apart; half misses pairs, twice finds
// twice as many that do not fit.
constexpr double kDistanceStep = 0.15;
// Angles between the first normal and the line of a pair, of any sign, and of the second normal and between both
// normals, without sign. chosen: 15 degrees a step, see kDistanceStep.
constexpr int kAngles = 12, kOtherAngles = 6;
// Radii of a shape below which pairs are left out. chosen: nearer than that the places of the points are too uncertain
// for a distance; twice misses pairs of small parts that are seen.
constexpr double kLeastDistance = 0.2;
// Turns about a normal that are told apart. chosen: 22.5 degrees; half mixes poses up, twice spreads their votes.
constexpr int kTurns = 16;
constexpr int kTurnBits = 8;                                // derived: a turn is stored in 1/256
constexpr std::uint32_t kTurnMask = (1u << kTurnBits) - 1;  // derived: see above
// Points of a scan that vote, each with all others. chosen: half misses poses, twice takes twice the time.
constexpr int kReferences = 30;
// Poses of one shape that a point of the scan votes for. chosen: half loses that of the true place among those that
// look alike, twice takes four times as long to compare them.
constexpr int kPosesOfPoint = 3;
// Poses that are one: radians, radii of the shape. chosen: a step of the turn; half splits the votes of a pose, twice
// joins different ones.
constexpr double kSameAngle = 0.4, kSamePlace = 0.15;
// Weight of a pair that as many points have as the mean of all, and greatest weight. chosen: weights fall with the root
// of their number; all weights alike give the votes to flat shapes.
constexpr double kMeanWeight = 8.0, kMostWeight = 64.0;
constexpr int kMostVotes = std::numeric_limits<std::int16_t>::max();  // derived: they are counted in 16 bits

int angleStep(double cosine, int num_steps, double range) {
  const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
  return std::min(num_steps - 1, static_cast<int>(angle / range * num_steps));
}

/// A point with its normal as a frame: the normal, and two directions across it.
Eigen::Matrix3d frameOf(const Eigen::Vector3d& normal) {
  Eigen::Matrix3d frame;
  frame.col(0) = normal;
  frame.col(1) = normal.unitOrthogonal();
  frame.col(2) = normal.cross(frame.col(1));
  return frame;
}

/// Two points with their normals.
struct Pair {
  double log_distance;       // in steps
  double angle;              // between the first normal and the line, in steps
  int other_angle, between;  // steps
  std::uint8_t turn;         // of the second point about the first normal, in 1/256
};

/// \param frame of the first point.
Pair pairOf(const Eigen::Matrix3d& frame, const Eigen::Vector3d& first, const Eigen::Vector3d& second,
            const Eigen::Vector3d& second_normal) {
  const Eigen::Vector3d line = second - first;
  const double distance = line.norm();
  const Eigen::Vector3d direction = frame.transpose() * line / distance;
  Pair pair;
  pair.log_distance = std::log(distance) / kDistanceStep;
  pair.angle = std::acos(std::clamp(direction.x(), -1.0, 1.0)) / kPi * kAngles;
  pair.other_angle = angleStep(std::abs(second_normal.dot(line)) / distance, kOtherAngles, 0.5 * kPi);
  pair.between = angleStep(std::abs(second_normal.dot(frame.col(0))), kOtherAngles, 0.5 * kPi);
  const double turn = std::atan2(direction.z(), direction.y()) / (2.0 * kPi);
  pair.turn = static_cast<std::uint8_t>(static_cast<int>(std::floor((turn + 1.0) * 256.0)) & 255);
  return pair;
}

double radiusOf(const Points& points) {
  return boundingBall(points).radius;
}

}  // namespace

int PointPairIndex::keyOf(int distance, int angle, int other_angle, int between) const {
  return (((distance - first_distance_) * kAngles + angle) * kOtherAngles + other_angle) * kOtherAngles + between;
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
    radii_.push_back(radiusOf(shapes[k].points));
    if (!(radii_.back() > 0.0)) continue;
    nearest = std::min(nearest, kLeastDistance * radii_.back());
    farthest = std::max(farthest, 2.1 * radii_.back());
  }
  if (!(farthest > 0.0)) return;
  first_distance_ = static_cast<int>(std::floor(std::log(nearest) / kDistanceStep));
  num_distances_ = static_cast<int>(std::floor(std::log(farthest) / kDistanceStep)) - first_distance_ + 1;
  fillKeys(num_threads);
}

/// The pairs of one shape, by key.
std::vector<PointPairIndex::KeyedPair> PointPairIndex::pairsOf(std::size_t shape) const {
  std::vector<KeyedPair> pairs;
  for (int i = begins_[shape]; i < begins_[shape + 1]; ++i) {
    const Eigen::Matrix3d frame = frameOf(normals_.col(i).cast<double>());
    const Eigen::Vector3d first = points_.col(i).cast<double>();
    for (int j = begins_[shape]; j < begins_[shape + 1]; ++j) {
      const Eigen::Vector3d second = points_.col(j).cast<double>();
      if (!((second - first).norm() > kLeastDistance * radii_[shape])) continue;
      const Pair pair = pairOf(frame, first, second, normals_.col(j).cast<double>());
      const int distance = static_cast<int>(std::floor(pair.log_distance)),
                angle = std::min(kAngles - 1, static_cast<int>(pair.angle));
      pairs.push_back({keyOf(distance, angle, pair.other_angle, pair.between), i, pair.turn});
    }
  }
  return pairs;
}

void PointPairIndex::fillKeys(int num_threads) {
  std::vector<std::vector<KeyedPair>> pairs(radii_.size());
  parallelBlocks(radii_.size(), num_threads, [&](std::size_t k) { pairs[k] = pairsOf(k); });
  const auto num_keys = static_cast<std::size_t>(num_distances_) * kAngles * kOtherAngles * kOtherAngles;
  std::vector<std::uint32_t> ends(num_keys, 0);
  for (const auto& of_shape : pairs)
    for (const KeyedPair& pair : of_shape) ++ends[static_cast<std::size_t>(pair.key)];
  key_begins_.assign(num_keys + 1, 0);
  double num_used = 1.0;
  for (std::size_t key = 0; key < num_keys; ++key) {
    num_used += ends[key] > 0 ? 1.0 : 0.0;
    key_begins_[key + 1] = key_begins_[key] + ends[key];
  }
  weights_.resize(num_keys);
  for (std::size_t key = 0; key < num_keys; ++key) {
    const double share = key_begins_.back() / num_used / std::max<std::uint32_t>(1, ends[key]);
    weights_[key] = static_cast<std::uint8_t>(std::clamp(kMeanWeight * std::sqrt(share), 1.0, kMostWeight));
    ends[key] = key_begins_[key];
  }
  pairs_.resize(key_begins_.back());
  for (const auto& of_shape : pairs) {
    for (const KeyedPair& pair : of_shape) {
      const std::uint32_t at = ends[static_cast<std::size_t>(pair.key)]++;
      pairs_[at] = static_cast<std::uint32_t>(pair.point) << kTurnBits | pair.turn;
    }
  }
}

/// Votes of one point of the scan: for each point of the shapes that it may be, and each turn about its normal.
void PointPairIndex::count(const SurfacePoints& scan, int reference, int sign, std::vector<std::int16_t>& votes) const {
  votes.assign(static_cast<std::size_t>(points_.cols()) * kTurns, 0);
  const Eigen::Matrix3d frame = frameOf(sign * scan.normals.col(reference).cast<double>().normalized());
  const Eigen::Vector3d first = scan.points.col(reference).cast<double>();
  for (Eigen::Index j = 0; j < scan.points.cols(); ++j) {
    const Eigen::Vector3d second = scan.points.col(j).cast<double>();
    if (j == reference || !((second - first).norm() > 0.0)) continue;
    const Pair pair = pairOf(frame, first, second, scan.normals.col(j).cast<double>());
    const int distance = static_cast<int>(std::floor(pair.log_distance - 0.5)),
              angle = static_cast<int>(std::floor(pair.angle - 0.5));
    for (int d = std::max(distance, first_distance_); d <= std::min(distance + 1, first_distance_ + num_distances_ - 1);
         ++d) {
      for (int a = std::max(0, angle); a <= std::min(angle + 1, kAngles - 1); ++a) {
        const auto key = static_cast<std::size_t>(keyOf(d, a, pair.other_angle, pair.between));
        const int weight = weights_[key];
        for (std::uint32_t at = key_begins_[key]; at < key_begins_[key + 1]; ++at) {
          const std::uint32_t point = pairs_[at] >> kTurnBits, turn = (pairs_[at] - pair.turn) & kTurnMask;
          std::int16_t& vote = votes[point * kTurns + turn / (256 / kTurns)];
          vote = static_cast<std::int16_t>(std::min(kMostVotes, vote + weight));
        }
      }
    }
  }
}

/// The poses of each shape that a point of the scan gave most votes.
void PointPairIndex::collect(const SurfacePoints& scan, int reference, int sign, const Eigen::Vector3d& center,
                             const std::vector<std::int16_t>& votes, std::vector<std::vector<Vote>>& poses) const {
  struct Peak {
    int weight, point, turn;
  };
  const Eigen::Matrix3d scan_frame = frameOf(sign * scan.normals.col(reference).cast<double>().normalized());
  const Eigen::Vector3d scan_point = scan.points.col(reference).cast<double>();
  for (std::size_t k = 0; k < radii_.size(); ++k) {
    std::array<Peak, kPosesOfPoint> best{};
    for (int i = begins_[k]; i < begins_[k + 1]; ++i) {
      const std::int16_t* of_point = votes.data() + static_cast<std::size_t>(i) * kTurns;
      std::int16_t most = 0;
      for (int t = 0; t < kTurns; ++t) most = std::max(most, of_point[t]);
      if (2 * most <= best.back().weight) continue;  // also with the next turn
      Peak peak{0, i, 0};
      for (int t = 0; t < kTurns; ++t) {
        const int weight = of_point[t] + of_point[(t + 1) % kTurns];
        if (weight > peak.weight) peak = {weight, i, t};
      }
      if (peak.weight <= best.back().weight) continue;
      best.back() = peak;
      std::sort(best.begin(), best.end(), [](const Peak& a, const Peak& b) { return a.weight > b.weight; });
    }
    for (const Peak& peak : best) {
      if (peak.weight == 0) continue;
      // The middle of the two steps of the turn.
      const double turn = 2.0 * kPi * (peak.turn + 1.0) / kTurns;
      const Eigen::Matrix3d R_shape_scan = frameOf(normals_.col(peak.point).cast<double>().normalized()) *
                                           Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitX()) * scan_frame.transpose();
      poses[k].push_back({Eigen::Quaterniond(R_shape_scan),
                          points_.col(peak.point).cast<double>() + R_shape_scan * (center - scan_point),
                          static_cast<double>(peak.weight)});
    }
  }
}

/// Joins votes for one pose.
ShapeOfPairs PointPairIndex::clustered(int shape, std::vector<Vote> votes, const Eigen::Vector3d& center,
                                       int num_poses) const {
  std::stable_sort(votes.begin(), votes.end(), [](const Vote& a, const Vote& b) { return a.weight > b.weight; });
  struct Cluster {
    Vote first;
    Eigen::Vector4d turn;
    Eigen::Vector3d place;
    double weight;
  };
  const double cosine = std::cos(0.5 * kSameAngle), distance = kSamePlace * radii_[static_cast<std::size_t>(shape)];
  std::vector<Cluster> clusters;
  for (const Vote& vote : votes) {
    const auto same = std::find_if(clusters.begin(), clusters.end(), [&](const Cluster& cluster) {
      return std::abs(cluster.first.turn.dot(vote.turn)) > cosine &&
             (cluster.first.place - vote.place).norm() < distance;
    });
    if (same == clusters.end()) {
      clusters.push_back({vote, vote.weight * vote.turn.coeffs(), vote.weight * vote.place, vote.weight});
      continue;
    }
    const double sign = same->first.turn.dot(vote.turn) < 0.0 ? -1.0 : 1.0;
    same->turn += sign * vote.weight * vote.turn.coeffs();
    same->place += vote.weight * vote.place;
    same->weight += vote.weight;
  }
  std::stable_sort(clusters.begin(), clusters.end(),
                   [](const Cluster& a, const Cluster& b) { return a.weight > b.weight; });
  ShapeOfPairs found{shape, clusters.empty() ? 0.0 : clusters.front().weight, {}};
  for (const Cluster& cluster : clusters) {
    if (found.T_shape_scan.size() == static_cast<std::size_t>(num_poses)) break;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = Eigen::Quaterniond(cluster.turn).normalized().toRotationMatrix();
    pose.translation() = cluster.place / cluster.weight - pose.linear() * center;
    found.T_shape_scan.push_back(pose);
  }
  return found;
}

std::vector<ShapeOfPairs> PointPairIndex::nearest(const SurfacePoints& scan, const PairSearchOptions& options) const {
  const Eigen::Vector3d center = centerOfMass(scan.points);
  const auto num_references = static_cast<std::size_t>(std::min<Eigen::Index>(kReferences, scan.points.cols()));
  // By point of the scan and sign of its normal: the poses of each shape.
  std::vector<std::vector<std::vector<Vote>>> poses(2 * num_references);
  parallelBlocks(poses.size(), options.num_threads, [&](std::size_t i) {
    std::vector<std::int16_t> votes;
    poses[i].resize(radii_.size());
    const int reference = static_cast<int>(i / 2), sign = i % 2 == 0 ? 1 : -1;
    count(scan, reference, sign, votes);
    collect(scan, reference, sign, center, votes, poses[i]);
  });
  std::vector<ShapeOfPairs> found(radii_.size());
  parallelBlocks(radii_.size(), options.num_threads, [&](std::size_t k) {
    std::vector<Vote> votes;
    for (const auto& of_point : poses) votes.insert(votes.end(), of_point[k].begin(), of_point[k].end());
    found[k] = clustered(static_cast<int>(k), std::move(votes), center, options.num_poses);
  });
  std::stable_sort(found.begin(), found.end(),
                   [](const ShapeOfPairs& a, const ShapeOfPairs& b) { return a.votes > b.votes; });
  found.resize(std::min(found.size(), static_cast<std::size_t>(options.num_nearest)));
  return found;
}

}  // namespace pcl_symmetry
