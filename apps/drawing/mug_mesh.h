/// A mug of our own for pictures.
#pragma once

#include "core/base/constants.h"
#include "drawing/parametric_mesh.h"

namespace pcl_symmetry::apps {

/// A cup of radius 1 and height 2.4 with an elliptic handle.
/// \param reach,rise of the handle, half axes.
inline pcl::PolygonMesh mug(double reach, double rise) {
  // In radii of the mug. chosen: the look of a mug.
  constexpr double kHeight = 2.4, kInner = 0.92, kFloor = 0.1, kThickness = 0.11;
  ParametricMesh mesh;
  mesh.addTurned({{0.0, 0.0}, {1.0, 0.0}, {1.0, kHeight}, {kInner, kHeight}, {kInner, kFloor}, {0.0, kFloor}});
  mesh.addSurface(24, 12, [=](double u, double v) -> Eigen::Vector3d {
    const double angle = kPi * (u - 0.5), around = 2.0 * kPi * v;
    const Eigen::Vector3d out(std::cos(angle), 0.0, std::sin(angle));
    const Eigen::Vector3d middle(0.95 + reach * out.x(), 0.0, 0.5 * kHeight + rise * out.z());
    return middle + kThickness * (std::cos(around) * out + std::sin(around) * Eigen::Vector3d::UnitY());
  });
  return mesh.polygonMesh();
}

}  // namespace pcl_symmetry::apps
