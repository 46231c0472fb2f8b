#include "bop/model_analysis.h"

#include <pcl/conversions.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <boost/filesystem.hpp>
#include <cstdint>
#include <cstdio>

#include "bop/exact_diameter.h"
#include "command_line/tool_errors.h"
#include "core/geometry/point_samples.h"
#include "io/answers.h"
#include "io/exact_coordinates.h"
#include "io/shape_output.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/mesh_sampling.h"

namespace pcl_symmetry::apps {

namespace {

constexpr int kEvidencePoints = 20'000;  // points spread over a mesh to measure distances

void shiftBack(ObjectSymmetries& symmetries, const Eigen::Vector3d& shift) {
  if (shift.isZero(0.0)) return;
  symmetries.center += shift;
  for (Eigen::Isometry3d& symmetry : symmetries.discrete) symmetry = shiftedBack(symmetry, shift, shift);
  for (ContinuousSymmetry& symmetry : symmetries.continuous) symmetry.offset += shift;
  for (RejectedRotation& rejected : symmetries.rejected) {
    rejected.motion = shiftedBack(rejected.motion, shift, shift);
    rejected.where += shift;
  }
}

ListedSymmetries shifted(ListedSymmetries listed, const Eigen::Vector3d& shift) {
  for (Eigen::Isometry3d& motion : listed.discrete) motion = shiftedBack(motion, -shift, -shift);
  for (ContinuousSymmetry& symmetry : listed.continuous) symmetry.offset -= shift;
  return listed;
}

Points sampled(const Shape& shape, const Points& vertices, int num_points, std::uint64_t seed) {
  return shape.mesh ? finitePoints(*sampleMesh(*shape.mesh, num_points, seed)) : vertices;
}

// Greatest number of rejected candidates that are reported, the least failures first.
constexpr int kMostRejections = 3;
constexpr double kFarFailure = 10.0;  // tolerances; as in ObjectSymmetryOptions::max_feature

pcl::PointXYZRGB coloredPoint(const Eigen::Vector3f& x, double distance, double tolerance) {
  // Gray, vermilion and purple of Okabe and Ito, which color-blind readers distinguish.
  const auto color = [](std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
    return pcl::PointXYZRGB(red, green, blue);
  };
  pcl::PointXYZRGB point = distance <= tolerance                 ? color(190, 190, 190)
                           : distance <= kFarFailure * tolerance ? color(213, 94, 0)
                                                                 : color(117, 36, 107);
  point.getVector3fMap() = x;
  return point;
}

/// Prints the groups at half and twice the tolerance, and the rejected rotations with the least failure.
/// \param digits significant digits of lengths.
void printRejections(const ObjectSymmetries& symmetries, int digits) {
  if (symmetries.at_half_tolerance && symmetries.at_twice_tolerance)
    std::printf("  tolerance %.3g  at half of it %s, at twice %s\n", symmetries.tolerance,
                symmetries.at_half_tolerance->name().c_str(), symmetries.at_twice_tolerance->name().c_str());
  const std::size_t count = std::min<std::size_t>(kMostRejections, symmetries.rejected.size());
  for (std::size_t i = 0; i < count; ++i) {
    const RejectedRotation& rejected = symmetries.rejected[i];
    std::printf("  rejected %s about %9.6f %9.6f %9.6f: %.1f %% of the surface off, %.1f %% far off, about %s\n",
                rejected.fold == 0 ? "any angle" : ("fold " + std::to_string(rejected.fold)).c_str(), rejected.axis.x(),
                rejected.axis.y(), rejected.axis.z(), 100.0 * rejected.off, 100.0 * rejected.far,
                spelled(rejected.where, digits).c_str());
  }
}

/// Writes PREFIX_rejected_1.ply and so on: the surface, with what a rejected rotation maps off it in red beyond the
/// tolerance, in purple beyond ten; gray is mapped onto the surface.
/// \param surface in the frame of the symmetries.
/// \param shift vector that is added to the points.
/// \throws InputError if a file cannot be written.
void writeRejections(const std::string& prefix, const ObjectSymmetries& symmetries, const SurfaceEvidence& surface,
                     const Eigen::Vector3d& shift) {
  const std::size_t count = std::min<std::size_t>(kMostRejections, symmetries.rejected.size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::vector<float> distances = surface.distances(symmetries.rejected[i].motion);
    pcl::PointCloud<pcl::PointXYZRGB> points;
    for (std::size_t k = 0; k < distances.size(); ++k) {
      const Eigen::Vector3d x = surface.points().col(static_cast<Eigen::Index>(k)).cast<double>() + shift;
      points.push_back(coloredPoint(x.cast<float>(), distances[k], surface.tolerance()));
    }
    pcl::PCLPointCloud2 cloud;
    pcl::toPCLPointCloud2(points, cloud);
    saveCloud(prefix + "_rejected_" + std::to_string(i + 1) + ".ply", cloud, Eigen::Vector4f::Zero(),
              Eigen::Quaternionf::Identity());
  }
}

/// Colors and the given file, in the frame of the shifted points.
void compare(ModelInfo& info, const Shape& shape, const Points& vertices, const ModelOptions& options,
             const std::optional<ListedSymmetries>& given) {
  const std::optional<SurfaceColors> colors =
      options.use_colors ? surfaceColors(shape, info.file) : std::optional<SurfaceColors>();
  info.has_unread_colors = hasColors(shape) && !colors;
  const std::uint64_t seed = options.symmetries.seed;
  if (colors) {
    const Points points = sampled(shape, vertices, options.mesh_points, seed);
    const std::string before = info.symmetries.name();
    info.symmetries = keepingColors(info.symmetries, *colors, points, options.color_tolerance);
    if (info.symmetries.name() != before) info.group_without_colors = before;
  }
  if (!given && !options.failures_folder) return;
  const int num_points = std::max(options.mesh_points, kEvidencePoints);
  const ObjectSymmetryOptions& limits = options.symmetries;
  const double tolerance =
      limits.absolute_tolerance > 0.0 ? limits.absolute_tolerance : limits.tolerance * info.diameter;
  const SurfaceEvidence surface(sampled(shape, vertices, num_points, seed), tolerance);
  if (options.failures_folder) {
    const boost::filesystem::path folder(*options.failures_folder), name(boost::filesystem::path(info.file).stem());
    boost::system::error_code ignored;  // saveCloud() reports the missing folder
    boost::filesystem::create_directories(folder, ignored);
    writeRejections((folder / name).string(), info.symmetries, surface, shape.shift);
  }
  if (given) {
    info.check = checkSymmetries(shifted(*given, shape.shift), info.symmetries, surface, info.diameter);
    for (Disagreement& disagreement : info.check->disagreements) disagreement.point += shape.shift;
  }
}

}  // namespace

ModelInfo analyzeModel(const std::string& path, const ModelOptions& options,
                       const std::optional<ListedSymmetries>& given) {
  const Shape shape = loadShape(path);
  const Points finite = finitePoints(*shape.points), vertices = shape.mesh ? finite : withoutStrayPoints(finite);
  if (vertices.cols() == 0) throw InputError(path + ": has no finite points");
  ModelInfo info;
  info.file = path;
  info.explain = options.explain;
  info.digits = lengthDigits(shape.shift);
  info.is_scan = !shape.mesh && detail::findSeenSpace(*shape.points, finite, {}).visibility();
  info.low = vertices.rowwise().minCoeff().cast<double>();
  info.size = vertices.rowwise().maxCoeff().cast<double>() - info.low;
  info.low = shiftedBack(info.low, shape.shift);
  info.diameter = exactDiameter(vertices);
  info.symmetries = namingFile(path, [&] {
    return shape.mesh ? detectObjectSymmetries(*shape.mesh, options.symmetries, options.mesh_points)
                      : detectObjectSymmetries(*shape.points, options.symmetries);
  });
  if (!info.symmetries.reason.empty()) throw InputError(path + ": " + info.symmetries.reason);
  namingFile(path, [&] { compare(info, shape, vertices, options, given); });
  shiftBack(info.symmetries, shape.shift);
  return info;
}

nlohmann::ordered_json toJson(const ModelInfo& info, double sphere_angle) {
  nlohmann::ordered_json json{{"diameter", info.diameter}, {"min_x", info.low.x()},   {"min_y", info.low.y()},
                              {"min_z", info.low.z()},     {"size_x", info.size.x()}, {"size_y", info.size.y()},
                              {"size_z", info.size.z()}};
  json.update(symmetriesJson(bopSymmetries(info.symmetries, sphere_angle)));
  return json;
}

void printModel(const ModelInfo& info) {
  const ObjectSymmetries& found = info.symmetries;
  if (info.is_scan)
    std::printf("model %s  %s  a scan from one side, no group\n", info.key.c_str(), info.file.c_str());
  else
    std::printf("model %s  %s  group %s, %zu discrete, %zu continuous, confidence %.3f\n", info.key.c_str(),
                info.file.c_str(), found.name().c_str(), found.discrete.size(), found.continuous.size(),
                found.confidence);
  if (!info.group_without_colors.empty())
    std::printf("  without its colors the group is %s\n", info.group_without_colors.c_str());
  if (found.num_stray_points > 0)
    std::printf("  %s left out, far from all others\n", counted(found.num_stray_points, "stray point").c_str());
  std::printf("  diameter %.6g  size %.6g x %.6g x %.6g\n", info.diameter, info.size.x(), info.size.y(), info.size.z());
  const auto print_axis = [&](const Eigen::Vector3d& direction, const std::string& turns) {
    std::printf("  axis %9.6f %9.6f %9.6f through %s  %s\n", direction.x(), direction.y(), direction.z(),
                spelled(found.center, info.digits).c_str(), turns.c_str());
  };
  for (const ContinuousSymmetry& symmetry : found.continuous) print_axis(symmetry.axis, "any angle");
  for (const RotationAxis& axis : axesOf(found.discrete))
    print_axis(axis.direction, "fold " + std::to_string(axis.order));
  if (info.explain) printRejections(found, info.digits);
}

}  // namespace pcl_symmetry::apps
