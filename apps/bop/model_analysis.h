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
  double color_tolerance = 12.0;               ///< difference in CIELAB up to which colors are equal
  bool explain = false;                        ///< reports rejected rotations and other tolerances
  std::optional<std::string> failures_folder;  ///< folder for pictures of the rejected rotations
};

/// The entry of models_info.json for a model.
struct ModelInfo {
  std::string key, file;
  Eigen::Vector3d low, size;  ///< corner and size of the bounding box, input frame
  double diameter = 0.0;
  int digits = 6;               ///< significant digits of lengths that are printed
  ObjectSymmetries symmetries;  ///< input frame
  bool is_scan = false;         ///< whether a cloud was seen from one side: hidden space counts as free
  /// Whether vertices or a texture have colors that are not requested or cannot be read.
  bool has_unread_colors = false;
  std::string group_without_colors;    ///< empty if colors remove no symmetry
  std::optional<SymmetryCheck> check;  ///< comparison with a given file
  bool explain = false;                ///< also prints the rejected rotations
};

/// \param given the symmetries that a file lists for this model; none without a file or an entry.
/// \throws InputError naming the file.
ModelInfo analyzeModel(const std::string& path, const ModelOptions& options,
                       const std::optional<ListedSymmetries>& given);

/// The entry of models_info.json.
/// \param sphere_angle radians, in (0, pi].
nlohmann::ordered_json toJson(const ModelInfo& info, double sphere_angle);

/// The text that the tool prints for a model.
void printModel(const ModelInfo& info);

}  // namespace pcl_symmetry::apps
