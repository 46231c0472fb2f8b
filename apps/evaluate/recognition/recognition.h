/// pcl_symmetry_evaluate recognition: whether a scan tells which model of a database it shows.
#pragma once

#include "common/processes/shared_work.h"

namespace pcl_symmetry::apps {

/// The sub-command, with argv[0] its name.
/// \param processes that share its work.
/// \return the exit code.
int evaluateRecognition(int argc, char** argv, SharedWork& processes);

}  // namespace pcl_symmetry::apps
