#include "pictures/picture.h"

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

#include "io/load_module.h"
#include "io/shape_output.h"
#include "pictures/drawing.h"

namespace pcl_symmetry::apps {

namespace {

void checkSize(int width, int height) {
  for (const int edge : {width, height}) {
    if (edge < 16 || edge > 16384) {
      throw std::invalid_argument("picture edge = " + std::to_string(edge) + ", must be >= 16 and <= 16384");
    }
  }
}

}  // namespace

void checkScene(const PictureScene& scene) {
  if (!scene.points) throw std::invalid_argument("points is not set");
  if (scene.panels.empty()) throw std::invalid_argument("panels is empty, must hold at least one");
  for (const PicturePanel& panel : scene.panels) {
    const std::size_t num_elements = scene.mesh ? scene.mesh->polygons.size() : scene.points->size();
    if (!panel.segments.empty() && panel.segments.size() != num_elements) {
      throw std::invalid_argument("segments holds " + std::to_string(panel.segments.size()) + " numbers, must be " +
                                  std::to_string(num_elements) + ", one per polygon or point");
    }
    if (!panel.support.empty() && panel.support.size() != scene.points->size()) {
      throw std::invalid_argument("support holds " + std::to_string(panel.support.size()) + " values, must be " +
                                  std::to_string(scene.points->size()) + ", one per point");
    }
    for (const AxisLine& axis : panel.axes) {
      if (!axis.point.allFinite() || !axis.direction.allFinite() || !(axis.direction.norm() > 0)) {
        throw std::invalid_argument("an axis is not finite or its direction is zero");
      }
    }
    for (const PlanePatch& plane : panel.planes) {
      if (!plane.normal.allFinite() || !(plane.normal.norm() > 0) || !std::isfinite(plane.offset) ||
          !plane.center.allFinite() || !(plane.half_size >= 0) || !std::isfinite(plane.half_size)) {
        throw std::invalid_argument("a plane is not finite, its normal is zero or its half_size negative");
      }
    }
  }
  if (!scene.view.allFinite() || !(scene.view.cross(scene.up).norm() > 1e-6)) {
    throw std::invalid_argument("view and up must be finite and not parallel");
  }
}

void standUpright(PictureScene& scene, const Eigen::Vector3d& up) {
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), up);
  scene.view = turn * scene.view;
  scene.up = up;
}

void renderPicture(const PictureScene& scene, const std::string& path, int width, int height) {
  renderPicture(std::vector<PictureScene>{scene}, path, width, height, scene.num_columns);
}

void renderPicture(const std::vector<PictureScene>& scenes, const std::string& path, int width, int height,
                   int num_columns) {
  if (scenes.empty()) throw std::invalid_argument("scenes is empty, must hold at least one");
  for (const PictureScene& scene : scenes) checkScene(scene);
  checkSize(width, height);
  writeAtomically(path, [&](const std::string& temporary) {
    functionOf<decltype(drawScenes)>(kDrawingModule, "drawScenes")(scenes, {path, temporary, width, height},
                                                                   num_columns);
  });
}

}  // namespace pcl_symmetry::apps
