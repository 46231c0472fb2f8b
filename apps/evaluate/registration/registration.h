/// pcl_symmetry_evaluate registration: how well scans are brought to models of their objects.
#pragma once

namespace pcl_symmetry::apps {

/// The sub-command, with argv[0] its name.
/// \return the exit code.
int evaluateRegistration(int argc, char** argv);

}  // namespace pcl_symmetry::apps
