#pragma once

#include "common/processes/shared_work.h"

namespace pcl_symmetry::apps {

/// `pcl_symmetry_evaluate scenes`: objects among others, seen by a depth camera.
int evaluateScenes(int argc, char** argv, SharedWork& processes);

}  // namespace pcl_symmetry::apps
