/// Reads CT, MR and other volumes with VTK: NIfTI, NRRD, MetaImage and VTK images.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/exact_coordinates.h"
#include "pcl_symmetry/core/scalar_grid.h"

namespace pcl_symmetry::apps {

/// The endings of files that loadVolume() reads.
inline const char* const kVolumeFiles = ".nii, .nii.gz, .nrrd, .nhdr, .mha, .mhd or .vti";

/// \return whether the name ends in one of kVolumeFiles, in capitals or not.
bool isVolumePath(const std::string& path);

/// A volume in the physical frame of its file: RAS for NIfTI, that of the header otherwise.
struct Volume {
  std::shared_ptr<ScalarGrid> grid;
  std::vector<std::string> left_out;  ///< what the file holds beyond that, such as later times
};

/// \throws InputError naming the file where it is no volume, or cut off.
Volume loadVolume(const std::string& path);

// In the module of VTK.
extern "C" {
void readVolume(const std::string& path, Volume& volume);
/// The surface on which the volume has a value (flying edges).
void contourVolume(const ScalarGrid& grid, double value, ExactShape& surface);
}

}  // namespace pcl_symmetry::apps
