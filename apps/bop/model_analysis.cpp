#include "bop/model_analysis.h"

#include <algorithm>
#include <boost/filesystem.hpp>
#include <cstdint>
#include <cstdio>

#include "bop/rejections.h"
#include "command_line/file_errors.h"
#include "core/geometry/diameter.h"
#include "io/exact_coordinates.h"
#include "io/json_values.h"
#include "pcl_symmetry/mesh_sampling.h"

namespace pcl_symmetry::apps {

namespace {

// Points spread over a mesh to measure distances. chosen: half blurs edges by half a per cent of the diameter, twice
// takes twice the time.
constexpr int kEvidencePoints = 20'000;

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

/// Colours and the given file, in the frame of the shifted points.
void compare(ModelInfo& info, const Shape& shape, const Points& vertices, const ModelOptions& options,
             const std::optional<ListedSymmetries>& given) {
  const std::optional<SurfaceColours> colours =
      options.use_colours ? surfaceColours(shape, info.file) : std::optional<SurfaceColours>();
  info.has_unread_colours = hasColours(shape) && !colours;
  const std::uint64_t seed = options.symmetries.seed;
  if (colours) {
    const Points points = sampled(shape, vertices, options.mesh_points, seed);
    const std::string before = info.symmetries.name();
    info.symmetries = keepingColours(info.symmetries, ColouredSurface(*colours, points, options.colour_tolerance));
    if (info.symmetries.name() != before) info.group_without_colours = before;
  }
  if (!given && !options.failures_folder) return;
  const int num_points = std::max(options.mesh_points, kEvidencePoints);
  const ObjectSymmetryOptions& limits = options.symmetries;
  const double tolerance =
      limits.absolute_tolerance > 0.0 ? limits.absolute_tolerance : limits.tolerance * info.diameter;
  const SurfaceEvidence surface(sampled(shape, vertices, num_points, seed), tolerance);
  if (options.failures_folder) {
    const boost::filesystem::path folder(*options.failures_folder), name(boost::filesystem::path(info.file).stem());
    boost::system::error_code ignored;  // saveCloud() names the folder that is missing
    boost::filesystem::create_directories(folder, ignored);
    writeRejections((folder / name).string(), info.symmetries, surface, shape.shift);
  }
  if (given) {
    info.check = checkSymmetries(shifted(*given, shape.shift), info.symmetries, surface, info.diameter);
    for (Disagreement& disagreement : info.check->disagreements) disagreement.point += shape.shift;
  }
}

}  // namespace

ModelInfo analyseModel(const std::string& path, const ModelOptions& options,
                       const std::optional<ListedSymmetries>& given) {
  const Shape shape = loadShape(path);
  const Points vertices = finitePoints(*shape.points);
  if (vertices.cols() == 0) throw InputError(path + ": has no finite points");
  ModelInfo info;
  info.file = path;
  info.explain = options.explain;
  info.digits = lengthDigits(shape.shift);
  info.low = vertices.rowwise().minCoeff().cast<double>();
  info.size = vertices.rowwise().maxCoeff().cast<double>() - info.low;
  info.low = shiftedBack(info.low, shape.shift);
  info.diameter = diameter(vertices);
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
  std::printf("model %s  %s  group %s, %zu discrete, %zu continuous, confidence %.3f\n", info.key.c_str(),
              info.file.c_str(), found.name().c_str(), found.discrete.size(), found.continuous.size(),
              found.confidence);
  if (!info.group_without_colours.empty())
    std::printf("  without its colours the group is %s\n", info.group_without_colours.c_str());
  std::printf("  diameter %.6g  size %.6g x %.6g x %.6g\n", info.diameter, info.size.x(), info.size.y(), info.size.z());
  const auto print_axis = [&](const Eigen::Vector3d& direction, const std::string& turns) {
    std::printf("  axis %9.6f %9.6f %9.6f through %s  %s\n", direction.x(), direction.y(), direction.z(),
                spelled(found.center, info.digits).c_str(), turns.c_str());
  };
  for (const ContinuousSymmetry& symmetry : found.continuous) print_axis(symmetry.axis, "any angle");
  std::vector<Eigen::Matrix3d> rotations;
  for (const Eigen::Isometry3d& symmetry : found.discrete) rotations.push_back(symmetry.linear());
  for (const RotationAxis& axis : axesOf(rotations)) print_axis(axis.direction, "fold " + std::to_string(axis.order));
  if (info.explain) printRejections(found, info.digits);
}

}  // namespace pcl_symmetry::apps
