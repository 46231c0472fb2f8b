/// Objects on a table or in a bin, and what a depth camera or a LiDAR scanner sees of them.
#pragma once

#include <pcl/PolygonMesh.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
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

enum class SensorKind { Camera, Lidar };

/// A depth camera: z forward, x right, y down. Or a LiDAR scanner that turns about its y axis, of which only the part
/// of a turn around z is taken: a row of pixels is a ring.
struct SceneSensor {
  SensorKind kind = SensorKind::Camera;
  int width = 640, height = 480;
  double focal = 525.0;  ///< of a camera, pixels. derived: the nominal value of structured-light cameras of this size
  /// Angles between neighbouring columns and rings of a scanner, radians.
  double column_step = 0.0, ring_step = 0.0;
  Eigen::Isometry3d T_scene_sensor = Eigen::Isometry3d::Identity();

  /// A scanner as those on cars, 20 m from a car of 4.5 m, made as small as objects on tables: 16 rings show some 100
  /// to 1000 points of an object, 64 rings up to 5000.
  /// \param num_rings >= 2.
  static SceneSensor lidar(int num_rings);

  /// \return in the frame of the sensor, along which depths are measured in its length: z = 1 for a camera, of unit
  /// length for a scanner.
  Eigen::Vector3d rayThrough(int column, int row) const;
};

/// Errors of a depth camera with structured light (Khoshelham and Elberink 2012): both grow with the square of the
/// depth. At a factor of 0 there are none.
struct DepthNoise {
  double factor = 1.0;          ///< of all of them, >= 0
  double deviation = 1.425e-3;  ///< standard deviation at a depth of 1 m, metres
  double step = 2.85e-3;        ///< of the quantisation at a depth of 1 m, metres
  double flying_share = 0.5;    ///< of the pixels at a depth edge whose depth lies between the two sides
  double least_edge = 0.02;     ///< share of the depth: larger differences between neighbours are edges
  /// Standard deviation of the range of a LiDAR scanner, metres, which has no other error.
  /// derived: 2 cm at a car of 4.5 m, for an object of 0.22 m.
  double range_deviation = 0.001;
};

struct SceneOptionsOfTable {
  /// An open box around the objects, whose floor is the table; the camera looks into it from above.
  bool in_bin = false;
  SceneSensor sensor;                       ///< its pose does not count
  int most_objects = 12;                    ///< >= 1; each scene has one to this number
  double gap = 0.005;                       ///< between the circles around objects, metres
  double least_elevation = 10.0;            ///< of the sensor, degrees
  double greatest_elevation = 40.0;         ///< degrees
  double least_elevation_of_bin = 45.0;     ///< the same for bins, degrees
  double greatest_elevation_of_bin = 80.0;  ///< degrees
  double least_distance = 0.9;              ///< of the sensor from the middle of the table, metres
  double greatest_distance = 1.3;           ///< metres
};

/// The walls of an open box on the table, about its middle.
struct Bin {
  double half_side;  ///< to the inner faces of the walls, metres
  double height;     ///< metres
  double thickness;  ///< of the walls, metres

  /// \return the walls, frame of the scene.
  std::vector<Eigen::AlignedBox3d> walls() const;
  /// \return the inner faces: unit normal towards the objects, then d: normal . x + d = 0 on the face.
  std::vector<Eigen::Vector4d> innerFaces() const;
};

struct TableScene {
  std::vector<PlacedModel> objects;
  std::optional<Bin> bin;
  SceneSensor sensor;
};

/// Draws objects and poses: each stands on one face of its bounding box, turned at random about the vertical, and the
/// circles around them do not meet. An object that finds no place is left out. A bin is as wide as its objects need.
TableScene drawScene(const std::vector<SceneModel>& models, const SceneOptionsOfTable& options, std::uint64_t seed);

/// What the sensor sees, row by row. The cloud of a scanner has no rows: what met nothing is left out.
struct SceneImage {
  pcl::PointCloud<pcl::PointXYZ>::Ptr
      cloud;                     ///< frame of the scene, with the pose of the sensor; organized if a camera saw it
  std::vector<int> ids;          ///< of each point: index of the object; -1 = table or bin, -2 = nothing
  std::vector<int> num_visible;  ///< of each object, pixels
  std::vector<int> num_alone;    ///< of each object, pixels where it would be seen without the others
  std::vector<bool> cropped;     ///< of each object: it reaches beyond the picture

  /// \return share of an object's pixels that others hide, in [0, 1].
  double occlusion(std::size_t object) const {
    return 1.0 - static_cast<double>(num_visible[object]) / num_alone[object];
  }
};

/// \param seed of the noise.
SceneImage renderScene(const std::vector<SceneModel>& models, const TableScene& scene, const DepthNoise& noise,
                       std::uint64_t seed);

}  // namespace pcl_symmetry::apps
