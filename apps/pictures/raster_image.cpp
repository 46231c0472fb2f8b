#include "pictures/raster_image.h"

#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <cmath>

#include "io/file_text.h"
#include "io/load_module.h"
#include "io/shape_output.h"
#include "pictures/drawing.h"

namespace pcl_symmetry::apps {

void RasterImage::set(int x, int y, const Eigen::Vector3d& color) {
  std::memcpy(at(x, y), bytesOf(color).data(), 3);
}

void RasterImage::drawDisk(const Eigen::Vector2d& center, double radius, const Eigen::Vector3d& color) {
  radius = std::max(radius, (center - center.array().round().matrix()).norm());
  const int x_end = std::min(width - 1, static_cast<int>(std::floor(center.x() + radius)));
  const int y_end = std::min(height - 1, static_cast<int>(std::floor(center.y() + radius)));
  for (int y = std::max(0, static_cast<int>(std::ceil(center.y() - radius))); y <= y_end; ++y)
    for (int x = std::max(0, static_cast<int>(std::ceil(center.x() - radius))); x <= x_end; ++x)
      if ((Eigen::Vector2d(x, y) - center).squaredNorm() <= radius * radius) set(x, y, color);
}

RasterImage sideBySide(const std::vector<RasterImage>& tiles, int num_columns) {
  constexpr int kGap = 4;  // pixels between pictures
  const int num = static_cast<int>(tiles.size()), columns = num_columns > 0 ? std::min(num_columns, num) : num;
  const int rows = (num + columns - 1) / columns, width = tiles[0].width + kGap, height = tiles[0].height + kGap;
  RasterImage image(columns * width - kGap, rows * height - kGap);
  for (int i = 0; i < num; ++i)
    for (int row = 0; row < tiles[i].height; ++row)
      std::memcpy(image.at(i % columns * width, i / columns * height + row), tiles[i].at(0, row),
                  3 * std::size_t(tiles[i].width));
  return image;
}

RasterImage readImage(const std::string& path) {
  const std::string content = readWholeFile(path);
  const bool png = boost::algorithm::iends_with(path, ".png");
  if (!boost::algorithm::starts_with(content, png ? "\x89PNG" : "P5"))
    throw InputError(path + ": is no picture, must be a PNG or binary PGM file");
  RasterImage image;
  functionOf<decltype(decodeImage)>(kDrawingModule, "decodeImage")(path, png, image);
  return image;
}

void writeImage(const RasterImage& image, const std::string& path) {
  writeAtomically(path, [&](const std::string& temporary) {
    functionOf<decltype(encodeImage)>(kDrawingModule, "encodeImage")(image, path, temporary);
  });
}

void writeVolume(const VolumeImage& volume, const std::string& path) {
  writeAtomically(path, [&](const std::string& temporary) {
    functionOf<decltype(encodeVolume)>(kDrawingModule, "encodeVolume")(volume, path, temporary);
  });
}

}  // namespace pcl_symmetry::apps
