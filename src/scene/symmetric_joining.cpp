#include "scene/symmetric_joining.h"

#include <pcl/features/normal_3d.h>
#include <pcl/kdtree/kdtree_flann.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "core/base/symmetric_solvers.h"
#include "core/geometry/cloud_extent.h"
#include "scene/scene_rules.h"

namespace pcl_symmetry::detail {

namespace {

using Cloud = SymmetryScene::Cloud;

Eigen::Vector3d positionOf(const Cloud& scene, pcl::index_t i) {
  return scene[i].getVector3fMap().cast<double>();
}

/// Indices of both objects, ascending.
pcl::Indices indicesOf(const SceneObject& a, const SceneObject& b) {
  pcl::Indices all;
  std::merge(a.indices.begin(), a.indices.end(), b.indices.begin(), b.indices.end(), std::back_inserter(all));
  return all;
}

std::vector<ReflectionPlane> planesThrough(const SymmetryAxis& axis) {
  std::vector<ReflectionPlane> planes;
  for (int k = 0; k < kScene.planes_of_axis; ++k)
    planes.push_back(planeThrough({axis.point, axis.direction}, kPi * k / kScene.planes_of_axis));
  return planes;
}

/// The planes of symmetry of an object; for a body of revolution, some of those through its axis.
std::vector<ReflectionPlane> planesOf(const SceneObject& object) {
  if (!object.axes.empty()) return planesThrough(object.axes.front());
  std::vector<ReflectionPlane> planes;
  for (const SymmetryPlane& plane : object.planes)
    if (plane.kind == PlaneKind::Symmetry) planes.push_back(plane);
  return planes;
}

/// Numbers of points that a reflection maps to different places.
struct Landings {
  double own = 0.0, other = 0.0;  ///< onto the piece itself, and onto the other piece
  double off = 0.0;               ///< into free space
  double all = 0.0;               ///< all points, including those mapped into unknown space

  double known() const { return own + other + off; }
  bool isInformative() const { return known() >= kScene.informative * all; }
  double share() const { return known() > 0.0 ? (own + other) / known() : 0.0; }
};

/// Two pieces that may be one object.
class Pair {
public:
  Pair(const JoiningScene& scene, const SceneObject& larger, const SceneObject& smaller)
      : scene_(scene), pieces_{&larger, &smaller}, indices_(indicesOf(larger, smaller)), reflected_(reflectedOf()) {
    tree_.setInputCloud(scene.frame, pcl::make_shared<pcl::Indices>(indices_));
    seen_ = scene.seen_of(indices_);
    const Points points = pointsOf(*scene.frame, indices_);
    diagonal_ = boxDiagonal(points);
    center_ = points.rowwise().mean().cast<double>();
    double tolerance = std::max(scene.distances.spacing, scene.tolerance * diagonal_);
    if (seen_.visibility()) tolerance = std::max(tolerance, seen_.visibility()->resolvedTolerance(points));
    reach_ = 2.0 * tolerance;
  }

  /// Whether one symmetry may explain both pieces, judged by the pieces alone.
  bool isPlausible() const {
    const SceneObject &larger = *pieces_[0], &smaller = *pieces_[1];
    if (larger.axes.empty()) return false;
    return hangs() || (!smaller.axes.empty() && isSame(larger.axes.front(), smaller.axes.front()));
  }

  /// Whether the pieces are two bodies: their own symmetries explain them, and neither is a face or a part of a wall.
  bool isCutBySymmetry(double share_apart) const {
    return share_apart >= kScene.own && !isFlat(*pieces_[0]) && !isFlat(*pieces_[1]);
  }

  const pcl::Indices& indices() const { return indices_; }

