#include "pictures/contour_input.h"

#include "io/shape_input.h"

namespace pcl_symmetry::apps {

pcl::PointCloud<pcl::PointXYZ>::Ptr contourOfImage(const RasterImage& image, bool filled, const std::string& name) {
  const auto dark = [&](int x, int y) {
    const std::uint8_t* const pixel = image.at(x, y);
    return pixel[0] + pixel[1] + pixel[2] < 3 * 128;
  };
  int num_border = 0, num_dark = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (x > 0 && y > 0 && x + 1 < image.width && y + 1 < image.height) continue;
      ++num_border;
      num_dark += dark(x, y) ? 1 : 0;
    }
  }
  const bool ground = 2 * num_dark > num_border;
  const auto inside = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < image.width && y < image.height && dark(x, y) != ground;
  };
  pcl::PointCloud<pcl::PointXYZ>::Ptr contour(new pcl::PointCloud<pcl::PointXYZ>);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (!inside(x, y)) continue;
      if (!filled && inside(x - 1, y) && inside(x + 1, y) && inside(x, y - 1) && inside(x, y + 1)) continue;
      contour->emplace_back(static_cast<float>(x), static_cast<float>(image.height - 1 - y), 0.0f);
    }
  }
  if (contour->empty())
    throw InputError(name + ": shows nothing, must hold dark pixels on light ground or light on dark");
  return contour;
}

pcl::PointCloud<pcl::PointXYZ>::Ptr loadContour(const std::string& path, bool filled) {
  return isImagePath(path) ? contourOfImage(readImage(path), filled, path) : loadShape(path).points;
}

}  // namespace pcl_symmetry::apps
