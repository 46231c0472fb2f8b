/// What `pcl_symmetry_evaluate planes` is asked for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/command_line/common_options.h"
#include "evaluate/clouds/test_clouds.h"
#include "evaluate/planes/plane_matching.h"
#include "evaluate/references/reference_symmetries.h"
#include "evaluate/shared/model_list.h"

namespace pcl_symmetry::apps {

struct EvaluatePlanesOptions {
  std::vector<std::string> folders;
  ModelSelection selection;
  ReferenceOptions references;
  std::optional<std::string> references_path;
  TestCloudOptions clouds;
  std::string sweep = "none", views = "corners", tolerance_of = "diameter", references_by = "brute_force";
  std::optional<std::string> rows;
  MatchLimits limits;
  OperatingPoint operating_point;
  double detect_tolerance = 0.01;
  bool no_detect = false;
  std::optional<std::string> export_folder, planes_folder;
  std::optional<std::string> journal;  ///< of the models that are done
  std::optional<std::string> cloud_csv, model_csv, curve_csv, reliability_csv, share_csv, png;
  CommonOptions common;
};

}  // namespace pcl_symmetry::apps
