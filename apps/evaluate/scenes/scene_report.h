/// What was found of the objects of scenes, by how much of them others hide.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evaluate/planes/plane_statistics.h"
#include "recognition/packing/packed_bytes.h"

namespace pcl_symmetry::apps {

/// What a database answered for one object.
struct RecognitionResult {
  bool is_known = false;    ///< the model is in the database
  bool is_right = false;    ///< the best answer is the very model
  bool right_pose = false;  ///< that, and no point of it is off by too much
  bool accepted = false;    ///< at the operating point; otherwise the object is called unknown
  std::string answer;       ///< the best one, accepted or not; empty where there is none
  double support = 0.0, conflict = 0.0, merit = 0.0, confidence = 0.0;
  double lead = 0.0;  ///< of its merit over that of the best other model
  double milliseconds = 0.0;
};

/// One object of a scene, asked in one way.
struct SceneResult {
  int scene = 0;
  std::string row;           ///< what the detector was told of the others
  double occlusion = 0.0;    ///< share of its pixels that others hide
  double noise = 0.0;        ///< factor of the depth noise
  bool asked_planes = true;  ///< false: planes says what is known of the object, and no answer
  CloudResult planes;
  std::optional<RecognitionResult> recognition;
};

// As bytes: of answers, scores and judgements go along, not where they are.
void put(detail::PackedBytes& bytes, const SceneResult& result);
void get(detail::UnpackedBytes& bytes, SceneResult& result);

/// Bands of occlusion: [0, 10), [10, 30), [30, 50), [50, 70) per cent.
/// derived: the bands that the README reports; beyond 70 % little is left to see.
constexpr double kOcclusionBands[] = {0.0, 0.1, 0.3, 0.5, 0.7};

/// \return none for objects of which too little is seen.
std::optional<std::size_t> bandOf(double occlusion);

std::string sceneTable(const std::vector<SceneResult>& results);
nlohmann::json sceneJson(const std::vector<SceneResult>& results);
std::string sceneCSV(const std::vector<SceneResult>& results);

}  // namespace pcl_symmetry::apps
