#include "pcl_symmetry/register_all.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/base/small_motion.h"
#include "core/base/statistics.h"
#include "core/base/stopwatch.h"
#include "core/geometry/point_samples.h"
#include "core/registration/pose_evidence.h"
#include "core/registration/posed_surface.h"
#include "core/registration/registration_rules.h"
#include "registration/pose_graph.h"

namespace pcl_symmetry {

namespace {

struct RegisterAllRules {
  /// Greatest number of points of each scan, and of scans together, that are registered.
  std::size_t max_points = 10'000;
  int enough_pairs = 3;  ///< number of agreeing pairs of a scan after which no more are tried
  SamePose same{6.0 * kDegree, 0.08};
  /// Merit at which a pair that did not converge begins to count, and at which it counts half as much as one that did.
  /// Of pairs of real scans, many right ones and no wrong one are above the first.
  double min_merit = -0.1, good_merit = 0.4;
  double min_uniqueness = 0.6;  ///< least uniqueness of a pose that counts
  double min_votes = 0.6;       ///< least number of votes that join scans: more than one pair that did not converge
  // Adjustment of all poses together
  int adjust_points = 2000;      ///< points of each scan
  int adjust_steps = 16;         ///< steps over which the reach decreases
  double first_reach = 0.06;     ///< distance within which points correspond at first, radii
  double last_accuracies = 2.0;  ///< the same at the end, in distances that the scans resolve
  double min_cosine = 0.7;       ///< least cosine between the normals of corresponding points
  double min_overlap = 0.03;     ///< least share of the points that correspond
  /// Radians and radii: neighborhood in which a scan must fit the others.
  double around_angle = 15.0 * kDegree, around_distance = 0.2;
};
constexpr RegisterAllRules kRegisterAll{};

Points drawn(const Points& points, std::uint64_t seed) {
  if (points.cols() <= static_cast<Eigen::Index>(kRegisterAll.max_points)) return points;
  Points few(3, kRegisterAll.max_points);
  Eigen::Index i = 0;
  for (const std::size_t k :
       detail::drawOneOfEachRun(static_cast<std::size_t>(points.cols()), kRegisterAll.max_points, seed))
    few.col(i++) = points.col(k);
  return few;
}

/// For each cell of a grid, the point nearest to the mean of its points; in the order of the cells.
std::vector<int> onePerCell(const Points& points, double edge) {
  const Eigen::Vector3d corner = points.rowwise().minCoeff().cast<double>();
  std::vector<std::pair<std::array<std::int64_t, 3>, int>> cells;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d cell = ((points.col(i).cast<double>() - corner) / edge).array().floor();
    cells.push_back({{static_cast<std::int64_t>(cell.x()), static_cast<std::int64_t>(cell.y()),
                      static_cast<std::int64_t>(cell.z())},
                     static_cast<int>(i)});
  }
  checkCancelled();
  std::sort(cells.begin(), cells.end());
  checkCancelled();
  std::vector<int> chosen;
  for (auto first = cells.begin(), last = first; first != cells.end(); first = last) {
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    for (; last != cells.end() && last->first == first->first; ++last) mean += points.col(last->second);
    mean /= static_cast<float>(last - first);
    chosen.push_back(std::min_element(first, last, [&](const auto& a, const auto& b) {
                       return (points.col(a.second) - mean).squaredNorm() < (points.col(b.second) - mean).squaredNorm();
                     })->second);
  }
  return chosen;
}

/// A scan about its own center, in units that all scans share.
struct NormalizedScan {
  ObjectScan scan;
  double spacing_ratio = 1.0;  ///< spacing of all points of the scan divided by the spacing of the points here
  std::shared_ptr<const PosedSurface> surface;
  std::shared_ptr<const PreparedCloud> target;
};

/// Registers the scans that hold enough points.
class ScanGraph {
public:
  ScanGraph(const std::vector<ObjectScan>& scans, const std::vector<int>& usable,
            const CloudRegistrationOptions& options)
      : options_(options), num_threads_(options.num_threads) {
    options_.around.reset();
    options_.num_threads = 1;
    std::vector<double> radii;
    for (const int k : usable) {
      balls_.push_back(boundingBall(withoutStrayPoints(scans[k].points)));
      radii.push_back(balls_.back().radius);
    }
    unit_ = median(radii);
    if (options_.max_correspondence) *options_.max_correspondence /= unit_;
    scans_.resize(usable.size());
    parallelBlocks(usable.size(), num_threads_, [&](std::size_t i) {
      const ObjectScan& input = scans[usable[i]];
      NormalizedScan& scan = scans_[i];
      scan.scan.points =
          normalizePoints(drawn(withoutStrayPoints(input.points), options_.seed), balls_[i].center, unit_);
      if (input.seen) scan.scan.seen = input.seen->normalized(balls_[i].center, unit_);
      scan.spacing_ratio =
          std::sqrt(static_cast<double>(scan.scan.points.cols()) / static_cast<double>(input.points.cols()));
      scan.surface = std::make_shared<const PosedSurface>(scan.scan.points, scan.scan.seen, options_.seed, 1);
      scan.target = registrationTarget(scan.scan.points, scan.scan.seen, options_);
    });
  }

