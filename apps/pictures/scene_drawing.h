/// Scenes drawn by VTK into PNG files.
#pragma once

#include "common/modules/drawing.h"

namespace pcl_symmetry::apps {

/// As Drawing::drawScenes().
void drawScenes(const std::vector<PictureScene>& scenes, const PictureTarget& target, int num_columns);

}  // namespace pcl_symmetry::apps
