#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/constants.h"
#include "evaluate/shapes/shape_report.h"
#include "evaluate/shapes/swept_shape.h"
#include "evaluate/shared/table_text.h"

namespace pcl_symmetry::apps {

namespace {

// Degrees and diagonals within which an answer is right: the bar of this evaluation.
constexpr std::array<double, 2> kFoldAngles = {1.0, 5.0};  // derived: the limits that earlier figures were given for
constexpr double kFoldOffset = 0.01;                       // derived: see above
constexpr int kFoldCases = 144;  // chosen: half has intervals of 1.4 times the width, twice takes four minutes
enum FoldColumn : std::size_t { kRecall1, kPrecision1, kRecall5, kPrecision5, kSwallowed };

/// The true symmetries of a moved shape, and what answers are worth.
class FoldTruth {
public:
  FoldTruth(const SweptShape& shape, const Eigen::Isometry3d& pose, double max_angle)
      : shape_(shape),
        center_(pose * shape.center),
        axis_(pose * SweptShape::axis().origin(), pose.linear() * SweptShape::axis().direction()),
        max_angle_(max_angle * kDegree),
        max_offset_(kFoldOffset * shape.diagonal) {
    for (const ReflectionPlane& plane : shape.planes) planes_.push_back(plane.transformed(pose));
  }

  bool isAxis(const SymmetryAxis& axis) const {
    return right(difference(axis_, {axis.point, axis.direction}, center_));
  }
  bool throughAxis(const ReflectionPlane& plane) const { return right(difference(plane, axis_, center_)); }
  bool isPlane(const ReflectionPlane& plane) const {
    return std::any_of(planes_.begin(), planes_.end(), [&](const auto& other) { return same(plane, other); });
  }
  bool same(const ReflectionPlane& a, const ReflectionPlane& b) const { return right(difference(a, b, center_)); }
  const std::vector<ReflectionPlane>& planes() const { return planes_; }
  bool holds(const ReflectionPlane& plane) const { return std::abs(plane.normal().dot(axis_.direction())) < 0.5; }

private:
  bool right(const Difference& d) const { return d.within(max_angle_, max_offset_); }

  const SweptShape& shape_;
  Eigen::Vector3d center_;
  Line3d axis_;
  double max_angle_, max_offset_;
  std::vector<ReflectionPlane> planes_;
};

/// Counts for one cloud at one limit.
struct FoldCounts {
  Proportion recall, precision;
  bool swallowed = false;  ///< an axis in place of folds that are no axis
};

FoldCounts countsOf(const SweptShape& shape, const FoldTruth& truth, const ShapeAnswers& answers) {
  FoldCounts counts;
  const std::vector<SymmetryPlane> planes = answers.symmetries();
  bool has_axis = false;
  for (const SymmetryAxis& axis : answers.axes) {
    const bool right = truth.isAxis(axis);
    if (right && shape.isNearlyRound()) has_axis = true;
    if (right && !shape.isNearlyRound()) counts.swallowed = true;
    if (!right || shape.isRound() || !shape.isNearlyRound()) counts.precision.add(right && shape.isRound());
  }
  for (std::size_t i = 0; i < answers.centers.size(); ++i) counts.precision.add(false);
  for (const SymmetryPlane& plane : planes) {
    const bool through = truth.throughAxis(plane), right = truth.isPlane(plane) || (through && shape.isRound());
    if (right || !through || !shape.isNearlyRound()) counts.precision.add(right);
  }
  if (shape.num_folds == 0) counts.recall.add(has_axis);
  for (const ReflectionPlane& plane : truth.planes()) {
    const bool found = std::any_of(planes.begin(), planes.end(), [&](const auto& p) { return truth.same(p, plane); });
    counts.recall.add(found || (has_axis && truth.holds(plane)));
  }
  return counts;
}

std::string foldRange(int num_folds) {
  return num_folds == 0    ? "round"
         : num_folds <= 6  ? "2 to 6 folds"
         : num_folds <= 12 ? "7 to 12 folds"
                           : "13 to 24 folds";
}

std::string logLine(const FoldedCloud& what, const ShapeAnswers& answers, const FoldCounts& strict,
                    const FoldCounts& loose) {
  const SweptShape& shape = what.shape;
  Row row;
  row.add(what.body).add(double(shape.num_folds)).add(double(what.noise)).add(what.thinned ? "thinned" : "even");
  row.add(shape.between);
  for (const Proportion& p : {strict.recall, strict.precision, loose.recall, loose.precision})
    row.add(double(p.count)).add(double(p.total));
  row.add(double(answers.axes.size())).add(double(answers.centers.size())).add(double(answers.planes.size()));
  row.add(double(answers.symmetries().size()));
  return row.end();
}

void measureFold(int i, const ShapeRowOptions& options, ShapeReport& report) {
  const FoldedCloud what = foldedCloud(i, options.caseSeed(i), options.report, options.num_points);
  const SweptShape& shape = what.shape;
  const ShapeAnswers answers = detectShape(what.cloud, detectionOptions(options));
  std::array<FoldCounts, 2> counts;
  for (std::size_t k = 0; k < counts.size(); ++k)
    counts[k] = countsOf(shape, FoldTruth(shape, what.pose, kFoldAngles[k]), answers);
  std::vector<std::string> rows{"noise " + std::to_string(what.noise), foldRange(shape.num_folds), what.body, "all"};
  if (what.thinned) rows.emplace_back("thinned");
  for (const std::string& row : rows) {
    report.at(row, kRecall1) += counts[0].recall;
    report.at(row, kPrecision1) += counts[0].precision;
    report.at(row, kRecall5) += counts[1].recall;
    report.at(row, kPrecision5) += counts[1].precision;
    if (!shape.isNearlyRound()) report.at(row, kSwallowed).add(counts[1].swallowed);
  }
  report.log(logLine(what, answers, counts[0], counts[1]));
}

}  // namespace

ShapeCases foldCases(const ShapeRowOptions& options) {
  ShapeCases cases{
      ShapeReport({"recall, 1 deg", "precision, 1 deg", "recall, 5 deg", "precision, 5 deg", "axis swallows folds"}),
      options.count(kFoldCases), [&options](int i, ShapeReport& report) { measureFold(i, options, report); }};
  cases.report.log(
      "body,folds,noise,density,between,found1,of1,right1,answers1,found5,of5,right5,answers5,axes,centers,planes,"
      "symmetries");
  return cases;
}

}  // namespace pcl_symmetry::apps
