#include "bop/color_symmetry.h"

#include <algorithm>
#include <array>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem.hpp>
#include <cmath>
#include <cstring>
#include <fstream>
#include <utility>

#include "core/base/constants.h"
#include "core/geometry/directions.h"
#include "pcl_symmetry/core/closest_point_search.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pictures/raster_image.h"

namespace pcl_symmetry::apps {

namespace {

constexpr double kMostChanged = 0.05;  // greatest share of the surface whose color a symmetry may change
constexpr int kNumColorsNear = 4;      // samples around a position that may have its color
constexpr int kNumTurns = 8;           // rotations that represent all rotations about an axis
constexpr int kMaxFold = 24;           // greatest fold of stripes

/// CIELAB of an sRGB color under D65.
/// \param rgb in [0, 1].
/// \return L in [0, 100], a, b.
Eigen::Vector3f labOf(const Eigen::Vector3f& rgb) {
  // The transfer curve of sRGB (IEC 61966-2-1), its primaries, and CIELAB relative to D65.
  const auto linear = [](float c) { return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f); };
  Eigen::Matrix3f xyz_rgb;
  xyz_rgb << 0.4124f, 0.3576f, 0.1805f, 0.2126f, 0.7152f, 0.0722f, 0.0193f, 0.1192f, 0.9505f;
  const Eigen::Vector3f white(0.9505f, 1.0f, 1.089f);
  const Eigen::Vector3f xyz = (xyz_rgb * rgb.unaryExpr(linear)).cwiseQuotient(white);
  const auto curve = [](float t) { return t > 0.008856f ? std::cbrt(t) : 7.787f * t + 16.0f / 116.0f; };
  const Eigen::Vector3f f = xyz.unaryExpr(curve);
  return {116.0f * f.y() - 16.0f, 500.0f * (f.x() - f.y()), 200.0f * (f.y() - f.z())};
}

/// Samples of a surface with the colors next to them.
class ColoredSurface {
public:
  ColoredSurface(const SurfaceColors& colors, Points points, double tolerance)
      : points_(std::move(points)), tolerance_(tolerance), search_(makeFlannSearch(points_)) {
    std::vector<int> closest;
    std::vector<float> ignored;
    makeFlannSearch(colors.points)->search(points_, 1, closest, ignored);
    lab_.resize(3, points_.cols());
    for (Eigen::Index i = 0; i < points_.cols(); ++i)
      lab_.col(i) = labOf(colors.rgb.col(closest[static_cast<std::size_t>(i)]));
  }

  /// Share of the surface on which a motion changes the color by more than the tolerance.
  double changedShare(const Eigen::Isometry3d& motion) const {
    const Points moved = (motion.cast<float>() * points_.colwise().homogeneous()).eval();
    std::vector<int> closest;
    std::vector<float> ignored;
    const int num_near = std::min(kNumColorsNear, static_cast<int>(points_.cols()));
    search_->search(moved, num_near, closest, ignored);
    Eigen::Index num_changed = 0;
    for (Eigen::Index i = 0; i < moved.cols(); ++i) {
      float least = (lab_.col(i) - lab_.col(closest[i * num_near])).norm();
      for (int k = 1; k < num_near; ++k)
        least = std::min(least, (lab_.col(i) - lab_.col(closest[i * num_near + k])).norm());
      num_changed += least > tolerance_;
    }
    return static_cast<double>(num_changed) / static_cast<double>(moved.cols());
  }

  /// Whether a motion changes the color of no more than 5 % of the surface.
  bool keeps(const Eigen::Isometry3d& motion) const { return changedShare(motion) <= kMostChanged; }

private:
  Points points_;
  Eigen::Matrix3Xf lab_;
  double tolerance_;
  ClosestPointSearch::Ptr search_;
};

/// The motions that keep the colors and form a group: the worst ones are removed until the others do.
ObjectSymmetries finiteGroup(const std::vector<Eigen::Isometry3d>& motions, const ColoredSurface& surface) {
  std::vector<std::pair<double, std::size_t>> kept;  // changed share and index
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const double changed = surface.changedShare(motions[i]);
    if (changed <= kMostChanged) kept.emplace_back(changed, i);
  }
  std::sort(kept.begin(), kept.end());
  for (; !kept.empty(); kept.pop_back()) {
    std::vector<Eigen::Isometry3d> rest;
    for (const auto& [changed, i] : kept) rest.push_back(motions[i]);
    try {
      const ObjectSymmetries group = ObjectSymmetries::from(rest, {});
      if (group.discrete.size() == rest.size()) return group;
    } catch (const std::invalid_argument&) {
    }
  }
  return ObjectSymmetries::from({}, {});
}

