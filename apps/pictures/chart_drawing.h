/// Charts drawn by VTK into PNG files.
#pragma once

#include "common/modules/drawing.h"

namespace pcl_symmetry::apps {

/// As Drawing::drawChart().
void drawChart(const Chart& chart, const PictureTarget& target);

}  // namespace pcl_symmetry::apps
