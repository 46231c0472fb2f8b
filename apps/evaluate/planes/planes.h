/// pcl_symmetry_evaluate planes: how well symmetry planes are found.
#pragma once

namespace pcl_symmetry::apps {

/// The sub-command, with argv[0] its name.
/// \return the exit code.
int evaluatePlanes(int argc, char** argv);

}  // namespace pcl_symmetry::apps
