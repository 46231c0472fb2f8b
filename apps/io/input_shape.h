/// A file as the tools analyse it: the points of a cloud, points spread over a mesh, or a volume.
#pragma once

#include <cstdint>
#include <string>

#include "command_line/common_options.h"
#include "command_line/console.h"
#include "io/shape_input.h"
#include "pcl_symmetry/core/scalar_grid.h"

namespace pcl_symmetry::apps {

struct InputShape {
  std::string path;
  Shape shape;
  pcl::PointCloud<pcl::PointXYZ>::Ptr points;  ///< minus the shift of the shape; those of a cloud may be non-finite
  double loading_ms = 0.0;
  ScalarGrid::ConstPtr volume;  ///< of a volume, whose points are the voxels at the border of the body; null otherwise
  VolumeLevels levels;          ///< intensities of the volume that count

  const Eigen::Vector3d& shift() const { return shape.shift; }

  /// \return what outputs extend: all fields of a cloud, or the points spread over a mesh; input frame
  pcl::PCLPointCloud2 fields() const;
};

/// \param mesh_points number of points spread over a mesh
/// \param seed of these points
/// \throws InputError naming the file
InputShape loadInput(const std::string& path, int mesh_points, std::uint64_t seed);

/// The same with the number of points and the seed of the flags, as a step of a tool.
InputShape loadInput(const Console& console, const std::string& path, const CommonOptions& common);

/// Warns of what the file holds and the shape does not.
void warnOfLeftOut(const Console& console, const std::string& path, const Shape& shape);

}  // namespace pcl_symmetry::apps
