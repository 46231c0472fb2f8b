/// Drawing by VTK, in the module pcl_symmetry_drawing. Tools call the functions of pictures/picture.h, which check
/// their arguments and come here through functionOf(). Only one thread at a time draws.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "pictures/picture.h"
#include "pictures/raster_image.h"

namespace pcl_symmetry::apps {

inline constexpr const char* kDrawingModule = "pcl_symmetry_drawing";

/// The output of a picture.
struct PictureTarget {
  std::string name;   ///< name in error messages
  std::string file;   ///< file that is written
  int width, height;  ///< pixels
};

/// Guards drawing, because VTK has global state.
inline std::mutex drawing_mutex;

/// \return whether DISPLAY names an X server that draws with OpenGL.
bool hasDisplay();

/// \throws InputError unless there is a display; tools look for one when they start, see runTool().
/// \param name name of the picture.
void requireDisplay(const std::string& name);

/// All throw InputError naming the file if they fail.
extern "C" {
void drawScenes(const std::vector<PictureScene>& scenes, const PictureTarget& target, int num_columns);
void decodeImage(const std::string& path, bool png, RasterImage& image);
/// The pixels of an image of one channel of 16 bits: column, row and value.
void decodeDepth(const std::string& path, Cloud& pixels);
void encodeImage(const RasterImage& image, const std::string& path, const std::string& file);
void encodeVolume(const VolumeImage& volume, const std::string& path, const std::string& file);
}

}  // namespace pcl_symmetry::apps
