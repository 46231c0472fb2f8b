#include "evaluate/planes/plane_matching.h"
#include "core/base/constants.h"

#include <algorithm>
#include <cmath>

namespace pcl_symmetry::apps {

namespace {

/// Planes through one line that make an axis. chosen: a prism of eight sides is within 4 % of a circle; half calls a
/// cube round, twice no prism.
constexpr std::size_t kRoundPrism = 8;

/// The closest of a kind of references within the limits.
struct Match {
  std::size_t index;
  Difference error;  ///< radians and diagonals
};

class Matcher {
public:
  Matcher(const ReferenceSymmetries& references, const MatchLimits& limits)
      : references_(references), limits_(limits) {}

  /// \return what the answer is right about, numbered in planes, then axes, then centers: at most one reference, or all
  /// planes of a prism around an axis.
  std::vector<Match> findReferences(const Answer& answer) const {
    const std::size_t num_planes = references_.planes.size(), num_axes = references_.axes.size();
    if (const auto match = closestPlane(answer, references_.planes)) return {*match};
    if (const auto match = closestAxis(answer, references_.axes)) return {{num_planes + match->index, match->error}};
    if (const auto match = closestCenter(answer)) return {{num_planes + num_axes + match->index, match->error}};
    return planesAround(answer);
  }

  bool isNear(const Answer& answer) const {
    return closestPlane(answer, references_.near_planes) || closestAxis(answer, references_.near_axes);
  }

private:
  /// \return the reference planes that an axis stands for: where only few meet, it is wrong, and they are none.
  std::vector<Match> planesAround(const Answer& answer) const {
    std::vector<Match> around;
    if (answer.type != Answer::Type::Axis) return around;
    for (std::size_t i = 0; i < references_.planes.size(); ++i) {
      const Difference error = scaled(difference(references_.planes[i].plane, answer.axis, references_.center));
      if (error.within(limits_.max_axis_angle * kDegree, limits_.max_offset)) around.push_back({i, error});
    }
    if (around.size() < kRoundPrism) around.clear();
    return around;
  }

  Difference scaled(const Difference& d) const { return {d.angle, d.offset / references_.diagonal}; }

  template <typename References, typename DifferenceTo>
  std::optional<Match> closest(const References& references, double max_angle,
                               const DifferenceTo& difference_to) const {
    std::optional<Match> best;
    double least = 1.0;
    for (std::size_t i = 0; i < references.size(); ++i) {
      const Difference error = scaled(difference_to(references[i]));
      const double badness = std::max(error.angle / (max_angle * kDegree), error.offset / limits_.max_offset);
      if (!(badness <= least)) continue;
      least = badness;
      best = Match{i, error};
    }
    return best;
  }

  std::optional<Match> closestPlane(const Answer& answer, const std::vector<ReferencePlane>& planes) const {
    if (answer.type != Answer::Type::Plane) return std::nullopt;
    return closest(planes, limits_.max_angle, [&](const ReferencePlane& reference) {
      return difference(reference.plane, answer.plane, references_.center);
    });
  }

  std::optional<Match> closestAxis(const Answer& answer, const std::vector<ReferenceAxis>& axes) const {
    const auto line = [](const ReferenceAxis& axis) { return Line3d(axis.point, axis.direction); };
    if (answer.type == Answer::Type::Plane) {
      return closest(axes, limits_.max_angle, [&](const ReferenceAxis& reference) {
        return difference(answer.plane, line(reference), references_.center);
      });
    }
    if (answer.type == Answer::Type::Axis) {
      return closest(axes, limits_.max_axis_angle, [&](const ReferenceAxis& reference) {
        return difference(line(reference), answer.axis, references_.center);
      });
    }
    return std::nullopt;
  }

  std::optional<Match> closestCenter(const Answer& answer) const {
    return closest(references_.centers, 1.0, [&](const ReferenceCenter& reference) {
      switch (answer.type) {
        case Answer::Type::Plane:
          return Difference{0.0, std::abs(answer.plane.signedDistance(reference.point))};
        case Answer::Type::Axis:
          return Difference{0.0, answer.axis.distance(reference.point)};
        default:
          return Difference{0.0, (answer.point - reference.point).norm()};
      }
    });
  }

  const ReferenceSymmetries& references_;
  const MatchLimits& limits_;
};

}  // namespace

Answer Answer::ofPlane(const ReflectionPlane& plane, double score) {
  Answer answer;
  answer.plane = plane;
  answer.score = score;
  return answer;
}

Answer Answer::ofAxis(const Eigen::Vector3d& point, const Eigen::Vector3d& direction, double score) {
  Answer answer;
  answer.type = Type::Axis;
  answer.axis = Line3d(point, direction.normalized());
  answer.score = score;
  return answer;
}

Answer Answer::ofCenter(const Eigen::Vector3d& point, double score) {
  Answer answer;
  answer.type = Type::Center;
  answer.point = point;
  answer.score = score;
  return answer;
}

MatchResult matchAnswers(const std::vector<Answer>& answers, const ReferenceSymmetries& references,
                         const MatchLimits& limits) {
  const Matcher matcher(references, limits);
  MatchResult result;
  const std::size_t num_planes = references.planes.size(), num_axes = references.axes.size();
  result.num_references = static_cast<int>(num_planes + num_axes + references.centers.size());
  std::vector<bool> found(static_cast<std::size_t>(result.num_references));
  std::vector<bool> in_family = found;  // found together with others: further answers there are not wrong
  std::vector<bool> axis_found = found;
  int rank = 0;
  for (const Answer& answer : answers) {
    Judgement judgement;
    const std::vector<Match> matches = matcher.findReferences(answer);
    judgement.at_reference = !matches.empty();
    bool repeats_family = false;
    for (const Match& match : matches) {
      const bool is_axis =
          answer.type == Answer::Type::Axis && match.index >= num_planes && match.index < num_planes + num_axes;
      if (is_axis && !result.first_axis_error) result.first_axis_error = match.error;
      result.num_axes_found += is_axis && !axis_found[match.index] ? 1 : 0;
      judgement.num_found += found[match.index] ? 0 : 1;
      judgement.error.angle = std::max(judgement.error.angle, match.error.angle);
      judgement.error.offset = std::max(judgement.error.offset, match.error.offset);
      repeats_family = repeats_family || in_family[match.index];
      found[match.index] = true;
      in_family[match.index] = in_family[match.index] || match.index >= num_planes || matches.size() > 1;
      axis_found[match.index] = axis_found[match.index] || is_axis;
    }
    if (judgement.num_found > 0) {
      judgement.verdict = Verdict::Right;
    } else if (repeats_family || (matches.empty() && matcher.isNear(answer))) {
      judgement.verdict = Verdict::Neutral;
    }
    result.num_right += judgement.verdict == Verdict::Right ? 1 : 0;
    result.num_neutral += judgement.verdict == Verdict::Neutral ? 1 : 0;
    result.num_false += judgement.verdict == Verdict::False ? 1 : 0;
    if (judgement.verdict != Verdict::Neutral) ++rank;
    if (judgement.verdict == Verdict::Right && !result.rank) {
      result.rank = rank;
      result.first_error = judgement.error;
    }
    result.judgements.push_back(judgement);
  }
  result.num_found = static_cast<int>(std::count(found.begin(), found.end(), true));
  return result;
}

}  // namespace pcl_symmetry::apps
