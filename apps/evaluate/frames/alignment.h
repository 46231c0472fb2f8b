/// pcl_symmetry_evaluate alignment: canonical frames of scans against those of the whole models (Section 5.1).
#pragma once

#include "common/processes/shared_work.h"

namespace pcl_symmetry::apps {

/// The sub-command, with argv[0] its name; processes share the models.
/// \return the exit code.
int evaluateAlignment(int argc, char** argv, SharedWork& processes);

}  // namespace pcl_symmetry::apps
