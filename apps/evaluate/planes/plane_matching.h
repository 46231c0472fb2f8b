/// Compares the answers of a detector with the reference symmetries of the model.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "evaluate/references/reference_symmetries.h"
#include "evaluate/shared/plane_difference.h"

namespace pcl_symmetry::apps {

/// One symmetry that a detector reports: a plane, an axis of revolution, or the center of a sphere.
struct Answer {
  enum class Type { Center, Axis, Plane };
  Type type = Type::Plane;
  ReflectionPlane plane;                                           ///< of a plane
  Line3d axis{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};  ///< of an axis
  Eigen::Vector3d point = Eigen::Vector3d::Zero();                 ///< of a center
  double score = 0.0;                                              ///< larger is surer, comparable between clouds
  bool rank_only = false;  ///< the score says the order alone: it is no probability
  bool called = true;      ///< a symmetry; others are listed as what may be one

  static Answer ofPlane(const ReflectionPlane& plane, double score);
  static Answer ofAxis(const Eigen::Vector3d& point, const Eigen::Vector3d& direction, double score);
  static Answer ofCenter(const Eigen::Vector3d& point, double score);
};

/// An answer is right within these.
struct MatchLimits {
  double max_angle = 3.0;       ///< degrees, of planes
  double max_axis_angle = 1.0;  ///< degrees, of axes
  double max_offset = 0.02;     ///< diagonals of the model's bounding box, measured at its center
};

enum class Verdict {
  Right,    ///< finds a reference that no better answer found
  Neutral,  ///< a near symmetry, or one more plane of a family that was found before
  False     ///< also a second answer for the same plane
};

struct Judgement {
  Verdict verdict = Verdict::False;
  bool at_reference = false;  ///< also where a better answer found it: what is said of the plane is true
  int num_found = 0;          ///< references that no better answer found
  Difference error;           ///< where it matches a reference: radians and diagonals
};

/// What a detector decides: an answer that it calls a symmetry, with at least this score, says "symmetric".
struct OperatingPoint {
  double min_confidence = 0.5;

  bool calls(const Answer& answer) const {
    return answer.called && (answer.rank_only || answer.score >= min_confidence);
  }
};

struct MatchResult {
  std::vector<Judgement> judgements;  ///< one per answer, in their order
  int num_right = 0, num_neutral = 0, num_false = 0;
  int num_references = 0;                      ///< planes, axes and centers
  int num_found = 0;                           ///< of them
  int num_axes_found = 0;                      ///< by axes, not by planes through them
  std::optional<int> rank;                     ///< from 1, of the first right answer among those that are not neutral
  std::optional<Difference> first_error;       ///< of that answer
  std::optional<Difference> first_axis_error;  ///< of the first right axis
};

/// \param answers best first.
/// \param references in the frame of the answers.
///
/// A plane is right at a reference plane, through a reference axis and through a reference center; an axis at a
/// reference axis and through a reference center. Where eight or more reference planes meet in a line, an axis there is
/// right too and finds them all: a prism that is round but for its corners.
MatchResult matchAnswers(const std::vector<Answer>& answers, const ReferenceSymmetries& references,
                         const MatchLimits& limits = {});

}  // namespace pcl_symmetry::apps
