/// What `pcl_symmetry_evaluate rotations` is told.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/command_line/command_line.h"
#include "evaluate/shared/model_list.h"
#include "pcl_symmetry/core/rotation/rotational_symmetry.h"

namespace pcl_symmetry::apps {

struct EvaluateRotationsOptions {
  std::vector<double> counts{2000, 10'000, 50'000};
  std::vector<double> noise{0.0, 0.003};
  int num_seeds = 1;
  int num_scans = 0;
  ObjectSymmetryOptions symmetries;
  std::optional<std::string> kind, csv, journal, meshes;
  ModelSelection selection;
  CommonOptions common;
};

}  // namespace pcl_symmetry::apps
