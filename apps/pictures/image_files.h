/// Pictures and volumes read and written by VTK.
#pragma once

#include "common/modules/drawing.h"

namespace pcl_symmetry::apps {

/// As the methods of Drawing of the same names.
RasterImage decodeImage(const std::string& path, bool png);
void encodeImage(const RasterImage& image, const std::string& path, const std::string& file);
void encodeVolume(const VolumeImage& volume, const std::string& path, const std::string& file);

}  // namespace pcl_symmetry::apps