  int size() const { return static_cast<int>(scans_.size()); }
  const std::vector<PairAnswer>& answers() const { return answers_; }
  const ScanGroups& groups() const { return groups_; }
  bool agrees(const PairAnswer& answer) const { return groups_.agrees(answer, kRegisterAll.same); }

  /// Registers pairs of scans that are a number of steps apart in their order, for increasing numbers, until all are
  /// connected.
  void registerPairs() {
    groups_ = joinScans(size(), {}, kRegisterAll.same, kRegisterAll.min_votes);
    for (int step = 1; 2 * step <= size(); ++step) {
      std::vector<int> num_pairs(size());
      for (const PairAnswer& answer : answers_) {
        num_pairs[answer.source] += agrees(answer);
        num_pairs[answer.target] += agrees(answer);
      }
      std::set<std::pair<int, int>> pairs;
      for (int i = 0; i < size(); ++i) {
        const int j = (i + step) % size();
        const bool settled = groups_.group[i] == groups_.group[j] && num_pairs[i] >= kRegisterAll.enough_pairs &&
                             num_pairs[j] >= kRegisterAll.enough_pairs;
        if (!settled) pairs.insert(std::minmax({i, j}));
      }
      const std::vector<std::pair<int, int>> order(pairs.begin(), pairs.end());
      std::vector<PairAnswer> found(order.size());
      parallelBlocks(order.size(), num_threads_,
                     [&](std::size_t k) { found[k] = registered(order[k].first, order[k].second); });
      answers_.insert(answers_.end(), found.begin(), found.end());
      groups_ = joinScans(size(), answers_, kRegisterAll.same, kRegisterAll.min_votes);
    }
  }

  /// \return the group with most scans; of several, the first one.
  int largestGroup() const {
    std::vector<int> sizes(2 * size());
    for (const int group : groups_.group) ++sizes[group];
    int best = groups_.group.front();
    for (const int group : groups_.group)
      if (sizes[group] > sizes[best]) best = group;
    return best;
  }

  /// Tries to add scans outside the largest group by registering them to all scans in it.
  void addToLargest() {
    for (bool grown = true; grown;) {
      grown = false;
      const int largest = largestGroup();
      if (std::count(groups_.group.begin(), groups_.group.end(), largest) < 2) return;
      const auto whole = registrationTarget(together(largest, -1), std::nullopt, options_);
      for (int k = 0; k < size(); ++k) {
        if (groups_.group[k] == largest) continue;
        const CloudRegistration found =
            registerClouds(scans_[k].scan.points, scans_[k].scan.seen, *whole, Eigen::Isometry3d::Identity(), options_);
        if (!found.converged() || found.evidence.uniqueness < kRegisterAll.min_uniqueness) continue;
        groups_.group[k] = largest;
        groups_.T_group_scan[k] = found.T_target_source;
        grown = true;
      }
    }
  }