  /// Share of the points of both pieces whose normals point to one upright line; nothing unless the pieces stand side
  /// by side and belong to one body of revolution. Noise pulls the line too far toward the points for reflections to
  /// fit.
  std::optional<double> roundShare() const {
    if (scene_.supports.empty()) return std::nullopt;
    const SupportingPlane& support = nearestSupport();
    const std::array<double, 2> heights[] = {heightsOf(support, *pieces_[0]), heightsOf(support, *pieces_[1])};
    const double beside = std::min(heights[0][1], heights[1][1]) - std::max(heights[0][0], heights[1][0]);
    if (beside < kScene.beside * std::min(heights[0][1] - heights[0][0], heights[1][1] - heights[1][0]))
      return std::nullopt;
    const Eigen::Vector3d up = support.coefficients.head<3>();
    const std::vector<Wall> walls = wallsOf(up);
    Eigen::Vector3d at = center_;
    for (int round = 0; round < kScene.axis_rounds; ++round) {
      Eigen::Matrix3d a = up * up.transpose();  // keeps the height unchanged
      Eigen::Vector3d b = a * center_;
      for (const Wall& wall : walls) {
        const double off = wall.aside.dot(wall.point - at) / (kScene.misses * diagonal_);
        const double weight = round == 0 ? 1.0 : 1.0 / (1.0 + off * off);
        a += weight * wall.aside * wall.aside.transpose();
        b += weight * wall.aside.dot(wall.point) * wall.aside;
      }
      at = solveSymmetric(a, b);
      if (!at.allFinite() || (at - center_).norm() > diagonal_) return std::nullopt;
    }
    std::array<double, 2> num_walls{}, num_round{};
    for (const Wall& wall : walls) {
      Eigen::Vector3d inwards = at - wall.point;
      inwards -= up * up.dot(inwards);
      num_walls[wall.piece] += 1.0;
      num_round[wall.piece] +=
          std::abs(wall.aside.dot(inwards)) <= std::sin(kScene.points_to) * inwards.norm() ? 1.0 : 0.0;
    }
    for (std::size_t k = 0; k < 2; ++k)
      if (num_walls[k] < kScene.walls * static_cast<double>(reflected_[k].size()) ||
          num_round[k] < kScene.round_share * num_walls[k])
        return std::nullopt;
    return shareOfBoth(num_round[0] / num_walls[0], num_round[1] / num_walls[1]);
  }

  /// Whether a symmetry of the union explains each piece, and keeps the axis of the larger one or a plane through it.
  bool areOne(const SceneObject& together) const {
    const SymmetryAxis& axis = pieces_[0]->axes.front();
    if (!together.axes.empty() && !isSame(axis, together.axes.front())) return false;
    const std::vector<ReflectionPlane> planes = planesOf(together);
    return std::any_of(planes.begin(), planes.end(), [&](const auto& plane) { return contains(plane, axis); }) &&
           explains(planes, !together.axes.empty());
  }

  /// Share of the points that the best symmetry explains: of the union if it is known, otherwise of a piece.
  double shareTogether(const SceneObject* together) const {
    std::vector<ReflectionPlane> planes;
    for (const SceneObject* object : {together, pieces_[0], pieces_[1]})
      if (object)
        for (const ReflectionPlane& plane : planesOf(*object)) planes.push_back(plane);
    if (const auto through = throughAxisOfLarger()) planes.push_back(*through);
    double best = 0.0;
    for (const ReflectionPlane& plane : planes) {
      const Landings a = landings(0, plane), b = landings(1, plane);
      if (a.isInformative() && b.isInformative()) best = std::max(best, shareOfBoth(a.share(), b.share()));
    }
    return best;
  }

  /// Share of the points that are explained by a symmetry of their own piece.
  double shareApart() const {
    std::array<double, 2> shares{};
    for (int k = 0; k < 2; ++k)
      for (const ReflectionPlane& plane : planesOf(*pieces_[k])) {
        const Landings own = landings(k, plane);
        if (own.known() > 0.0) shares[k] = std::max(shares[k], own.own / own.known());
      }
    return shareOfBoth(shares[0], shares[1]);
  }

private:
  std::array<pcl::Indices, 2> reflectedOf() const {
    std::array<pcl::Indices, 2> some;
    for (int k = 0; k < 2; ++k) {
      const pcl::Indices& all = pieces_[k]->indices;
      const std::size_t stride = 1 + (all.size() - 1) / kScene.reflected;
      for (std::size_t i = 0; i < all.size(); i += stride) some[k].push_back(all[i]);
    }
    return some;
  }

  double shareOfBoth(double of_larger, double of_smaller) const {
    const auto a = static_cast<double>(pieces_[0]->indices.size()), b = static_cast<double>(pieces_[1]->indices.size());
    return (a * of_larger + b * of_smaller) / (a + b);
  }

  Landings landings(int piece, const ReflectionPlane& plane) const {
    Landings result;
    pcl::Indices closest(1);
    std::vector<float> sq_distance(1);
    for (const pcl::index_t i : reflected_[piece]) {
      const Eigen::Vector3d x = positionOf(*scene_.frame, i);
      if (2.0 * std::abs(plane.signedDistance(x)) <= reach_) continue;  // points that stay in place are uninformative
      result.all += 1.0;
      pcl::PointXYZ at;
      at.getVector3fMap() = plane.reflect(x).cast<float>();
      tree_.nearestKSearch(at, 1, closest, sq_distance);
      if (sq_distance[0] <= reach_ * reach_)
        (isOf(piece, closest[0]) ? result.own : result.other) += 1.0;
      else if (!seen_.visibility() || seen_.visibility()->depthBehind(plane.reflect(x)) < -reach_)
        result.off += 1.0;
    }
    return result;
  }

