/// Values on a box of cells, for ParaView and other viewers of volumes.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace pcl_symmetry::apps {

struct VolumeImage {
  std::string name;           ///< of the values
  Eigen::Array3i size;        ///< cells along x, y and z
  Eigen::Vector3d origin;     ///< center of cell (0, 0, 0), input frame
  double cell_size;           ///< edge, input units
  std::vector<float> values;  ///< one per cell, x running fastest
};

/// Writes a VTK image (.vti) whole.
/// \throws InputError if the file cannot be written.
void writeVolume(const VolumeImage& volume, const std::string& path);

}  // namespace pcl_symmetry::apps
