#include "plane_matching.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace pcl_symmetry::apps {

namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr int kRoundPrism = 8;  // planes through one line

/// The closest of a kind of references within the limits.
struct Match {
  std::size_t index;
  Difference error;  ///< radians and diagonals
};

class Matcher {
public:
  Matcher(const ReferenceSymmetries& references, const MatchLimits& limits)
      : references_(references), limits_(limits) {}

  /// \return the reference in planes, then axes, then centers, counted through; none if the answer is not right.
  std::optional<Match> findReference(const Answer& answer) const {
    std::size_t first = 0;
    if (const auto match = closestPlane(answer, references_.planes)) return match;
    first += references_.planes.size();
    if (const auto match = closestAxis(answer, references_.axes)) return Match{first + match->index, match->error};
    first += references_.axes.size();
    if (const auto match = closestCenter(answer)) return Match{first + match->index, match->error};
    return std::nullopt;
  }

  bool isNear(const Answer& answer) const {
    return closestPlane(answer, references_.near_planes) || closestAxis(answer, references_.near_axes) ||
           isAxisOfRoundPrism(answer);
  }

private:
  Difference scaled(const Difference& difference) const {
    return {difference.angle, difference.offset / references_.diagonal};
  }

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

  bool isAxisOfRoundPrism(const Answer& answer) const {
    if (answer.type != Answer::Type::Axis) return false;
    return std::count_if(references_.planes.begin(), references_.planes.end(), [&](const ReferencePlane& reference) {
             return scaled(difference(reference.plane, answer.axis, references_.center))
                 .within(limits_.max_axis_angle * kDegree, limits_.max_offset);
           }) >= kRoundPrism;
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
  const std::size_t num_planes = references.planes.size();
  result.num_references = static_cast<int>(num_planes + references.axes.size() + references.centers.size());
  std::vector<bool> found(static_cast<std::size_t>(result.num_references));
  std::vector<bool> found_by_axis(references.axes.size());
  int rank = 0;
  for (const Answer& answer : answers) {
    Judgement judgement;
    if (const auto match = matcher.findReference(answer)) {
      const bool in_family = match->index >= num_planes;
      judgement.verdict = !found[match->index] ? Verdict::Right : in_family ? Verdict::Neutral : Verdict::False;
      judgement.error = match->error;
      found[match->index] = true;
      if (answer.type == Answer::Type::Axis && in_family && match->index - num_planes < references.axes.size()) {
        found_by_axis[match->index - num_planes] = true;
        if (!result.first_axis_error) result.first_axis_error = match->error;
      }
    } else if (matcher.isNear(answer)) {
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
  result.num_axes_found = static_cast<int>(std::count(found_by_axis.begin(), found_by_axis.end(), true));
  return result;
}

}  // namespace pcl_symmetry::apps