/// The rotations about an axis by the greatest number of equal steps that keep the colors.
std::vector<Eigen::Isometry3d> keptTurns(const ContinuousSymmetry& axis, const ColoredSurface& surface) {
  for (int fold = kMaxFold; fold > 1; --fold) {
    std::vector<Eigen::Isometry3d> turns;
    for (int k = 1; k < fold; ++k) turns.push_back(motionAbout({axis.offset, axis.axis}, 2.0 * kPi * k / fold));
    if (std::all_of(turns.begin(), turns.end(), [&](const auto& turn) { return surface.keeps(turn); })) return turns;
  }
  return {};
}

/// The half turn about a line perpendicular to an axis that changes least.
Eigen::Isometry3d bestFlip(const ContinuousSymmetry& axis, const ColoredSurface& surface) {
  constexpr int kNumLines = 90;
  const Eigen::Vector3d across = axis.axis.unitOrthogonal();
  Eigen::Isometry3d best = motionAbout({axis.offset, across}, kPi);
  double least = surface.changedShare(best);
  for (int k = 1; k < kNumLines; ++k) {
    const Eigen::Isometry3d flip =
        motionAbout({axis.offset, rotationAbout(axis.axis, kPi * k / kNumLines) * across}, kPi);
    const double changed = surface.changedShare(flip);
    if (changed >= least) continue;
    least = changed;
    best = flip;
  }
  return best;
}

ObjectSymmetries roundGroup(const ObjectSymmetries& found, const ColoredSurface& surface) {
  const ContinuousSymmetry& axis = found.continuous.front();
  bool is_round = true;
  for (int k = 1; k <= kNumTurns && is_round; ++k)
    is_round = surface.keeps(motionAbout({axis.offset, axis.axis}, 2.0 * kPi * goldenFraction(k)));
  std::vector<Eigen::Isometry3d> kept = is_round ? std::vector<Eigen::Isometry3d>{} : keptTurns(axis, surface);
  if (!found.discrete.empty()) {
    const Eigen::Isometry3d flip = bestFlip(axis, surface);
    if (surface.keeps(flip)) kept.push_back(flip);
  }
  return ObjectSymmetries::from(kept, is_round ? found.continuous : std::vector<ContinuousSymmetry>{});
}

/// For a ball with a pattern, only rotations about the coordinate axes are searched.
ObjectSymmetries sphereGroup(const ObjectSymmetries& found, const ColoredSurface& surface) {
  std::vector<Eigen::Isometry3d> turns;
  for (const Eigen::Vector3d& direction : evenDirections(kNumTurns))
    turns.push_back(
        motionAbout({found.center, direction}, 2.0 * kPi * goldenFraction(static_cast<int>(turns.size()) + 1)));
  if (std::all_of(turns.begin(), turns.end(), [&](const auto& turn) { return surface.keeps(turn); })) return found;
  for (int k = 0; k < 3; ++k) {
    ObjectSymmetries one_axis = found;
    one_axis.continuous = {found.continuous[static_cast<std::size_t>(k)]};
    one_axis.discrete = {motionAbout({found.center, one_axis.continuous[0].axis.unitOrthogonal()}, kPi)};
    const ObjectSymmetries group = roundGroup(one_axis, surface);
    if (group.name() != "C1") return group;
  }
  return ObjectSymmetries::from({}, {});
}

constexpr int kTexturedPoints = 100'000;  // points of a surface with a texture
constexpr int kMostHeaderLines = 1000;

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

SurfaceColors vertexColors(const Shape& shape, const pcl::PCLPointField& field) {
  std::vector<std::size_t> finite;
  SurfaceColors colors{finitePoints(*shape.points, &finite), {}};
  colors.rgb.resize(3, colors.points.cols());
  for (std::size_t k = 0; k < finite.size(); ++k) {
    const auto packed = valueOf<std::uint32_t>(shape.cloud, field, finite[k]);
    colors.rgb.col(k) = Eigen::Vector3f((packed >> 16) & 255, (packed >> 8) & 255, packed & 255) / 255.0f;
  }
  return colors;
}

/// Texture coordinates of the vertices, u to the right and v upwards.
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

/// The texture that the header of a PLY file names; empty if it names none.
std::string texturePath(const std::string& path) {
  const std::string comment = "comment TextureFile ";
  std::ifstream file(path, std::ios::binary);
  std::string line;
  for (int k = 0; k < kMostHeaderLines && std::getline(file, line); ++k) {
    boost::algorithm::trim_right(line);
    if ((k == 0 && line != "ply") || line == "end_header") break;
    if (boost::algorithm::starts_with(line, comment))
      return (boost::filesystem::path(path).parent_path() / line.substr(comment.size())).string();
  }
  return "";
}

