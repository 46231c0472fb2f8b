#include "pictures/picture.h"

#include "io/load_module.h"
#include "io/shape_output.h"
#include "pictures/drawing.h"

namespace pcl_symmetry::apps {

Eigen::Vector3d upFor(const std::optional<Eigen::Vector3d>& viewpoint, const Eigen::Vector3d& middle) {
  const bool is_camera = viewpoint && viewpoint->norm() < 1e-3 * (*viewpoint - middle).norm();
  return is_camera ? Eigen::Vector3d(-Eigen::Vector3d::UnitY()) : Eigen::Vector3d::UnitZ();
}

void standUpright(PictureScene& scene, const Eigen::Vector3d& up) {
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), up);
  scene.view = turn * scene.view;
  scene.up = up;
}

void renderPicture(const std::vector<PictureScene>& scenes, const std::string& path, int width, int height,
                   int num_columns) {
  writeAtomically(path, [&](const std::string& temporary) {
    functionOf<decltype(drawScenes)>(kDrawingModule, "drawScenes")(scenes, {path, temporary, width, height},
                                                                   num_columns);
  });
}

}  // namespace pcl_symmetry::apps
