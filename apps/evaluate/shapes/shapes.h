/// pcl_symmetry_evaluate shapes: decisions on shapes and clouds that are made by code, with symmetries known by
/// construction.
#pragma once

namespace pcl_symmetry::apps {

/// The sub-command, with argv[0] its name.
/// \return the exit code.
int evaluateShapes(int argc, char** argv);

}  // namespace pcl_symmetry::apps
