#include "bop/surface_colours.h"

#include <algorithm>
#include <array>
#include <boost/filesystem.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <mutex>
#include <vector>

#include "pictures/raster_image.h"

namespace pcl_symmetry::apps {

namespace {

// Points of a surface with a texture. chosen: ten times those that ask for colours; half blurs thin lines, twice takes
// twice the memory.
constexpr int kTexturedPoints = 100'000;
constexpr int kMostHeaderLines = 1000;  // chosen: headers have tens of lines; the rest of a file may be binary

const pcl::PCLPointField* fieldOf(const pcl::PCLPointCloud2& cloud, const std::vector<const char*>& names) {
  for (const pcl::PCLPointField& field : cloud.fields)
    for (const char* name : names)
      if (field.name == name) return &field;
  return nullptr;
}

template <typename Number>
Number valueOf(const pcl::PCLPointCloud2& cloud, const pcl::PCLPointField& field, std::size_t i) {
  Number value;
  std::memcpy(&value, cloud.data.data() + i * cloud.point_step + field.offset, sizeof(value));
  return value;
}

SurfaceColours vertexColours(const Shape& shape, const pcl::PCLPointField& field) {
  SurfaceColours colours;
  colours.points.resize(3, static_cast<Eigen::Index>(shape.points->size()));
  colours.rgb.resize(3, colours.points.cols());
  Eigen::Index size = 0;
  for (std::size_t i = 0; i < shape.points->size(); ++i) {
    if (!(*shape.points)[i].getVector3fMap().allFinite()) continue;
    const auto packed = valueOf<std::uint32_t>(shape.cloud, field, i);
    colours.points.col(size) = (*shape.points)[i].getVector3fMap();
    colours.rgb.col(size++) << static_cast<float>((packed >> 16) & 255) / 255.0f,
        static_cast<float>((packed >> 8) & 255) / 255.0f, static_cast<float>(packed & 255) / 255.0f;
  }
  colours.points.conservativeResize(3, size);
  colours.rgb.conservativeResize(3, size);
  return colours;
}

/// Coordinates of the vertices in a texture, u to the right and v upwards.
std::optional<Eigen::Matrix2Xf> textureCoordinates(const pcl::PCLPointCloud2& cloud) {
  const pcl::PCLPointField* u = fieldOf(cloud, {"texture_u", "s", "u"});
  const pcl::PCLPointField* v = fieldOf(cloud, {"texture_v", "t", "v"});
  if (!u || !v || u->datatype != pcl::PCLPointField::FLOAT32 || v->datatype != pcl::PCLPointField::FLOAT32) return {};
  Eigen::Matrix2Xf coordinates(2, static_cast<Eigen::Index>(cloud.width) * cloud.height);
  for (Eigen::Index i = 0; i < coordinates.cols(); ++i)
    coordinates.col(i) << valueOf<float>(cloud, *u, static_cast<std::size_t>(i)),
        valueOf<float>(cloud, *v, static_cast<std::size_t>(i));
  return coordinates;
}

/// The picture that the header of a PLY file names; empty where it names none.
std::string texturePath(const std::string& path) {
  const std::string comment = "comment TextureFile ";
  std::ifstream file(path, std::ios::binary);
  std::string line;
  for (int k = 0; k < kMostHeaderLines && std::getline(file, line); ++k) {
    while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back()))) line.pop_back();
    if ((k == 0 && line != "ply") || line == "end_header") break;
    if (line.compare(0, comment.size(), comment) == 0)
      return (boost::filesystem::path(path).parent_path() / line.substr(comment.size())).string();
  }
  return "";
}

/// Only one thread at a time reads pictures.
RasterImage readOneAtATime(const std::string& path) {
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  return readImage(path);
}

Eigen::Vector3f colourAt(const RasterImage& image, const Eigen::Vector2f& uv) {
  // Textures repeat.
  const Eigen::Vector2f in = uv.array() - uv.array().floor();
  const int x = std::min(image.width - 1, static_cast<int>(in.x() * static_cast<float>(image.width)));
  const int y = std::min(image.height - 1, static_cast<int>((1.0f - in.y()) * static_cast<float>(image.height)));
  const std::uint8_t* pixel = image.at(x, y);
  return Eigen::Vector3f(pixel[0], pixel[1], pixel[2]) / 255.0f;
}

