/// What there is to see of a shape.
#pragma once

#include <pcl/PolygonMesh.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <optional>
#include <string>
#include <vector>

#include "command_line/command_line.h"
#include "io/shape_input.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"
#include "pcl_symmetry/core/surface_segmentation.h"
#include "pcl_symmetry/core/symmetry_frame.h"
#include "pcl_symmetry/viewpoint_selection.h"

namespace pcl_symmetry::apps {

/// A shape, moved to the origin and scaled to radius 1, as single-precision graphics want it, with all that was found.
struct ViewerModel {
  pcl::PointCloud<pcl::PointXYZ>::Ptr points;  ///< finite
  std::optional<pcl::PolygonMesh> mesh;
  std::vector<SymmetryPlane> planes;  ///< best first; point_support has one value per point here
  std::vector<std::string> labels;    ///< of each plane
  SymmetryFrame frame;                ///< center of symmetry and principal symmetry axes
  std::vector<SymmetryAxis> axes;
  std::vector<SymmetryCenter> centers;
  ViewpointSelection views;
  SegmentationOptions segmentation;
  std::string summary;  ///< one line
};

struct ViewerModelOptions {
  DetectionOptions detection;
  Viewpoint viewpoint;
  std::optional<Eigen::Vector3d> up;  ///< input frame
  int mesh_points = 10'000;
  int num_parts = 0;  ///< 0 = as many as the shape has
};

/// \throws pcl::BadArgumentException where the shape has no extent.
ViewerModel makeViewerModel(const Shape& shape, const ViewerModelOptions& options);

/// The segment of each polygon of the mesh, or of each point where there is none; empty where there is no surface to
/// cut.
std::vector<int> findParts(const ViewerModel& model);

/// Iterative Symmetric Points, step by step, as the paper's Figure 7 shows it: one iteration before its step, some
/// samples, their reflections, and the closest points of the surface.
struct IspFrame {
  ReflectionPlane plane;
  Points samples, reflections, closest;  ///< 3 x M each; samples whose reflection is far from the surface are left out
  double residual = 0.0;                 ///< weighted root mean square distance of all pairs, units of the points
};

/// From a plane beside the given one (turned by 12 degrees, shifted by 5 % of the radius) back to rest.
/// \param points 3 x N, finite, about the origin, of radius 1.
/// \return one frame or more, the last at rest.
std::vector<IspFrame> ispFrames(const Points& points, const ReflectionPlane& plane);

}  // namespace pcl_symmetry::apps
