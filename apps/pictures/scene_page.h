/// HTML pages that show a cloud, its planes and parts in any browser, without installation and without a network.
#pragma once

#include <string>

#include "pictures/picture.h"
#include "pictures/raster_image.h"

namespace pcl_symmetry::apps {

struct PageText {
  std::string title;
  std::string text;          ///< the output of the tool, shown below
  RasterImage picture = {};  ///< image of a camera, shown beside the scene; may be empty
};

/// Writes one self-contained file: the same scene, colors and legend as renderPicture(), one panel at a time. From more
/// than 200 000 points, every second, third, ... one is taken.
/// \throws InputError if no point is finite or the file cannot be written.
void writePage(const PictureScene& scene, const PageText& text, const std::string& path);

}  // namespace pcl_symmetry::apps