/// A corner of a triangle: place and texture coordinates.
using Corner = Eigen::Matrix<float, 5, 1>;

/// The triangles of a mesh, polygons cut into fans; those with places or coordinates that are not finite are left out.
std::vector<std::array<Corner, 3>> texturedTriangles(const Shape& shape, const Eigen::Matrix2Xf& coordinates) {
  std::vector<std::array<Corner, 3>> triangles;
  const auto corner = [&](std::uint32_t i) {
    Corner result;
    result << (*shape.points)[i].getVector3fMap(), coordinates.col(i);
    return result;
  };
  for (const pcl::Vertices& polygon : shape.mesh->polygons)
    for (std::size_t k = 2; k < polygon.vertices.size(); ++k) {
      triangles.push_back({corner(polygon.vertices[0]), corner(polygon.vertices[k - 1]), corner(polygon.vertices[k])});
      const auto& added = triangles.back();
      if (!added[0].allFinite() || !added[1].allFinite() || !added[2].allFinite()) triangles.pop_back();
    }
  return triangles;
}

float areaOf(const std::array<Corner, 3>& t) {
  return 0.5f * (t[1] - t[0]).head<3>().cross((t[2] - t[0]).head<3>()).norm();
}

/// Points of a triangle at the centers of equal parts.
void addPoints(const std::array<Corner, 3>& t, int parts, const RasterImage& image,
               std::vector<Eigen::Vector3f>& points, std::vector<Eigen::Vector3f>& rgb) {
  for (int i = 0; i < parts; ++i)
    for (int j = 0; i + j < parts; ++j) {
      const float a = (static_cast<float>(i) + 1.0f / 3.0f) / static_cast<float>(parts);
      const float b = (static_cast<float>(j) + 1.0f / 3.0f) / static_cast<float>(parts);
      const Corner at = t[0] + a * (t[1] - t[0]) + b * (t[2] - t[0]);
      points.push_back(at.head<3>());
      rgb.push_back(colourAt(image, at.tail<2>()));
    }
}

SurfaceColours textureColours(const Shape& shape, const Eigen::Matrix2Xf& coordinates, const RasterImage& image) {
  const std::vector<std::array<Corner, 3>> triangles = texturedTriangles(shape, coordinates);
  double area = 0.0;
  for (const auto& triangle : triangles) area += areaOf(triangle);
  std::vector<Eigen::Vector3f> points, rgb;
  for (const auto& triangle : triangles) {
    // derived: p (p + 1) / 2 points for p parts of an edge
    const double share = area > 0.0 ? areaOf(triangle) / area : 0.0;
    addPoints(triangle, std::max(1, static_cast<int>(std::lround(std::sqrt(2.0 * kTexturedPoints * share)))), image,
              points, rgb);
  }
  SurfaceColours colours;
  colours.points.resize(3, static_cast<Eigen::Index>(points.size()));
  colours.rgb.resize(3, colours.points.cols());
  for (Eigen::Index i = 0; i < colours.points.cols(); ++i) {
    colours.points.col(i) = points[static_cast<std::size_t>(i)];
    colours.rgb.col(i) = rgb[static_cast<std::size_t>(i)];
  }
  return colours;
}

}  // namespace

bool hasColours(const Shape& shape) {
  return fieldOf(shape.cloud, {"rgb", "rgba"}) || fieldOf(shape.cloud, {"texture_u", "s", "u"});
}

std::optional<SurfaceColours> surfaceColours(const Shape& shape, const std::string& path) {
  if (const pcl::PCLPointField* field = fieldOf(shape.cloud, {"rgb", "rgba"})) {
    SurfaceColours colours = vertexColours(shape, *field);
    return colours.points.cols() > 0 ? std::optional(std::move(colours)) : std::nullopt;
  }
  const std::optional<Eigen::Matrix2Xf> coordinates = textureCoordinates(shape.cloud);
  const std::string texture = coordinates && shape.mesh ? texturePath(path) : "";
  if (texture.empty()) return {};
  SurfaceColours colours = textureColours(shape, *coordinates, readOneAtATime(texture));
  return colours.points.cols() > 0 ? std::optional(std::move(colours)) : std::nullopt;
}

}  // namespace pcl_symmetry::apps
