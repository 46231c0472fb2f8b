#include <gtest/gtest.h>

#include <cmath>

#include "core/base/constants.h"
#include "evaluate/planes/plane_matching.h"
#include "evaluate/planes/plane_statistics.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

/// Normal tilted from x towards y.
ReflectionPlane tilted(double degrees, double offset) {
  return {Eigen::Vector3d(std::cos(degrees * kDegree), std::sin(degrees * kDegree), 0.0), offset};
}

/// A shape of diagonal 10 at (100, 0, 0), where offsets are measured.
ReferenceSymmetries onePlane() {
  ReferenceSymmetries references;
  references.kind = SymmetryKind::Symmetric;
  references.center = {100.0, 0.0, 0.0};
  references.diagonal = 10.0;
  references.planes = {{tilted(0.0, 100.0), 1.0}};
  return references;
}

ReferenceSymmetries oneAxis() {
  ReferenceSymmetries references = onePlane();
  references.planes.clear();
  references.axes = {{{100.0, 0.0, 7.0}, Eigen::Vector3d::UnitZ(), 1.0}};
  return references;
}

std::vector<Verdict> verdictsOf(const std::vector<Answer>& answers, const ReferenceSymmetries& references) {
  std::vector<Verdict> verdicts;
  for (const Judgement& judgement : matchAnswers(answers, references).judgements) verdicts.push_back(judgement.verdict);
  return verdicts;
}

/// The tilted plane through (100 + offset, 0, 0).
ReflectionPlane through(double degrees, double offset) {
  return tilted(degrees, (100.0 + offset) * std::cos(degrees * kDegree));
}

TEST(PlaneDifference, IsMeasuredAtTheCenterAndForBothSigns) {
  const Eigen::Vector3d center(100.0, 0.0, 0.0);
  const ReflectionPlane a = through(0.0, 0.0), b = through(2.0, 0.1);
  const ReflectionPlane flipped(-b.normal(), -b.offset());
  for (const ReflectionPlane& other : {b, flipped}) {
    const Difference d = difference(a, other, center);
    EXPECT_NEAR(d.angle, 2.0 * kDegree, 1e-9);
    EXPECT_NEAR(d.offset, 0.1 * std::cos(2.0 * kDegree), 1e-9);
  }
}

TEST(PlaneDifference, OfLines) {
  const Line3d z(Eigen::Vector3d(1.0, 2.0, 50.0), Eigen::Vector3d::UnitZ());
  const Line3d turned(Eigen::Vector3d(1.0, 2.5, 0.0), Eigen::Vector3d(std::sin(0.1), 0.0, -std::cos(0.1)));
  const Difference lines = difference(z, turned, Eigen::Vector3d(1.0, 2.5, 0.0));
  EXPECT_NEAR(lines.angle, 0.1, 1e-9);
  EXPECT_NEAR(lines.offset, 0.5, 1e-9);
  const Difference plane = difference(ReflectionPlane(Eigen::Vector3d::UnitX(), 0.7), z, Eigen::Vector3d::Zero());
  EXPECT_NEAR(plane.angle, 0.0, 1e-9);
  EXPECT_NEAR(plane.offset, 0.3, 1e-9);
}

TEST(PlaneMatching, LimitsAreThreeDegreesAndTwoPerCent) {
  const auto verdict = [](double degrees, double offset) {
    return verdictsOf({Answer::ofPlane(through(degrees, offset), 1.0)}, onePlane()).front();
  };
  EXPECT_EQ(verdict(2.99, 0.0), Verdict::Right);
  EXPECT_EQ(verdict(3.01, 0.0), Verdict::False);
  EXPECT_EQ(verdict(0.0, 0.199), Verdict::Right) << "diagonal 10";
  EXPECT_EQ(verdict(0.0, -0.201), Verdict::False);
}

TEST(PlaneMatching, ASecondAnswerForAPlaneIsFalseAndANearOneNeutral) {
  ReferenceSymmetries references = onePlane();
  references.near_planes = {{{Eigen::Vector3d::UnitY(), 0.0}, 0.95}};
  const std::vector<Answer> answers = {
      Answer::ofPlane({Eigen::Vector3d::UnitY(), 0.05}, 1.0), Answer::ofPlane({Eigen::Vector3d::UnitZ(), 0.0}, 0.9),
      Answer::ofPlane(through(1.0, 0.0), 0.8), Answer::ofPlane(through(0.0, 0.0), 0.7)};
  EXPECT_EQ(verdictsOf(answers, references),
            (std::vector<Verdict>{Verdict::Neutral, Verdict::False, Verdict::Right, Verdict::False}));
  const MatchResult match = matchAnswers(answers, references);
  EXPECT_EQ(match.rank, 2) << "neutral answers are not counted";
  EXPECT_EQ(match.num_found, 1);
  EXPECT_NEAR(match.first_error->angle, 1.0 * kDegree, 1e-9);
}

