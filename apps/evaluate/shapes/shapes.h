/// pcl_symmetry_evaluate shapes: decisions on shapes and clouds that are made by code, with symmetries known by
/// construction.
#pragma once

#include "common/processes/shared_work.h"

namespace pcl_symmetry::apps {

/// The sub-command, with argv[0] its name.
/// \param processes that share its work.
/// \return the exit code.
int evaluateShapes(int argc, char** argv, SharedWork& processes);

}  // namespace pcl_symmetry::apps
