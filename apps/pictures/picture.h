/// Pictures of clouds, meshes and symmetry planes as PNG files, also on machines without a display.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command_line/tool_errors.h"
#include "io/exact_coordinates.h"
#include "pictures/colors.h"

namespace pcl_symmetry::apps {

/// A translucent rectangle in the plane normal . x = offset; fitted to the points unless half_size is set.
struct PlanePatch {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
  double offset = 0;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< center of the square, projected onto the plane
  /// Half the edge of the square, input units; 0 = a rectangle around the projected points, without `center`.
  double half_size = 0;
  Eigen::Vector3d color = {0.90, 0.62, 0.0};  ///< red, green, blue in [0, 1]
};

/// A straight line through the whole scene, or about a point.
struct AxisLine {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d color = {0.84, 0.37, 0.0};  ///< red, green, blue in [0, 1]
  /// Length on either side of the point, input units; drawn in front of everything. 0 = through the whole scene.
  double half_length = 0;
};

/// One view among several in a picture.
struct PicturePanel {
  std::string label;                 ///< text at the top; may be empty
  std::vector<double> support = {};  ///< one value in [0, 1] per point, in cividis colors; empty: one plain color
  std::vector<PlanePatch> planes = {};
  std::vector<AxisLine> axes = {};
  /// One number per polygon of the mesh, or per point if there is no mesh, each with its own color (negative: gray);
  /// the points of a mesh are then not drawn. Empty: one plain color.
  std::vector<int> segments = {};
  bool show_points = true;  ///< false: only the mesh is drawn; it has the colors if its vertices are the points
  std::vector<std::pair<int, std::string>> legend = {};  ///< segments and their names, in a corner of the picture
};

/// The content of a picture: the same shape in every panel.
struct PictureScene {
  Cloud::ConstPtr points;                     ///< non-finite points are not drawn
  std::optional<pcl::PolygonMesh> mesh = {};  ///< drawn in light gray
  std::vector<PicturePanel> panels = {};      ///< at least one
  Eigen::Vector3d view = {1.0, -1.6, 0.8};    ///< direction from the scene toward the camera
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  bool show_color_bar = true;  ///< legend of the support, in panels that have support
};

/// The default up direction: z, or -y for a camera, whose viewpoint is the origin.
/// \param middle middle of the points.
Eigen::Vector3d upFor(const std::optional<Eigen::Vector3d>& viewpoint, const Eigen::Vector3d& middle);

/// Rotates the view so that \p up takes the place of z; any length but zero.
void standUpright(PictureScene& scene, const Eigen::Vector3d& up);

/// Renders the panels of scenes off screen, row by row in one picture, and writes a complete PNG. Needs a display;
/// tools start one with Xvfb, see findDisplay().
/// \param scenes at least one.
/// \param width,height size of the whole picture, pixels.
/// \param num_columns columns of panels; 0 = as square as the panels allow.
/// \throws InputError if nothing can draw or the file cannot be written.
void renderPicture(const std::vector<PictureScene>& scenes, const std::string& path, int width, int height,
                   int num_columns = 0);

}  // namespace pcl_symmetry::apps
