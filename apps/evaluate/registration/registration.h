/// pcl_symmetry_evaluate registration: how well scans are brought to models of their objects.
#pragma once

#include "common/processes/shared_work.h"

namespace pcl_symmetry::apps {

/// The sub-command, with argv[0] its name.
/// \param processes that share its work.
/// \return the exit code.
int evaluateRegistration(int argc, char** argv, SharedWork& processes);

}  // namespace pcl_symmetry::apps
