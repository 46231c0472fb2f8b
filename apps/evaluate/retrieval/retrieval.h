/// pcl_symmetry_evaluate retrieval: how well shapes find others of their class (Section 5.2).
#pragma once

namespace pcl_symmetry::apps {

/// The sub-command, with argv[0] its name.
/// \return the exit code.
int evaluateRetrieval(int argc, char** argv);

}  // namespace pcl_symmetry::apps
