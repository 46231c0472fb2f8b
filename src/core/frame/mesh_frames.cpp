#include <Eigen/Geometry>

#include "core/geometry/geometry_rules.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/mesh_surface.h"
#include "pcl_symmetry/core/symmetry_frame.h"

namespace pcl_symmetry {

void refineOnMesh(const MeshSurface& mesh, SymmetryFrame& frame) {
  Eigen::Matrix3d axes = frame.axes;
  Eigen::Vector3d center = frame.center;
  const double tolerance = 2.0 * DetectionOptions().tolerance * mesh.ball().radius;
  const double nearly = 0.8;  // share of planes that are fitted: of 94 that became exact none had less than 0.96
  int exact[3], num_exact = 0;
  for (int k = 0; k < 3; ++k) {
    const ReflectionPlane start(frame.axes.col(k), frame.axes.col(k).dot(frame.center));
    if (mesh.shares(start, 2.0 * tolerance).share < nearly) continue;
    const ReflectionPlane plane = mesh.fitted(start);
    if (mesh.shares(plane, tolerance).share < kSymmetricShare) continue;
    axes.col(k) = plane.normal();
    for (int i = 0; i < num_exact; ++i) axes.col(k) -= axes.col(exact[i]).dot(axes.col(k)) * axes.col(exact[i]);
    axes.col(k).normalize();
    center -= (axes.col(k).dot(center) - axes.col(k).dot(plane.normal() * plane.offset())) * axes.col(k);
    exact[num_exact++] = k;
  }
  if (num_exact == 0) return;
  if (num_exact == 1) {
    const int k = exact[0], next = (k + 1) % 3;
    axes.col(next) = (axes.col(next) - axes.col(k).dot(axes.col(next)) * axes.col(k)).normalized();
  }
  if (num_exact < 3) {
    const int last = num_exact == 2 ? 3 - exact[0] - exact[1] : (exact[0] + 2) % 3;
    axes.col(last) = axes.col((last + 1) % 3).cross(axes.col((last + 2) % 3));
  }
  if (axes.determinant() < 0.0) return;
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();  // of the frame
  motion.linear() = axes * frame.axes.transpose();
  motion.translation() = center - motion.linear() * frame.center;
  frame.axes = axes;
  frame.center = center;
  frame.T_canonical_input = frame.T_canonical_input * motion.inverse();
  for (Eigen::Isometry3d& other : frame.equivalent) other = other * motion.inverse();
  if (frame.probable.empty()) return;
  frame.probable.front().center = center;
  frame.probable.front().axes = axes;
}

}  // namespace pcl_symmetry
