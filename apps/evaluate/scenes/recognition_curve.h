/// What a database answers for the objects of scenes, at any operating point.
#pragma once

#include <string>
#include <vector>

#include "evaluate/calibration/reliability.h"
#include "evaluate/scenes/scene_report.h"

namespace pcl_symmetry::apps {

/// Answers by the least confidence that is asked of them, a row for each step, noise, way of seeing and band of
/// occlusion: known objects whose model, and whose model and pose, are right, known and unknown objects that are called
/// unknown.
std::string recognitionCurveCSV(const std::vector<SceneResult>& results);

/// How often the best answers, accepted or not, name the right model, by their confidence: known and unknown objects
/// together, one group for each noise and way of seeing.
std::vector<Reliability> recognitionReliability(const std::vector<SceneResult>& results);

/// The numbers of RecognizedModel::confidence that fit all answers best: a logistic regression on merit and lead.
std::string fittedConfidence(const std::vector<SceneResult>& results);

}  // namespace pcl_symmetry::apps
