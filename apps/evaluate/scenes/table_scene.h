/// Objects on a table, and what a depth camera sees of them.
#pragma once

#include <pcl/PolygonMesh.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/scanner/triangle_scene.h"

namespace pcl_symmetry::apps {

/// A mesh of the size that it has in scenes.
struct SceneModel {
  std::string name;
  pcl::PolygonMesh mesh;  ///< metres
  std::vector<Eigen::Vector3d> vertices;
  std::shared_ptr<const TriangleScene> triangles;

  /// \param diagonal of the bounding box, metres.
  /// \throws std::invalid_argument where the mesh has no triangle.
  SceneModel(std::string model_name, const pcl::PolygonMesh& shape, double diagonal);
};

struct PlacedModel {
  std::size_t model;                ///< index
  Eigen::Isometry3d T_scene_model;  ///< the table is z = 0
};

/// A pinhole camera: z forward, x right, y down.
struct DepthCamera {
  int width = 640, height = 480;
  double focal = 525.0;  ///< pixels, of both axes. derived: the nominal value of structured-light cameras of this size
  Eigen::Isometry3d T_scene_camera = Eigen::Isometry3d::Identity();

  /// \return not of unit length: z = 1 in the frame of the camera.
  Eigen::Vector3d rayThrough(int column, int row) const {
    return {(column + 0.5 - 0.5 * width) / focal, (row + 0.5 - 0.5 * height) / focal, 1.0};
  }
};

/// Errors of a depth camera with structured light (Khoshelham and Elberink 2012): both grow with the square of the
/// depth. At a factor of 0 there are none.
struct DepthNoise {
  double factor = 1.0;          ///< of all of them, >= 0
  double deviation = 1.425e-3;  ///< standard deviation at a depth of 1 m, metres
  double step = 2.85e-3;        ///< of the quantisation at a depth of 1 m, metres
  double flying_share = 0.5;    ///< of the pixels at a depth edge whose depth lies between the two sides
  double least_edge = 0.02;     ///< share of the depth: larger differences between neighbours are edges
};

struct SceneOptionsOfTable {
  int most_objects = 12;             ///< >= 1; each scene has one to this number
  double gap = 0.005;                ///< between the circles around objects, metres
  double least_elevation = 10.0;     ///< of the camera, degrees
  double greatest_elevation = 40.0;  ///< degrees
  double least_distance = 0.9;       ///< of the camera from the middle of the table, metres
  double greatest_distance = 1.3;    ///< metres
};

struct TableScene {
  std::vector<PlacedModel> objects;
  DepthCamera camera;
};

/// Draws objects and poses: each stands on one face of its bounding box, turned at random about the vertical, and the
/// circles around them do not meet. An object that finds no place is left out.
TableScene drawScene(const std::vector<SceneModel>& models, const SceneOptionsOfTable& options, std::uint64_t seed);

/// What the camera sees, row by row.
struct SceneImage {
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud;  ///< organized, frame of the scene, with the pose of the sensor
  std::vector<int> ids;                       ///< of each pixel: index of the object; -1 = table, -2 = nothing
  std::vector<int> num_visible;               ///< of each object, pixels
  std::vector<int> num_alone;                 ///< of each object, pixels where it would be seen without the others
  std::vector<bool> cropped;                  ///< of each object: it reaches beyond the picture

  /// \return share of an object's pixels that others hide, in [0, 1].
  double occlusion(std::size_t object) const {
    return 1.0 - static_cast<double>(num_visible[object]) / num_alone[object];
  }
};

/// \param seed of the noise.
SceneImage renderScene(const std::vector<SceneModel>& models, const TableScene& scene, const DepthNoise& noise,
                       std::uint64_t seed);

}  // namespace pcl_symmetry::apps