TEST(PlaneMatching, EveryPlaneThroughAnAxisIsRightOnce) {
  const std::vector<Answer> planes = {Answer::ofPlane(through(0.0, 0.0), 1.0), Answer::ofPlane(through(40.0, 0.1), 0.9),
                                      Answer::ofPlane({Eigen::Vector3d::UnitZ(), 0.0}, 0.8)};
  EXPECT_EQ(verdictsOf(planes, oneAxis()), (std::vector<Verdict>{Verdict::Right, Verdict::Neutral, Verdict::False}));
  const MatchResult match = matchAnswers(planes, oneAxis());
  EXPECT_EQ(match.num_found, 1);
  EXPECT_EQ(match.num_axes_found, 0);

  const auto axis = [](double degrees) {
    return Answer::ofAxis({100.0, 0.1, -5.0}, {std::sin(degrees * kDegree), 0.0, std::cos(degrees * kDegree)}, 1.0);
  };
  EXPECT_EQ(matchAnswers({axis(0.4)}, oneAxis()).num_axes_found, 1);
  EXPECT_NEAR(matchAnswers({axis(0.0)}, oneAxis()).first_axis_error->offset, 0.01, 1e-9) << "of the diagonal";
  EXPECT_EQ(verdictsOf({axis(1.1)}, oneAxis()).front(), Verdict::False);
  EXPECT_EQ(verdictsOf({axis(0.0)}, onePlane()).front(), Verdict::False);
}

TEST(PlaneMatching, ASphereHasEveryPlaneAndAxisThroughItsCenter) {
  ReferenceSymmetries sphere = oneAxis();
  sphere.axes.clear();
  sphere.centers = {{sphere.center, 1.0}};
  EXPECT_EQ(verdictsOf({Answer::ofCenter({100.1, 0.0, 0.0}, 1.0)}, sphere).front(), Verdict::Right);
  EXPECT_EQ(verdictsOf({Answer::ofCenter({100.3, 0.0, 0.0}, 1.0)}, sphere).front(), Verdict::False);
  EXPECT_EQ(verdictsOf({Answer::ofPlane(through(70.0, 0.0), 1.0)}, sphere).front(), Verdict::Right);
  EXPECT_EQ(verdictsOf({Answer::ofAxis({100.0, 0.0, 3.0}, {0.0, 0.0, 1.0}, 1.0)}, sphere).front(), Verdict::Right);
}