  /// Moves all scans so that their surfaces coincide.
  void adjust() {
    double last_reach = 0.0;
    for (const NormalizedScan& scan : scans_)
      last_reach = std::max(last_reach, kRegisterAll.last_accuracies * scan.surface->accuracy);
    last_reach = std::min(last_reach, kRegisterAll.first_reach);
    std::vector<std::pair<int, int>> pairs;
    for (int i = 0; i < size(); ++i)
      for (int j = 0; j < size(); ++j)
        if (i != j && groups_.group[i] == groups_.group[j]) pairs.emplace_back(i, j);
    for (int step = 0; step < kRegisterAll.adjust_steps; ++step) {
      const double reach = kRegisterAll.first_reach *
                           std::pow(last_reach / kRegisterAll.first_reach, step / (kRegisterAll.adjust_steps - 1.0));
      std::vector<std::optional<PoseConstraint>> found(pairs.size());
      parallelBlocks(pairs.size(), num_threads_,
                     [&](std::size_t k) { found[k] = meeting(pairs[k].first, pairs[k].second, reach); });
      std::vector<PoseConstraint> constraints;
      std::vector<std::pair<int, int>> overlapping;
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        if (!found[k]) continue;
        constraints.push_back(*found[k]);
        overlapping.push_back(pairs[k]);
      }
      pairs = std::move(overlapping);
      adjustPoses(constraints, groups_.T_group_scan, 1);
    }
  }

  /// Registers each scan that fewer than two converged pairs connect with the largest group to all others of that
  /// group, around its current pose; scans that do not fit are removed.
  void settleLoose() {
    const int largest = largestGroup();
    std::vector<int> num_pairs(size());
    for (const PairAnswer& answer : answers_) {
      num_pairs[answer.source] += answer.converged && agrees(answer);
      num_pairs[answer.target] += answer.converged && agrees(answer);
    }
    CloudRegistrationOptions near = options_;
    near.around = PoseNeighborhood{kRegisterAll.around_angle, kRegisterAll.around_distance};
    for (int k = 0; k < size(); ++k) {
      if (num_pairs[k] > 1 || groups_.group[k] != largest ||
          std::count(groups_.group.begin(), groups_.group.end(), largest) < 3)
        continue;
      const CloudRegistration found = registerClouds(scans_[k].scan.points, scans_[k].scan.seen, together(largest, k),
                                                     std::nullopt, groups_.T_group_scan[k], near);
      if (found.converged())
        groups_.T_group_scan[k] = found.T_target_source;
      else if (num_pairs[k] == 0)
        groups_.group[k] = size() + k;
    }
  }

  /// Removes scans from a group, the least certain first, until each remaining one lies on the points of the others and
  /// outside their free space.
  /// \param[in,out] confidences for each scan of the group, the probability that its pose is right, in [0, 1]; for a
  /// removed scan, as it was then.
  void takeOutDoubtful(int group, std::vector<double>& confidences) {
    std::vector<int> kept;
    for (int k = 0; k < size(); ++k)
      if (groups_.group[k] == group) kept.push_back(k);
    Eigen::MatrixXd contradicted = Eigen::MatrixXd::Zero(size(), size());
    parallelBlocks(kept.size() * kept.size(), num_threads_, [&](std::size_t e) {
      const int i = kept[e / kept.size()], j = kept[e % kept.size()];
      if (i < j) contradicted(i, j) = evidence(i, *scans_[j].surface, groups_.T_group_scan[j]).contradicted;
    });
    contradicted += contradicted.transpose().eval();
    while (kept.size() > 1) {
      parallelBlocks(kept.size(), num_threads_, [&](std::size_t e) {
        const int k = kept[e];
        const PosedSurface others(together(group, k), std::nullopt, options_.seed, 1);
        PoseEvidence found = evidence(k, others, Eigen::Isometry3d::Identity());
        for (const int j : kept) found.contradicted = std::max(found.contradicted, contradicted(k, j));
        confidences[k] = poseConfidence(found);
      });
      const auto less_sure = [&](int a, int b) { return confidences[a] < confidences[b]; };
      const auto worst = std::min_element(kept.begin(), kept.end(), less_sure);
      if (confidences[*worst] >= kRegistration.min_confidence) return;
      groups_.group[*worst] = size() + *worst;
      kept.erase(worst);
    }
    confidences[kept.front()] = 1.0;
  }

  /// Share of the points of one scan that lie on another one.
  double overlap(int source, int target) const {
    const PosedSurface &from = *scans_[source].surface, &to = *scans_[target].surface;
    const double reach = kRegisterAll.last_accuracies * std::max(from.accuracy, to.accuracy);
    const Matched matched = match(source, target, reach);
    return static_cast<double>(matched.pairs.size()) / static_cast<double>(matched.num_points);
  }