  bool isOf(int piece, pcl::index_t i) const {
    const pcl::Indices& points = pieces_[piece]->indices;
    return std::binary_search(points.begin(), points.end(), i);
  }

  /// Whether no piece contradicts these planes, and each piece has an informative one among them. Unless they are
  /// planes of an axis, that one is a symmetry of the piece by itself.
  bool explains(const std::vector<ReflectionPlane>& planes, bool of_axis) const {
    std::array<bool, 2> is_explained{};
    for (const ReflectionPlane& plane : planes)
      for (int k = 0; k < 2; ++k) {
        const Landings all = landings(k, plane);
        if (!all.isInformative()) continue;
        if (all.share() < kScene.explained) return false;
        is_explained[k] = is_explained[k] || of_axis || all.own >= kScene.explained * (all.own + all.other);
      }
    return is_explained[0] && is_explained[1];
  }

  /// A point of a piece with a normal that is not upright.
  struct Wall {
    int piece;
    Eigen::Vector3d point, aside;  // aside: level, perpendicular to the normal
  };

  std::vector<Wall> wallsOf(const Eigen::Vector3d& up) const {
    std::vector<Wall> walls;
    pcl::Indices around;
    std::vector<float> sq_distances;
    for (int k = 0; k < 2; ++k)
      for (const pcl::index_t i : reflected_[k]) {
        Eigen::Vector4f normal;
        float curvature = 0.0f;
        if (tree_.radiusSearch((*scene_.frame)[i], kScene.normal_spacings * scene_.distances.spacing, around,
                               sq_distances) < 3 ||
            !pcl::computePointNormal(*scene_.frame, around, normal, curvature))
          continue;
        const Eigen::Vector3d aside = up.cross(normal.head<3>().cast<double>());
        if (aside.norm() >= kScene.level) walls.push_back({k, positionOf(*scene_.frame, i), aside.normalized()});
      }
    return walls;
  }

  /// The point of an axis that is closest to the center of both pieces.
  Eigen::Vector3d middleOf(const SymmetryAxis& axis) const {
    return axis.point + axis.direction.dot(center_ - axis.point) * axis.direction;
  }

  bool isSame(const SymmetryAxis& a, const SymmetryAxis& b) const {
    return std::abs(a.direction.dot(b.direction)) >= std::cos(kScene.same_angle) &&
           (middleOf(a) - middleOf(b)).norm() <= kScene.same_offset * diagonal_;
  }

  bool contains(const ReflectionPlane& plane, const SymmetryAxis& axis) const {
    return std::abs(plane.normal().dot(axis.direction)) <= std::sin(kScene.same_angle) &&
           std::abs(plane.signedDistance(middleOf(axis))) <= kScene.same_offset * diagonal_;
  }

  /// The plane through the axis of the larger piece and through the smaller piece.
  std::optional<ReflectionPlane> throughAxisOfLarger() const {
    if (pieces_[0]->axes.empty()) return std::nullopt;
    const SymmetryAxis& axis = pieces_[0]->axes.front();
    const Eigen::Vector3d normal =
        axis.direction.cross(centerOfMass(pointsOf(*scene_.frame, pieces_[1]->indices)) - axis.point);
    if (!(normal.norm() > 0.0)) return std::nullopt;
    return ReflectionPlane(normal, normal.dot(axis.point));
  }

  bool isFlat(const SceneObject& piece) const {
    const Eigen::Vector3d variances = principalAxes(pointsOf(*scene_.frame, piece.indices)).variances;
    return variances[2] < std::pow(kScene.flat, 2) * variances[0];
  }

  /// The support that is closest to a piece.
  const SupportingPlane& nearestSupport() const {
    const auto foot = [&](const SupportingPlane& support) {
      return std::min(footOf(support, *pieces_[0]), footOf(support, *pieces_[1]));
    };
    return *std::min_element(scene_.supports.begin(), scene_.supports.end(),
                             [&](const auto& a, const auto& b) { return foot(a) < foot(b); });
  }

  /// Whether the smaller piece does not stand on what the larger one stands on.
  bool hangs() const {
    if (scene_.supports.empty()) return true;
    const SupportingPlane& support = nearestSupport();
    return footOf(support, *pieces_[1]) - footOf(support, *pieces_[0]) >
           std::max(2.0 * scene_.distances.plane, kScene.hangs * diagonal_);
  }