TEST(PlaneMatching, AnAxisStandsForThePlanesOfAPrismOfManyCorners) {
  for (const int num_planes : {4, 12}) {
    ReferenceSymmetries prism = onePlane();
    prism.planes.clear();
    for (int k = 0; k < num_planes; ++k) prism.planes.push_back({through(180.0 * k / num_planes, 0.0), 1.0});
    const std::vector<Answer> answers = {Answer::ofAxis({100.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 1.0),
                                         Answer::ofPlane(through(0.0, 0.0), 1.0)};
    const MatchResult match = matchAnswers(answers, prism);
    EXPECT_EQ(match.num_found, num_planes == 12 ? 12 : 1);
    EXPECT_EQ(match.judgements[0].verdict, num_planes == 12 ? Verdict::Right : Verdict::False);
    EXPECT_EQ(match.judgements[1].verdict, num_planes == 12 ? Verdict::Neutral : Verdict::Right);
    EXPECT_EQ(match.num_axes_found, 0) << "no axis among the references";
  }
}

CloudResult cloudResult(const std::vector<Answer>& answers, const ReferenceSymmetries& references) {
  CloudResult result;
  result.kind = references.kind;
  result.answers.answers = answers;
  result.match = matchAnswers(answers, references);
  return result;
}

TEST(PlaneStatistics, CountsSymmetricAndAsymmetricCloudsApart) {
  ReferenceSymmetries none, nearly;
  nearly.kind = SymmetryKind::NearlySymmetric;
  const Answer right = Answer::ofPlane(through(1.0, 0.0), 0.9), wrong = Answer::ofPlane(through(50.0, 0.0), 0.5);
  const std::vector<CloudResult> results = {cloudResult({right}, onePlane()),
                                            cloudResult({wrong, right}, onePlane()),
                                            cloudResult({}, onePlane()),
                                            cloudResult({wrong}, onePlane()),
                                            cloudResult({}, none),
                                            cloudResult({wrong}, none),
                                            cloudResult({wrong, wrong, wrong}, nearly)};
  CloudResults pointers;
  for (const CloudResult& result : results) pointers.push_back(&result);
  const PlaneStatistics s = summarize(pointers);
  EXPECT_EQ(s.num_symmetric, 4);
  EXPECT_EQ(s.num_asymmetric, 2);
  EXPECT_EQ(s.num_nearly, 1);
  EXPECT_DOUBLE_EQ(s.first_rate, 0.25);
  EXPECT_DOUBLE_EQ(s.five_rate, 0.5);
  EXPECT_DOUBLE_EQ(s.no_answer_rate, 0.25);
  EXPECT_DOUBLE_EQ(s.recall, 0.5);
  EXPECT_DOUBLE_EQ(s.decisions.false_per_cloud, 0.5);
  EXPECT_EQ(s.decisions.decided_right.count, 1);
  EXPECT_EQ(s.decisions.decided_right.total, 4);
  EXPECT_DOUBLE_EQ(s.decisions.asymmetric_called.rate(), 0.5);
  EXPECT_DOUBLE_EQ(s.decisions.nearly_called.rate(), 1.0);
  EXPECT_NEAR(s.median_angle, 1.0, 1e-9);

  // Both right answers come first, then three wrong ones of equal score: those on the nearly symmetric cloud are none.
  const std::vector<PrecisionRecall> curve = precisionRecall(pointers);
  ASSERT_EQ(curve.size(), 2u);
  EXPECT_DOUBLE_EQ(curve[0].precision, 1.0);
  EXPECT_DOUBLE_EQ(curve[0].recall, 0.5);
  EXPECT_DOUBLE_EQ(curve[1].precision, 0.4);
  EXPECT_DOUBLE_EQ(s.average_precision, 0.5);
}

TEST(PlaneStatistics, OnlyAnswersAtTheOperatingPointDecide) {
  Answer possible = Answer::ofPlane(through(50.0, 0.0), 0.9);
  possible.called = false;
  const Answer unsure = Answer::ofPlane(through(60.0, 0.0), 0.4), right = Answer::ofPlane(through(0.0, 0.0), 0.8);
  const CloudResult found = cloudResult({possible, right}, onePlane());
  EXPECT_FALSE(found.firstIsRight()) << "the ranking counts all answers";
  EXPECT_TRUE(found.decidedRight());
  EXPECT_EQ(found.numFalse(), 0);
  EXPECT_FALSE(cloudResult({possible, unsure}, onePlane()).called());
  const CloudResult wrong = cloudResult({Answer::ofPlane(through(70.0, 0.0), 0.9), right}, onePlane());
  EXPECT_FALSE(wrong.decidedRight());
  EXPECT_EQ(wrong.numFalse(), 1);
}

TEST(PlaneStatistics, FalsePlanesOfScansAreSplitByWhatTheViewShows) {
  const Answer wrong = Answer::ofPlane(through(50.0, 0.0), 0.9);
  CloudResult scan = cloudResult({wrong, wrong, wrong}, ReferenceSymmetries());
  scan.recipe.view = 0;
  scan.view_verdicts = {ViewVerdict::Undecidable, ViewVerdict::Contradicted, ViewVerdict::Undecidable};
  const DecisionStatistics decisions = summarize({&scan}).decisions;
  EXPECT_EQ(decisions.num_contradicted, 1);
  EXPECT_EQ(decisions.num_undecidable, 2);
  EXPECT_EQ(decisions.asymmetric_contradicted.count, 1);
}

TEST(PlaneStatistics, AFailureIsNotTheAnswerNone) {
  CloudResult failed = cloudResult({}, ReferenceSymmetries());
  failed.answers.failed = true;
  const PlaneStatistics s = summarize({&failed});
  EXPECT_EQ(s.num_failed, 1);
  EXPECT_DOUBLE_EQ(s.decisions.asymmetric_called.rate(), 0.0) << "nothing is called, but it is counted";
  EXPECT_TRUE(std::isnan(s.first_rate));
}

TEST(PlaneStatistics, Quantiles) {
  EXPECT_DOUBLE_EQ(quantile({3.0, 1.0, 2.0}, 0.5), 2.0);
  EXPECT_DOUBLE_EQ(quantile({1.0, 2.0}, 0.5), 1.5);
  EXPECT_DOUBLE_EQ(quantile({1.0, 2.0, 3.0}, 1.0), 3.0);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

}  // namespace
