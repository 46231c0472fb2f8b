/// pcl_symmetry_evaluate segmentation: how close segmentations come to those that people made.
#pragma once

#include "common/processes/shared_work.h"

namespace pcl_symmetry::apps {

/// The sub-command, with argv[0] its name; processes share the models.
/// \return the exit code.
int evaluateSegmentation(int argc, char** argv, SharedWork& processes);

}  // namespace pcl_symmetry::apps
