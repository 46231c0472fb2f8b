/// What pcl_symmetry_bop finds out about one model.
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

/// What models_info.json says of a model.
struct ModelInfo {
  std::string key, file;
  Eigen::Vector3d low, size;  ///< of the bounding box, input frame
  double diameter = 0.0;
  int digits = 6;                      ///< significant ones of lengths that are printed
  ObjectSymmetries symmetries;         ///< input frame
  bool is_scan = false;                ///< a cloud that was seen from one side: what is hidden is taken to be empty
  bool has_unread_colors = false;      ///< of its vertices or a texture, which nobody asked for or can read
  std::string group_without_colors;    ///< empty where they take nothing away
  std::optional<SymmetryCheck> check;  ///< against a given file
  bool explain = false;                ///< prints the rejected rotations too
};

/// \param given what a file lists for this model; nothing where there is no file or no entry.
/// \throws InputError naming the file.
ModelInfo analyzeModel(const std::string& path, const ModelOptions& options,
                       const std::optional<ListedSymmetries>& given);

/// The entry of models_info.json.
/// \param sphere_angle radians, in (0, pi].
nlohmann::ordered_json toJson(const ModelInfo& info, double sphere_angle);

/// The text that the tool prints of a model.
void printModel(const ModelInfo& info);

}  // namespace pcl_symmetry::apps
