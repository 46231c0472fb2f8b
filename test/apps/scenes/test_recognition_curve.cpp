#include "evaluate/scenes/recognition_curve.h"

#include <gtest/gtest.h>

#include <sstream>

namespace pcl_symmetry::apps {

namespace {

SceneResult answer(bool known, bool right, bool right_pose, double merit, double confidence) {
  SceneResult result;
  result.row = "table";
  result.occlusion = 0.4;
  result.asked_planes = false;
  RecognitionResult recognition;
  recognition.is_known = known;
  recognition.is_right = right;
  recognition.right_pose = right_pose;
  recognition.answer = "a model";
  recognition.merit = merit;
  recognition.confidence = confidence;
  result.recognition = recognition;
  return result;
}

/// Answers that are more often right the greater their merit is.
std::vector<SceneResult> answers() {
  return {answer(true, true, true, 0.9, 0.99),   answer(true, true, false, 0.85, 0.9),
          answer(true, false, false, 0.6, 0.3),  answer(true, true, true, 0.65, 0.4),
          answer(false, false, false, 0.7, 0.5), answer(false, false, false, 0.4, 0.01)};
}

}  // namespace

TEST(RecognitionCurve, CountsAtEachOperatingPoint) {
  std::istringstream lines(recognitionCurveCSV(answers()));
  std::string line, at_zero, at_half, at_one;
  for (std::getline(lines, line); std::getline(lines, line);) {
    if (line.rfind("0,table,0.3,0.5,0,", 0) == 0) at_zero = line;
    if (line.rfind("0,table,0.3,0.5,0.5,", 0) == 0) at_half = line;
    if (line.rfind("0,table,0.3,0.5,1,", 0) == 0) at_one = line;
  }
  // Right model, that and pose, known ones called unknown, others called unknown: each of how many.
  EXPECT_EQ(at_zero, "0,table,0.3,0.5,0,3,4,2,4,0,4,0,2");
  EXPECT_EQ(at_half, "0,table,0.3,0.5,0.5,2,4,1,4,2,4,1,2");
  EXPECT_EQ(at_one, "0,table,0.3,0.5,1,0,4,0,4,4,4,2,2");
}

TEST(RecognitionCurve, JudgesAndFitsTheConfidence) {
  const std::vector<Reliability> groups = recognitionReliability(answers());
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_EQ(groups[0].num_forecasts, 6);
  // derived: the sum over the bins of confidences less right answers, by 6.
  EXPECT_NEAR(groups[0].calibration_error, (0.11 + 0.3 + 0.6 + 0.5 + 0.01) / 6.0, 1e-9);
  EXPECT_EQ(fittedConfidence(answers()).rfind("confidence of 6 answers: constant = -", 0), 0u);
  EXPECT_EQ(fittedConfidence({}), "");
}

}  // namespace pcl_symmetry::apps
