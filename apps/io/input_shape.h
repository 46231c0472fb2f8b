/// A file as the tools analyze it: the points of a cloud, points spread over a mesh, or a volume (NIfTI, Analyze, MGH,
/// NRRD, MetaImage and VTK images) of CT, MR and other devices.
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
  /// Coordinates minus the shift of the shape; points of a cloud may be non-finite.
  Cloud::Ptr points;
  double loading_ms = 0.0;
  /// Null if the input is no volume; otherwise `points` are the voxels at the border of the body.
  ScalarGrid::ConstPtr volume;
  VolumeLevels levels;  ///< range of intensities of the volume

  const Eigen::Vector3d& shift() const { return shape.shift; }

  /// \return the viewpoint of the flags for `points`. It is not inferred from points spread evenly over a mesh.
  Viewpoint viewpoint(const CommonOptions& common) const;

  /// \return the fields that outputs extend: all fields of a cloud, or the points spread over a mesh; input frame
  pcl::PCLPointCloud2 fields() const;
};

/// \param mesh_points number of points spread over a mesh
/// \param seed seed of these points
/// \throws InputError naming the file
InputShape loadInput(const std::string& path, int mesh_points, std::uint64_t seed);

/// The same with the number of points and the seed of the flags, as a step of a tool.
InputShape loadInput(const Console& console, const std::string& path, const CommonOptions& common);

/// Passes the points or the volume, and the viewpoint of the flags, to an analysis.
template <typename Analysis>
void setInput(Analysis& analysis, const InputShape& input, const CommonOptions& common) {
  analysis.setViewpoint(input.viewpoint(common));
  if (input.volume)
    analysis.setInputVolume(input.volume, input.levels);
  else
    analysis.setInputCloud(input.points);
}

/// \return the answer that an analysis of the input gave.
/// \throws InputError with the reason if the analysis found none.
template <typename Analysis, typename Answer>
Answer checked(const Analysis& analysis, const InputShape& input, Answer answer) {
  if (!analysis.getReason().empty()) throw InputError(input.path + ": " + analysis.getReason());
  return answer;
}

/// Warns of content of the file that the shape does not hold.
void warnOfLeftOut(const Console& console, const std::string& path, const Shape& shape);

/// The endings of files that loadVolume() reads.
inline const char* const kVolumeFiles = ".nii, .nii.gz, .hdr, .img, .mgh, .mgz, .nrrd, .nhdr, .mha, .mhd or .vti";

/// \return whether the name ends in one of kVolumeFiles, in upper or lower case.
bool isVolumePath(const std::string& path);

/// A volume in the physical frame of its file: RAS for NIfTI and MGH, that of the header otherwise.
struct Volume {
  std::shared_ptr<ScalarGrid> grid;
  std::vector<std::string> left_out;  ///< further content of the file, such as later times
};

/// \throws InputError naming the file if it is no volume, or cut off.
Volume loadVolume(const std::string& path);

// These functions are in the module of VTK.
extern "C" {
void readVTI(const std::string& path, Volume& volume);
/// The surface on which the volume has the value (flying edges).
void contourVolume(const ScalarGrid& grid, double value, ExactShape& surface);
}

}  // namespace pcl_symmetry::apps
