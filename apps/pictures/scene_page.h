/// Pages of HTML that show a cloud, its planes and parts in any browser, without an installation and without network.
#pragma once

#include <string>

#include "pictures/picture.h"
#include "pictures/raster_image.h"

namespace pcl_symmetry::apps {

struct PageText {
  std::string title;
  std::string text;          ///< the output of the tool, shown below
  RasterImage picture = {};  ///< of a camera, shown beside the scene; empty for none
};

/// Writes one file, with everything in it: the same scene, colors and legend as renderPicture(), a panel at a time. Of
/// more than 200 000 points it holds every second, third, ... one.
/// \throws InputError if no point is finite or the file cannot be written.
void writePage(const PictureScene& scene, const PageText& text, const std::string& path);

}  // namespace pcl_symmetry::apps
