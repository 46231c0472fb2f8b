/// The results of pcl_symmetry_bop for one model.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "bop/color_symmetry.h"
#include "bop/symmetry_check.h"
#include "io/shape_input.h"
#include "pcl_symmetry/object_symmetries.h"

namespace pcl_symmetry::apps {

struct ModelOptions {
  ObjectSymmetryOptions symmetries;
  int mesh_points = 10'000;
  bool use_colors = false;
  double color_tolerance = 12.0;               ///< difference in CIELAB that counts as none
  bool explain = false;                        ///< tells of rejected rotations and other tolerances
  std::optional<std::string> failures_folder;  ///< where pictures of the rejected rotations go
};

/// The entry of models_info.json for a model.
struct ModelInfo {
  std::string key, file;
  Eigen::Vector3d low, size;  ///< of the bounding box, input frame
  double diameter = 0.0;
  int digits = 6;                      ///< significant ones of lengths that are printed
  ObjectSymmetries symmetries;         ///< input frame
  bool is_scan = false;                ///< a cloud that was seen from one side: hidden space counts as free
  bool has_unread_colors = false;      ///< of its vertices or a texture, which are not requested or cannot be read
  std::string group_without_colors;    ///< empty where they take nothing away
  std::optional<SymmetryCheck> check;  ///< against a given file
  bool explain = false;                ///< prints the rejected rotations too
};

/// \param given the list of a file for this model; none without a file or an entry.
/// \throws InputError naming the file.
ModelInfo analyzeModel(const std::string& path, const ModelOptions& options,
                       const std::optional<ListedSymmetries>& given);

/// The entry of models_info.json.
/// \param sphere_angle radians, in (0, pi].
nlohmann::ordered_json toJson(const ModelInfo& info, double sphere_angle);

/// The text that the tool prints for a model.
void printModel(const ModelInfo& info);

}  // namespace pcl_symmetry::apps
