/// pcl_symmetry_evaluate recognition: whether a scan tells which model of a database it shows.
#pragma once

namespace pcl_symmetry::apps {

/// The sub-command, with argv[0] its name.
/// \return the exit code.
int evaluateRecognition(int argc, char** argv);

}  // namespace pcl_symmetry::apps