Eigen::Vector3f colorAt(const RasterImage& image, const Eigen::Vector2f& uv) {
  // Textures repeat.
  const Eigen::Vector2f in = uv.array() - uv.array().floor();
  const int x = std::min(image.width - 1, static_cast<int>(in.x() * static_cast<float>(image.width)));
  const int y = std::min(image.height - 1, static_cast<int>((1.0f - in.y()) * static_cast<float>(image.height)));
  const std::uint8_t* pixel = image.at(x, y);
  return Eigen::Vector3f(pixel[0], pixel[1], pixel[2]) / 255.0f;
}

/// A corner of a triangle: position and texture coordinates.
using Corner = Eigen::Matrix<float, 5, 1>;

/// The triangles of a mesh without those whose positions or coordinates are not finite.
std::vector<std::array<Corner, 3>> texturedTriangles(const Shape& shape, const Eigen::Matrix2Xf& coordinates) {
  std::vector<std::array<Corner, 3>> triangles;
  const auto corner = [&](int i) {
    Corner result;
    result << (*shape.points)[i].getVector3fMap(), coordinates.col(i);
    return result;
  };
  for (const Eigen::Vector3i& indices : detail::toArrays(*shape.mesh).triangles) {
    const std::array<Corner, 3> triangle{corner(indices[0]), corner(indices[1]), corner(indices[2])};
    if (triangle[0].allFinite() && triangle[1].allFinite() && triangle[2].allFinite()) triangles.push_back(triangle);
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
      rgb.push_back(colorAt(image, at.tail<2>()));
    }
}

SurfaceColors textureColors(const Shape& shape, const Eigen::Matrix2Xf& coordinates, const RasterImage& image) {
  const std::vector<std::array<Corner, 3>> triangles = texturedTriangles(shape, coordinates);
  double area = 0.0;
  for (const auto& triangle : triangles) area += areaOf(triangle);
  std::vector<Eigen::Vector3f> points, rgb;
  for (const auto& triangle : triangles) {
    // p (p + 1) / 2 points for p parts of an edge
    const double share = area > 0.0 ? areaOf(triangle) / area : 0.0;
    addPoints(triangle, std::max(1, static_cast<int>(std::lround(std::sqrt(2.0 * kTexturedPoints * share)))), image,
              points, rgb);
  }
  const auto columns = [](const std::vector<Eigen::Vector3f>& all) {
    return Points(Eigen::Map<const Points>(reinterpret_cast<const float*>(all.data()), 3, all.size()));
  };
  return {columns(points), columns(rgb)};
}

}  // namespace

ObjectSymmetries keepingColors(const ObjectSymmetries& found, const SurfaceColors& colors, const Points& points,
                               double tolerance) {
  const ColoredSurface surface(colors, points, tolerance);
  ObjectSymmetries kept;
  if (found.kind == RotationGroupKind::Spherical)
    kept = sphereGroup(found, surface);
  else if (isContinuous(found.kind))
    kept = roundGroup(found, surface);
  else
    kept = finiteGroup(found.discrete, surface);
  // The support and limits that the shape's symmetries have also hold for the remaining ones; their axes pass through
  // the same point.
  kept.support = found.support;
  kept.confidence = found.confidence;
  kept.timing_ms = found.timing_ms;
  kept.center = found.center;
  for (ContinuousSymmetry& symmetry : kept.continuous) symmetry.offset = found.center;
  return kept;
}

bool hasColors(const Shape& shape) {
  return fieldOf(shape.cloud, {"rgb", "rgba"}) || fieldOf(shape.cloud, {"texture_u", "s", "u"});
}

std::optional<SurfaceColors> surfaceColors(const Shape& shape, const std::string& path) {
  if (const pcl::PCLPointField* field = fieldOf(shape.cloud, {"rgb", "rgba"})) {
    SurfaceColors colors = vertexColors(shape, *field);
    return colors.points.cols() > 0 ? std::optional(std::move(colors)) : std::nullopt;
  }
  const std::optional<Eigen::Matrix2Xf> coordinates = textureCoordinates(shape.cloud);
  const std::string texture = coordinates && shape.mesh ? texturePath(path) : "";
  if (texture.empty()) return {};
  SurfaceColors colors = textureColors(shape, *coordinates, readImage(texture));
  return colors.points.cols() > 0 ? std::optional(std::move(colors)) : std::nullopt;
}

}  // namespace pcl_symmetry::apps