  /// Distance that all points of the scans of a group resolve, input units.
  double resolution(int group) const {
    std::vector<double> resolved;
    for (int k = 0; k < size(); ++k) {
      if (groups_.group[k] != group) continue;
      const NormalizedScan& scan = scans_[k];
      const double spacing = scan.surface->accuracy - 2.0 * scan.surface->noise;
      resolved.push_back(unit_ * (spacing * scan.spacing_ratio + 2.0 * scan.surface->noise));
    }
    return median(resolved);
  }

  /// T_first_scan of a scan, between input frames.
  Eigen::Isometry3d pose(int scan, int first) const {
    Eigen::Isometry3d pose = groups_.T_group_scan[first].inverse() * groups_.T_group_scan[scan];
    pose.translation() = unit_ * pose.translation() + balls_[first].center - pose.linear() * balls_[scan].center;
    return pose;
  }

private:
  struct Matched {
    /// Points in the target's frame, with indices of those of the target.
    std::vector<std::pair<Eigen::Vector3d, int>> pairs;
    int num_points;
  };

  PairAnswer registered(int target, int source) const {
    const CloudRegistration found = registerClouds(scans_[source].scan.points, scans_[source].scan.seen,
                                                   *scans_[target].target, Eigen::Isometry3d::Identity(), options_);
    PairAnswer answer{source, target, found.T_target_source, Matrix6d::Identity()};
    if (!found.covariance) return answer;
    answer.covariance = *found.covariance;
    answer.converged = found.converged();
    const double doubtful =
        (found.score.merit() - kRegisterAll.min_merit) / (kRegisterAll.good_merit - kRegisterAll.min_merit);
    answer.weight = answer.converged ? 1.0 : 0.5 * std::clamp(doubtful, 0.0, 1.0);
    // For a nearly round body, all pairs may agree on the pose in which its views look alike.
    if (found.evidence.uniqueness < kRegisterAll.min_uniqueness) answer.weight = 0.0;
    return answer;
  }

  /// Evidence for the pose of a scan on a surface.
  PoseEvidence evidence(int scan, const PosedSurface& of, const Eigen::Isometry3d& T_group_of) const {
    return poseEvidence(*scans_[scan].surface, of, T_group_of.inverse() * groups_.T_group_scan[scan]);
  }

  Matched match(int source, int target, double reach) const {
    const PosedSurface &from = *scans_[source].surface, &to = *scans_[target].surface;
    const Landing landing = land(from, to, groups_.T_group_scan[target].inverse() * groups_.T_group_scan[source],
                                 kRegisterAll.adjust_points);
    Matched matched{{}, static_cast<int>(landing.images.cols())};
    for (int i = 0; i < matched.num_points; ++i) {
      const int j = landing.closest[i];
      if (landing.sq_distances[i] > reach * reach ||
          std::abs(landing.normals.col(i).dot(to.normals.col(j))) < kRegisterAll.min_cosine)
        continue;
      matched.pairs.emplace_back(landing.images.col(i).cast<double>(), j);
    }
    return matched;
  }

  /// The pose near the current one in which the surfaces of two scans coincide (point to plane).
  std::optional<PoseConstraint> meeting(int source, int target, double reach) const {
    const Matched matched = match(source, target, reach);
    if (static_cast<double>(matched.pairs.size()) < kRegisterAll.min_overlap * matched.num_points) return std::nullopt;
    const PosedSurface& to = *scans_[target].surface;
    Matrix6d hessian = Matrix6d::Zero();
    Vector6d gradient = Vector6d::Zero();
    double sum_squares = 0.0;
    for (const auto& [x, j] : matched.pairs) {
      const Eigen::Vector3d n = to.normals.col(j).cast<double>();
      const double distance = n.dot(x - to.points.col(j).cast<double>());
      Vector6d row;
      row << x.cross(n), n;
      hessian += row * row.transpose();
      gradient += distance * row;
      sum_squares += distance * distance;
    }
    constexpr double min_stiffness = 1e-4, longest = 0.1;
    const Eigen::Isometry3d T_target_source = groups_.T_group_scan[target].inverse() * groups_.T_group_scan[source];
    const double variance = sum_squares / static_cast<double>(matched.pairs.size()) + 0.01 * to.accuracy * to.accuracy;
    return PoseConstraint{source, target,
                          motionBy(smallMotion({hessian, gradient}, min_stiffness, longest)) * T_target_source,
                          hessian / variance};
  }

