/// A file as the tools analyze it: the points of a cloud, points spread over a mesh, or a volume of CT, MR and other
/// devices: NIfTI, Analyze, MGH, NRRD, MetaImage and VTK images.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "command_line/command_line.h"
#include "command_line/console.h"
#include "io/exact_coordinates.h"
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

  /// \return the viewpoint of the flags for `points`. Points spread evenly over a mesh have no density to infer one from.
  Viewpoint viewpoint(const CommonOptions& common) const;

  /// \return what outputs extend: all fields of a cloud, or the points spread over a mesh; input frame
  pcl::PCLPointCloud2 fields() const;
};

/// \param mesh_points number of points spread over a mesh
/// \param seed of these points
/// \throws InputError naming the file
InputShape loadInput(const std::string& path, int mesh_points, std::uint64_t seed);

/// The same with the number of points and the seed of the flags, as a step of a tool.
InputShape loadInput(const Console& console, const std::string& path, const CommonOptions& common);

/// Gives an analysis of points or volumes the input, and the viewpoint of the flags.
template <typename Analysis>
void setInput(Analysis& analysis, const InputShape& input, const CommonOptions& common) {
  analysis.setViewpoint(input.viewpoint(common));
  if (input.volume)
    analysis.setInputVolume(input.volume, input.levels);
  else
    analysis.setInputCloud(input.points);
}

/// \throws InputError with the reason of an analysis that found no answer in the input.
template <typename Analysis>
void checkAnswer(const Analysis& analysis, const InputShape& input) {
  if (!analysis.getReason().empty()) throw InputError(input.path + ": " + analysis.getReason());
}

/// Warns of content of the file that the shape does not have.
void warnOfLeftOut(const Console& console, const std::string& path, const Shape& shape);

/// The endings of files that loadVolume() reads.
inline const char* const kVolumeFiles = ".nii, .nii.gz, .hdr, .img, .mgh, .mgz, .nrrd, .nhdr, .mha, .mhd or .vti";

/// \return whether the name ends in one of kVolumeFiles, in capitals or not.
bool isVolumePath(const std::string& path);

/// A volume in the physical frame of its file: RAS for NIfTI and MGH, that of the header otherwise.
struct Volume {
  std::shared_ptr<ScalarGrid> grid;
  std::vector<std::string> left_out;  ///< further content of the file, such as later times
};

/// \throws InputError naming the file where it is no volume, or cut off.
Volume loadVolume(const std::string& path);

// In the module of VTK.
extern "C" {
void readVTI(const std::string& path, Volume& volume);
/// The surface on which the volume has a value (flying edges).
void contourVolume(const ScalarGrid& grid, double value, ExactShape& surface);
}

}  // namespace pcl_symmetry::apps
