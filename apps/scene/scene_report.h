/// Reports of pcl_symmetry_scene: a table, JSON, the completed scene, a picture.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/input_shape.h"
#include "pcl_symmetry/symmetry_scene.h"
#include "pictures/picture.h"
#include "pictures/raster_image.h"

namespace pcl_symmetry::apps {

/// One line for each object, in the frame of the input.
/// \param shift shift of the loaded points, see InputShape.
std::string tableOf(const SceneAnalysis& scene, const Eigen::Vector3d& shift);

/// For each object: number, points, findings, model, and the center of its frame; null if there is none.
std::vector<std::vector<nlohmann::json>> rowsOf(const SceneAnalysis& scene, const Eigen::Vector3d& shift);

nlohmann::json describeScene(const InputShape& input, const SceneAnalysis& scene);

/// The fields x, y, z, object (0 = none, -1 = supporting plane, then 1, 2 ... as in the table) and completed (1 if a
/// symmetry added the point), for all finite points of the scene and the added ones.
pcl::PCLPointCloud2 completedScene(const InputShape& input, const SceneAnalysis& scene);

/// The scene from the position of the sensor, each object in its own color with its plane or axis, and the first
/// objects one by one, each with its planes and axes and the tolerance of its decision.
PictureScene selectableObjects(const InputShape& input, const SceneAnalysis& scene);

/// The colors of an organized cloud, pixel by pixel; empty if it has none.
RasterImage cameraPicture(const InputShape& input);

/// The scene, and each object with what its symmetry adds.
void drawScene(const InputShape& input, const SceneAnalysis& scene, const std::string& path);

}  // namespace pcl_symmetry::apps