  /// The points of a group, except those of one scan.
  Points together(int group, int without) const {
    std::vector<Points> moved;
    Eigen::Index total = 0;
    double edge = 0.0;
    for (int k = 0; k < size(); ++k) {
      if (groups_.group[k] != group || k == without) continue;
      moved.push_back(groups_.T_group_scan[k].cast<float>() * scans_[k].scan.points);
      total += moved.back().cols();
      edge = std::max(edge, scans_[k].surface->accuracy);
    }
    Points all(3, total);
    total = 0;
    for (const Points& points : moved) {
      all.middleCols(total, points.cols()) = points;
      total += points.cols();
    }
    return drawn(pointsAt(all, onePerCell(all, edge)), options_.seed);
  }

  CloudRegistrationOptions options_;
  int num_threads_;
  double unit_ = 1.0;  // input units
  std::vector<BoundingBall> balls_;
  std::vector<NormalizedScan> scans_;
  std::vector<PairAnswer> answers_;
  ScanGroups groups_;
};

}  // namespace

RegisteredScans registerAll(const std::vector<ObjectScan>& scans, const CloudRegistrationOptions& options) {
  options.validate();
  RegisteredScans result;
  result.scans.resize(scans.size());
  StageTimes done(result.timing_ms);
  std::vector<int> usable;
  for (std::size_t k = 0; k < scans.size(); ++k) {
    result.scans[k].left_out = detail::reasonForNoAnswer(scans[k].points, "scan", kLeastRegistrationPoints);
    if (result.scans[k].left_out.empty()) usable.push_back(static_cast<int>(k));
  }
  if (usable.empty()) return result;
  ScanGraph graph(scans, usable, options);
  done("prepare");
  graph.registerPairs();
  done("pairs");
  graph.adjust();
  graph.addToLargest();
  graph.settleLoose();
  graph.adjust();
  done("adjust");
  std::vector<double> confidences(usable.size());
  int group = -1;
  while (group != graph.largestGroup()) {
    group = graph.largestGroup();
    graph.takeOutDoubtful(group, confidences);
  }
  int first = 0;
  while (graph.groups().group[first] != group) ++first;
  for (int k = 0; k < graph.size(); ++k) {
    ScanPose& scan = result.scans[usable[k]];
    if (graph.groups().group[k] == group) {
      scan.T_first_scan = graph.pose(k, first);
      scan.confidence = confidences[k];
      continue;
    }
    const bool contradicts = std::any_of(graph.answers().begin(), graph.answers().end(), [&](const PairAnswer& a) {
      return a.converged && ((a.source == k && graph.groups().group[a.target] == group) ||
                             (a.target == k && graph.groups().group[a.source] == group));
    });
    const bool is_doubtful = confidences[k] > 0.0 && confidences[k] < kRegistration.min_confidence;
    scan.left_out = is_doubtful   ? "its confidence among the others is below 0.5"
                    : contradicts ? "its pairs contradict each other"
                                  : "it fits no other scan that is kept";
  }
  for (const PairAnswer& answer : graph.answers()) {
    const bool kept = graph.groups().group[answer.source] == group && graph.groups().group[answer.target] == group;
    const bool used = kept && answer.weight > 0.0 && graph.agrees(answer);
    if (!used && !answer.converged) continue;
    result.pairs.push_back(
        {usable[answer.source], usable[answer.target], kept ? graph.overlap(answer.source, answer.target) : 0.0, used});
  }
  result.resolution = graph.resolution(group);
  done("report");
  return result;
}

std::vector<ScanPoint> RegisteredScans::mergedPoints(const std::vector<ObjectScan>& input) const {
  std::vector<ScanPoint> points;
  Eigen::Index total = 0;
  for (std::size_t k = 0; k < input.size(); ++k)
    if (scans[k].left_out.empty()) total += input[k].points.cols();
  Points all(3, total);
  for (std::size_t k = 0; k < input.size(); ++k) {
    if (!scans[k].left_out.empty()) continue;
    checkCancelled();
    all.middleCols(points.size(), input[k].points.cols()) = scans[k].T_first_scan.cast<float>() * input[k].points;
    for (Eigen::Index i = 0; i < input[k].points.cols(); ++i)
      points.push_back({static_cast<int>(k), static_cast<int>(i)});
  }
  if (!(resolution > 0.0)) return points;
  std::vector<ScanPoint> kept;
  for (const int i : onePerCell(all, resolution)) kept.push_back(points[i]);
  return kept;
}

}  // namespace pcl_symmetry
