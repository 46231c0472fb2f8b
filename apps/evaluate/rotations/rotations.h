/// pcl_symmetry_evaluate rotations: how well groups of rotations are found (Section 6).
#pragma once

#include "common/processes/shared_work.h"

namespace pcl_symmetry::apps {

/// The sub-command, with argv[0] its name.
/// \param processes that share its work.
/// \return the exit code.
int evaluateRotations(int argc, char** argv, SharedWork& processes);

}  // namespace pcl_symmetry::apps
