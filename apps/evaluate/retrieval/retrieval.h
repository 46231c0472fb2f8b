/// pcl_symmetry_evaluate retrieval: how well shapes find others of their class (Section 5.2).
#pragma once

#include "common/processes/shared_work.h"

namespace pcl_symmetry::apps {

/// The sub-command, with argv[0] its name.
/// \param processes that share its work.
/// \return the exit code.
int evaluateRetrieval(int argc, char** argv, SharedWork& processes);

}  // namespace pcl_symmetry::apps
