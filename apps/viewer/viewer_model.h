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

}  // namespace pcl_symmetry::apps
