/// Draws the other half of Figure 3 of the paper: the medial axes of planar shapes, which a small bump changes.
#include <algorithm>
#include <cmath>
#include <queue>
#include <string>
#include <vector>

#include "common/command_line/command_line.h"
#include "common/command_line/run_tool.h"
#include "common/pictures/contour_input.h"
#include "common/pictures/raster_image.h"
#include "pcl_symmetry/core/neighbours/closest_point_search.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

/// The sheet that the contour lies in, as square pixels.
struct Sheet {
  int size;
  Eigen::Vector2f low;
  float step;

  Eigen::Vector2f at(int x, int y) const { return low + step * Eigen::Vector2f(x + 0.5f, size - y - 0.5f); }
};

struct ClosestPoints {
  std::vector<Eigen::Vector2f> offset;  ///< from each pixel to the contour
  std::vector<Eigen::Vector2f> point;
};

Sheet sheetAround(const pcl::PointCloud<pcl::PointXYZ>& contour, int size) {
  Eigen::AlignedBox2f box;
  for (const pcl::PointXYZ& p : contour) box.extend(p.getVector3fMap().head<2>());
  const float edge = 1.12f * box.sizes().maxCoeff();
  return {size, box.center() - Eigen::Vector2f::Constant(0.5f * edge), edge / static_cast<float>(size)};
}

ClosestPoints closestPoints(const Sheet& sheet, const pcl::PointCloud<pcl::PointXYZ>& contour) {
  Points points(3, contour.size()), queries(3, sheet.size * sheet.size);
  for (std::size_t i = 0; i < contour.size(); ++i) points.col(i) = contour[i].getVector3fMap();
  for (int i = 0; i < sheet.size * sheet.size; ++i)
    queries.col(i) << sheet.at(i % sheet.size, i / sheet.size), points(2, 0);
  std::vector<int> indices;
  std::vector<float> sq_distances;
  makeTreeSearch(points)->search(queries, 1, indices, sq_distances);
  ClosestPoints closest;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    closest.point.push_back(points.col(indices[i]).head<2>());
    closest.offset.push_back(closest.point.back() - queries.col(static_cast<Eigen::Index>(i)).head<2>());
  }
  return closest;
}

/// Pixels that the corner of the sheet does not reach without crossing the contour.
std::vector<char> inside(const Sheet& sheet, const ClosestPoints& closest) {
  std::vector<char> is_inside(closest.offset.size(), 1);
  std::queue<int> front({0});
  is_inside[0] = 0;
  while (!front.empty()) {
    const int i = front.front(), x = i % sheet.size, y = i / sheet.size;
    front.pop();
    for (const auto& [dx, dy] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
      if (x + dx < 0 || x + dx >= sheet.size || y + dy < 0 || y + dy >= sheet.size) continue;
      const int next = i + dx + dy * sheet.size;
      if (!is_inside[next] || closest.offset[next].norm() < sheet.step) continue;
      is_inside[next] = 0;
      front.push(next);
    }
  }
  return is_inside;
}

/// Where the closest points of neighbouring pixels lie in different directions, there are two closest points between
/// them.
RasterImage draw(const pcl::PointCloud<pcl::PointXYZ>& contour, int size) {
  constexpr float kApart = 0.99f;  // derived: cosine of 8 degrees; chosen: planes closer than that are one
  const Eigen::Vector3d vermilion(0.84, 0.37, 0.0), black(0.0, 0.0, 0.0);
  const Sheet sheet = sheetAround(contour, size);
  const ClosestPoints closest = closestPoints(sheet, contour);
  const std::vector<char> is_inside = inside(sheet, closest);
  RasterImage image(size, size);
  const auto differ = [&](int i, int j) {
    const Eigen::Vector2f &a = closest.offset[i], &b = closest.offset[j];
    return (closest.point[i] - closest.point[j]).norm() > 2.0f * sheet.step && a.dot(b) < kApart * a.norm() * b.norm();
  };
  for (int y = 0; y + 1 < size; ++y)
    for (int x = 0; x + 1 < size; ++x) {
      const int i = y * size + x;
      if (is_inside[i] && closest.offset[i].norm() > sheet.step && (differ(i, i + 1) || differ(i, i + size)))
        image.drawDisk({x + 0.0, y + 0.0}, size / 220.0, black);
    }
  for (const pcl::PointXYZ& p : contour) {
    const Eigen::Vector2f place = (p.getVector3fMap().head<2>() - sheet.low) / sheet.step;
    image.drawDisk({place.x() - 0.5, size - place.y() - 0.5}, size / 220.0, vermilion);
  }
  return image;
}

int run(int argc, char** argv) {
  if (argc < 4) throw UsageError("usage: draw_medial_axis PNG SIZE CONTOUR...");
  const int size = static_cast<int>(parseInteger("SIZE", argv[2], Range::closed(16, 4096)));
  std::vector<RasterImage> images;
  for (int i = 3; i < argc; ++i) images.push_back(draw(*loadContour(argv[i], false), size));
  writeImage(sideBySide(images), argv[1]);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
