/// pcl_symmetry_evaluate rotations: how well groups of rotations are found (Section 6).
#pragma once

namespace pcl_symmetry::apps {

/// The sub-command, with argv[0] its name.
/// \return the exit code.
int evaluateRotations(int argc, char** argv);

}  // namespace pcl_symmetry::apps
