#pragma once

namespace pcl_symmetry::apps {

/// `pcl_symmetry_evaluate scenes`: objects among others, seen by a depth camera.
int evaluateScenes(int argc, char** argv);

}  // namespace pcl_symmetry::apps
