/// The three axes of a frame in a picture.
#pragma once

#include "common/pictures/picture.h"

namespace pcl_symmetry::apps {

/// Adds lines through the center: first axis orange, second green, third blue.
/// \param axes in columns, unit.
inline void addAxes(PicturePanel& panel, const Eigen::Vector3d& center, const Eigen::Matrix3d& axes) {
  const Eigen::Vector3d colors[] = {{0.84, 0.37, 0.0}, {0.0, 0.62, 0.45}, {0.0, 0.45, 0.70}};
  for (int k = 0; k < 3; ++k) panel.axes.push_back({center, axes.col(k), colors[k]});
}

}  // namespace pcl_symmetry::apps
