/// pcl_symmetry_evaluate planes: how well symmetry planes are found.
#pragma once

#include "common/processes/shared_work.h"

namespace pcl_symmetry::apps {

/// The sub-command, with argv[0] its name.
/// \param processes that share its work.
/// \return the exit code.
int evaluatePlanes(int argc, char** argv, SharedWork& processes);

}  // namespace pcl_symmetry::apps
