/// pcl_symmetry_evaluate segmentation: how close segmentations come to those that people made.
#pragma once

namespace pcl_symmetry::apps {

/// The sub-command, with argv[0] its name.
/// \return the exit code.
int evaluateSegmentation(int argc, char** argv);

}  // namespace pcl_symmetry::apps