  /// Heights of the foot and the top of a piece, without flying pixels.
  std::array<double, 2> heightsOf(const SupportingPlane& support, const SceneObject& piece) const {
    std::vector<double> heights;
    for (const pcl::index_t i : piece.indices) heights.push_back(heightOver(support.coefficients, (*scene_.frame)[i]));
    const auto num_cut = static_cast<std::size_t>(kScene.trimmed * static_cast<double>(heights.size()));
    const auto [foot, top] = trimmedExtent(std::move(heights), num_cut);
    return {foot, top};
  }

  double footOf(const SupportingPlane& support, const SceneObject& piece) const { return heightsOf(support, piece)[0]; }

  const JoiningScene& scene_;
  std::array<const SceneObject*, 2> pieces_;  // the larger one first
  pcl::Indices indices_;                      // indices of both pieces
  std::array<pcl::Indices, 2> reflected_;
  pcl::KdTreeFLANN<pcl::PointXYZ> tree_{false};
  SeenSpace seen_;
  double diagonal_ = 0.0, reach_ = 0.0;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
};

bool touch(const JoiningScene& scene, const SceneObject& larger, const SceneObject& smaller) {
  const std::vector<float> sq_distances =
      sqDistancesFrom(pointsOf(*scene.frame, larger.indices), pointsOf(*scene.frame, smaller.indices));
  return *std::min_element(sq_distances.begin(), sq_distances.end()) <= std::pow(scene.distances.cluster, 2);
}

/// The decision on a pair.
struct Verdict {
  bool are_one = false;
  std::optional<SceneObject> object;  // the union, if it was analyzed
  double together = 0.0, apart = 0.0;
};

/// Pieces: which of them were united, and which pairs touch.
class Joining {
public:
  using PiecePair = std::pair<std::size_t, std::size_t>;  // the larger one first

  Joining(const JoiningScene& scene, const std::vector<pcl::Indices>& pieces, const std::vector<int>& cluster_of)
      : scene_(scene), objects_(pieces.size()), owners_(pieces.size()) {
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      objects_[i].indices = pieces[i];
      owners_[i] = i;
    }
    for (std::size_t i = 0; i < pieces.size(); ++i)
      for (std::size_t j = i + 1; j < pieces.size(); ++j)
        if (cluster_of[i] == cluster_of[j] && touch(scene, objects_[i], objects_[j])) pairs_[larger(i, j)] = {};
  }

  void analyzeAll() {
    std::set<std::size_t> left;
    for (std::size_t i = 0; i < objects_.size(); ++i)
      if (owners_[i] == i) left.insert(i);
    analyze(left);
  }

  /// Unites pairs until decide(pair, number of pairs) unites none.
  /// \param report whether these pairs are reported as junctions.
  /// \param again whether united pieces are analyzed again.
  template <typename Decide>
  void unite(const Decide& decide, bool report, bool again) {
    std::vector<PiecePair> asked;
    for (const auto& [pair, shares] : pairs_) asked.push_back(pair);
    while (!asked.empty()) {
      std::vector<Verdict> verdicts(asked.size());
      parallelBlocks(asked.size(), scene_.num_threads, [&](std::size_t k) {
        verdicts[k] = decide(Pair(scene_, objects_[asked[k].first], objects_[asked[k].second]), asked.size());
      });
      std::set<std::size_t> changed, unknown;
      for (std::size_t k = 0; k < asked.size(); ++k) {
        Verdict& verdict = verdicts[k];
        pairs_[asked[k]] = {verdict.together, verdict.apart};
        const std::size_t to = owner(asked[k].first), from = owner(asked[k].second);
        // Analyses are valid for unchanged pieces; other pairs are analyzed again.
        const bool is_stale = verdict.object && (changed.count(to) || changed.count(from));
        if (!verdict.are_one || to == from || is_stale) continue;
        if (report) junctions_.push_back(junctionOf(asked[k]));
        if (verdict.object) {
          objects_[to] = std::move(*verdict.object);
        } else {
          objects_[to].indices = indicesOf(objects_[to], objects_[from]);
          unknown.insert(to);
        }
        unknown.erase(from);
        owners_[from] = to;
        changed.insert({to, from});
      }
      if (again) analyze(unknown);
      asked.clear();
      std::map<PiecePair, std::array<double, 2>> left;
      for (const auto& [pair, shares] : pairs_) {
        const std::size_t i = owner(pair.first), j = owner(pair.second);
        if (i != j && left.emplace(larger(i, j), shares).second && (changed.count(i) || changed.count(j)))
          asked.push_back(larger(i, j));
      }
      pairs_ = std::move(left);
    }
  }

