/// pcl_symmetry_evaluate alignment: canonical frames of scans against those of the whole models (Section 5.1).
#pragma once

namespace pcl_symmetry::apps {

/// The sub-command, with argv[0] its name.
/// \return the exit code.
int evaluateAlignment(int argc, char** argv);

}  // namespace pcl_symmetry::apps
