/// What draws: VTK, in a module that is loaded when the first picture is asked for.
///
/// VTK's libraries take longer to load than a tool takes to find planes. The functions of common/pictures are what
/// tools call; they check, name the file and come here.
#pragma once

#include <string>
#include <vector>

#include "pictures/chart.h"
#include "pictures/picture.h"
#include "pictures/raster_image.h"
#include "pictures/volume_image.h"

namespace pcl_symmetry::apps {

/// Where a picture goes.
struct PictureTarget {
  std::string name;   ///< in error messages
  std::string file;   ///< that is written
  int width, height;  ///< pixels
};

/// Implemented by the module pcl_symmetry_drawing.so. All throw InputError naming the file where they fail.
class Drawing {
public:
  virtual ~Drawing() = default;
  /// \param scenes checked.
  virtual void drawScenes(const std::vector<PictureScene>& scenes, const PictureTarget& target,
                          int num_columns) const = 0;
  /// \param chart both of its ranges are set.
  virtual void drawChart(const Chart& chart, const PictureTarget& target) const = 0;
  virtual RasterImage decodeImage(const std::string& path, bool png) const = 0;
  virtual void encodeImage(const RasterImage& image, const std::string& path, const std::string& file) const = 0;
  virtual void encodeVolume(const VolumeImage& volume, const std::string& path, const std::string& file) const = 0;
};

/// Loads the module at the first call. Only one thread at a time draws.
/// \throws InputError where it is missing or that of another version.
const Drawing& drawing();

}  // namespace pcl_symmetry::apps