  /// Keeps objects separate that models explain, if no model explains their union.
  /// \return whether there are any.
  bool separateNamed(Joining& united) {
    std::map<std::size_t, std::vector<std::size_t>> parts;
    for (std::size_t i = 0; i < objects_.size(); ++i)
      if (owners_[i] == i) parts[united.owner(i)].push_back(i);
    std::set<std::size_t> named;
    for (const auto& [object, of_object] : parts) {
      if (of_object.size() < 2 || scene_.is_named(united.objects_[object])) continue;
      for (const std::size_t i : of_object)
        if (scene_.is_named(objects_[i])) named.insert(i);
    }
    for (auto pair = pairs_.begin(); pair != pairs_.end();) {
      const bool stays = !named.count(pair->first.first) && !named.count(pair->first.second);
      if (!stays) junctions_.push_back(junctionOf(pair->first));
      pair = stays ? std::next(pair) : pairs_.erase(pair);
    }
    return !named.empty();
  }

  JoinedPieces result() && {
    std::vector<std::size_t> order, numbers(objects_.size());
    for (std::size_t i = 0; i < objects_.size(); ++i)
      if (owners_[i] == i) order.push_back(i);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return objects_[a].indices.size() > objects_[b].indices.size();
    });
    JoinedPieces result;
    for (const auto& [pair, shares] : pairs_) junctions_.push_back(junctionOf(pair));
    for (const std::size_t i : order) {
      numbers[i] = result.objects.size();
      result.objects.push_back(std::move(objects_[i]));
    }
    for (SceneJunction& junction : junctions_) {
      junction.first = numbers[owner(junction.first)];
      junction.second = numbers[owner(junction.second)];
    }
    result.junctions = std::move(junctions_);
    return result;
  }

private:
  std::size_t owner(std::size_t i) const {
    while (owners_[i] != i) i = owners_[i];
    return i;
  }

  void analyze(const std::set<std::size_t>& objects) {
    const std::vector<std::size_t> all(objects.begin(), objects.end());
    parallelBlocks(all.size(), scene_.num_threads,
                   [&](std::size_t k) { objects_[all[k]] = scene_.analyze(objects_[all[k]].indices, all.size()); });
  }

  PiecePair larger(std::size_t i, std::size_t j) const {
    return objects_[i].indices.size() >= objects_[j].indices.size() ? PiecePair(i, j) : PiecePair(j, i);
  }

  SceneJunction junctionOf(const PiecePair& pair) const {
    const auto& [i, j] = pair;
    const auto& [together, apart] = pairs_.at(pair);
    return {i, j, {objects_[i].indices.size(), objects_[j].indices.size()}, together, apart};
  }

  const JoiningScene& scene_;
  std::vector<SceneObject> objects_;
  std::vector<std::size_t> owners_;                   // for each piece, the one that it was united with
  std::map<PiecePair, std::array<double, 2>> pairs_;  // pairs that touch: shares together and apart
  std::vector<SceneJunction> junctions_;              // junctions of pieces that symmetry joined
};

}  // namespace

JoinedPieces joinBySymmetry(const JoiningScene& scene, const std::vector<pcl::Indices>& pieces,
                            const std::vector<int>& cluster_of) {
  Joining joining(scene, pieces, cluster_of);
  const auto are_round = [](const Pair& pair, std::size_t) {
    const std::optional<double> share = pair.roundShare();
    return Verdict{share.has_value(), std::nullopt, share.value_or(0.0), 0.0};
  };
  const auto are_one = [&](const Pair& pair, std::size_t num_pairs) {
    if (!pair.isPlausible()) return Verdict();
    Verdict verdict{false, scene.analyze(pair.indices(), num_pairs), 0.0, pair.shareApart()};
    verdict.are_one = pair.areOne(*verdict.object);
    verdict.together = pair.shareTogether(&*verdict.object);
    return verdict;
  };
  const auto are_not_cut = [](const Pair& pair, std::size_t) {
    const double apart = pair.shareApart();
    return Verdict{!pair.isCutBySymmetry(apart), std::nullopt, pair.shareTogether(nullptr), apart};
  };
  joining.unite(are_round, true, false);
  joining.analyzeAll();
  joining.unite(are_one, true, true);
  Joining apart = joining;
  joining.unite(are_not_cut, false, true);
  if (!scene.is_named || !apart.separateNamed(joining)) return std::move(joining).result();
  apart.unite(are_not_cut, false, true);
  return std::move(apart).result();
}

}  // namespace pcl_symmetry::detail
