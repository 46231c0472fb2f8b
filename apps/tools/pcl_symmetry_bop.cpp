/// Symmetries, diameter and extent of models, as in models_info.json of the BOP pose benchmark.
#include <pcl/conversions.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem.hpp>
#include <cctype>

#include "bop/color_symmetry.h"
#include "bop/exact_diameter.h"
#include "bop/symmetry_check.h"
#include "command_line/run_on_files.h"
#include "core/base/constants.h"
#include "core/geometry/point_samples.h"
#include "io/answers.h"
#include "io/shape_output.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/mesh_sampling.h"
#include "pcl_symmetry/object_symmetries.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

using GivenSymmetries = std::map<std::string, ListedSymmetries>;

struct BopOptions {
  std::vector<std::string> inputs;
  ObjectSymmetryOptions symmetries;
  bool use_colors = false;
  double color_tolerance = 12.0;  ///< difference in CIELAB up to which colors are equal
  double sphere_angle = 15.0;     ///< degrees
  bool explain = false;           ///< reports rejected rotations and other tolerances
  std::optional<std::string> failures_folder, check_path, report_path, dope_folder, isaac_path;
  CommonOptions common;
};

/// The entry of models_info.json for a model.
struct ModelInfo {
  std::string key, file;
  Eigen::Vector3d low, size;  ///< corner and size of the bounding box, input frame
  double diameter = 0.0;
  int digits = 6;               ///< significant digits of lengths that are printed
  ObjectSymmetries symmetries;  ///< input frame
  bool is_scan = false;         ///< whether a cloud was seen from one side: hidden space counts as free
  /// Whether vertices or a texture have colors that are not requested or cannot be read.
  bool has_unread_colors = false;
  std::string group_without_colors;    ///< empty if colors remove no symmetry
  std::optional<SymmetryCheck> check;  ///< comparison with a given file
};

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
    saveCloud(prefix + "_rejected_" + std::to_string(i + 1) + ".ply", cloud);
  }
}

/// Colors and the given file, in the frame of the shifted points.
void compare(ModelInfo& info, const Shape& shape, const Points& vertices, const BopOptions& options,
             const std::optional<ListedSymmetries>& given) {
  const std::optional<SurfaceColors> colors =
      options.use_colors ? surfaceColors(shape, info.file) : std::optional<SurfaceColors>();
  info.has_unread_colors = hasColors(shape) && !colors;
  const std::uint64_t seed = options.symmetries.seed;
  if (colors) {
    const Points points = sampled(shape, vertices, options.common.mesh_points, seed);
    const std::string before = info.symmetries.name();
    info.symmetries = keepingColors(info.symmetries, *colors, points, options.color_tolerance);
    if (info.symmetries.name() != before) info.group_without_colors = before;
  }
  if (!given && !options.failures_folder) return;
  const int num_points = std::max(options.common.mesh_points, kEvidencePoints);
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

/// \param given the symmetries that a file lists for this model; none without a file or an entry.
ModelInfo analyzeModel(const std::string& path, const BopOptions& options,
                       const std::optional<ListedSymmetries>& given) {
  const Shape shape = loadShape(path);
  const Points finite = finitePoints(*shape.points), vertices = shape.mesh ? finite : withoutStrayPoints(finite);
  if (vertices.cols() == 0) throw InputError(path + ": has no finite points");
  ModelInfo info;
  info.file = path;
  info.digits = lengthDigits(shape.shift);
  info.low = vertices.rowwise().minCoeff().cast<double>();
  info.size = vertices.rowwise().maxCoeff().cast<double>() - info.low;
  info.low = shiftedBack(info.low, shape.shift);
  info.diameter = exactDiameter(vertices);
  info.symmetries = namingFile(path, [&] {
    return shape.mesh ? detectObjectSymmetries(*shape.mesh, options.symmetries, options.common.mesh_points)
                      : detectObjectSymmetries(*shape.points, options.symmetries);
  });
  info.is_scan = info.symmetries.reason == detail::kOneSided;
  if (!info.is_scan && !info.symmetries.reason.empty()) throw InputError(path + ": " + info.symmetries.reason);
  namingFile(path, [&] { compare(info, shape, vertices, options, given); });
  shiftBack(info.symmetries, shape.shift);
  return info;
}

/// \param sphere_angle radians, in (0, pi].
nlohmann::ordered_json toJson(const ModelInfo& info, double sphere_angle) {
  nlohmann::ordered_json json{{"diameter", info.diameter}, {"min_x", info.low.x()},   {"min_y", info.low.y()},
                              {"min_z", info.low.z()},     {"size_x", info.size.x()}, {"size_y", info.size.y()},
                              {"size_z", info.size.z()}};
  json.update(symmetriesJson(bopSymmetries(info.symmetries, sphere_angle)));
  return json;
}

void printModel(const ModelInfo& info, bool explains) {
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
  if (explains) printRejections(found, info.digits);
}

CommandLine commandLine(BopOptions& options) {
  CommandLine line("pcl_symmetry_bop",
                   "Finds the rotations that map models onto themselves, and writes them with diameter and extent as "
                   "models_info.json of the BOP pose benchmark, in the unit of the input (BOP's is the millimeter).",
                   "pcl_symmetry_bop models -json models/models_info.json");
  line.positionals("input", options.inputs,
                   std::string(kShapeFiles) +
                       ", or a folder of them; obj_000012.ply is model 12, a name without a number takes the first "
                       "free one")
      .number("feature", options.symmetries.max_feature, Range::closed(0, 1),
              "share of the surface, as of plugs and notches, that a symmetry may map off the surface")
      .number("tolerance", options.symmetries.tolerance, Range::upTo(0, 0.1),
              "how far a symmetric surface may be off, share of the greatest distance between two points")
      .number("absolute_tolerance", options.symmetries.absolute_tolerance, Range::atLeast(0),
              "the same in the unit of the input; 0: the share decides")
      .number("min_confidence", options.symmetries.min_confidence, Range::closed(0, 1),
              "least confidence of rotations that are called symmetries")
      .flag("color", options.use_colors,
            "only rotations that keep the colors of the vertices, or of the texture of a PLY file")
      .number("color_tolerance", options.color_tolerance, Range::above(0),
              "difference of colors that counts as none, in CIELAB")
      .number("sphere_angle", options.sphere_angle, Range::upTo(0, 180),
              "degrees within which the tilts that are written for a sphere reach any rotation")
      .flag("explain", options.explain,
            "tell the groups at half and twice the tolerance, and which rotations fail, by how much and where")
      .text("failures", "DIR", options.failures_folder,
            "write NAME_rejected_1.ply and so on: the surface, colored where a rotation fails")
      .text("check", "FILE", options.check_path,
            "compare with models_info.json, DOPE's model_info.json, or Isaac's symmetry_axes in YAML")
      .text("report", "FILE", options.report_path, "with -check: the comparison as JSON")
      .text("dope", "DIR", options.dope_folder, "write NAME/model_info.json for DOPE, for each model")
      .text("isaac", "FILE", options.isaac_path, "write symmetry_axes for Isaac ROS, a line for each model")
      .common(options.common, kMeshPoints | kJson | kSeed | kThreads | kGrid | kQuiet);
  return line;
}

struct ModelFile {
  std::string path;
  std::string key;  ///< number of the model
};

std::vector<std::string> shapesIn(const std::string& folder) {
  std::vector<std::string> all, numbered;
  for (const auto& entry : boost::filesystem::directory_iterator(folder)) {
    if (!hasShapeExtension(entry.path().string())) continue;
    all.push_back(entry.path().string());
    if (boost::algorithm::starts_with(entry.path().filename().string(), "obj_")) numbered.push_back(all.back());
  }
  if (all.empty()) throw InputError(folder + ": holds no " + kShapeFilesOfFolders + " file");
  std::vector<std::string>& chosen = numbered.empty() ? all : numbered;
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

/// The number at the end of the name of a file; empty if there is none.
std::string numberOf(const std::string& path) {
  const std::string stem = boost::filesystem::path(path).stem().string();
  const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
  const auto digits = std::find_if_not(stem.rbegin(), stem.rend(), is_digit).base();
  const auto number = std::find_if(digits, stem.end(), [](char c) { return c != '0'; });
  return digits != stem.end() && number == stem.end() ? "0" : std::string(number, stem.end());
}

/// Files as given; from a folder, the files obj_* that hold shapes, or all shapes if none has such a name, sorted by
/// name.
/// \return each with the number at the end of its name; if there is none, the first free number from 1 on.
/// \throws UsageError if two files have the same number; InputError for a folder without a shape.
std::vector<ModelFile> modelFiles(const std::vector<std::string>& inputs) {
  std::vector<ModelFile> models;
  for (const std::string& input : inputs) {
    const bool is_folder = boost::filesystem::is_directory(input);
    for (const std::string& path : is_folder ? shapesIn(input) : std::vector<std::string>{input})
      models.push_back({path, numberOf(path)});
  }
  std::map<std::string, std::string> path_of;
  for (const ModelFile& model : models) {
    if (model.key.empty()) continue;
    const auto [entry, is_new] = path_of.insert({model.key, model.path});
    if (!is_new) throw UsageError(model.path + " and " + entry->second + " are both model " + model.key);
  }
  int free = 1;
  for (ModelFile& model : models) {
    if (!model.key.empty()) continue;
    while (path_of.count(std::to_string(free)) > 0) ++free;
    model.key = std::to_string(free++);
  }
  return models;
}

GivenSymmetries readGiven(const std::string& path, std::size_t num_models) {
  const std::string ending = boost::filesystem::path(path).extension().string();
  GivenSymmetries given = ending == ".yaml" || ending == ".yml" ? readIsaacAxes(path) : readModelsInfo(path);
  if (given.count("") > 0 && num_models != 1)
    throw InputError(path + ": is a file of one model, there are " + std::to_string(num_models));
  return given;
}

std::optional<ListedSymmetries> givenFor(const GivenSymmetries& given, const std::string& key) {
  const auto entry = given.find(given.count("") > 0 ? "" : key);
  return entry == given.end() ? std::nullopt : std::optional(entry->second);
}

struct Results {
  std::vector<ModelInfo> infos;
  std::vector<std::string> errors;
};

/// Analyzes one model at a time on each thread: memory grows with the threads, not with the models.
Results analyzeAll(const std::vector<ModelFile>& files, const BopOptions& options, const GivenSymmetries& given) {
  BopOptions of_model = options;
  const auto num_threads = static_cast<std::size_t>(resolveNumThreads(options.common.threads));
  of_model.symmetries.num_threads = static_cast<int>(std::max<std::size_t>(1, num_threads / files.size()));
  std::vector<ModelInfo> infos(files.size());
  const Console console(options.common.quiet);
  Step searching(console, "Searching rotations of " + counted(files.size(), "model"));
  const auto errors = workOnAll(files.size(), options.common.threads, searching, [&](std::size_t i) {
    infos[i] = analyzeModel(files[i].path, of_model, givenFor(given, files[i].key));
    infos[i].key = files[i].key;
  });
  Results results;
  for (std::size_t i = 0; i < files.size(); ++i)
    if (errors[i].empty())
      results.infos.push_back(std::move(infos[i]));
    else
      results.errors.push_back(errors[i]);
  const std::string failed = results.errors.empty() ? "" : ", " + std::to_string(results.errors.size()) + " failed";
  searching.done(std::to_string(results.infos.size()) + " done" + failed);
  for (const ModelInfo& info : results.infos)
    if (info.is_scan)
      console.warn(info.file +
                   ": is a scan from one side, must be a whole object; pcl_symmetry_planes finds the axes of a scan");
  return results;
}

/// The entries by number, one per line, as in the benchmark's own files.
std::string modelsInfo(std::vector<ModelInfo> infos, double sphere_angle) {
  std::stable_sort(infos.begin(), infos.end(), [](const ModelInfo& a, const ModelInfo& b) {
    return a.key.size() != b.key.size() ? a.key.size() < b.key.size() : a.key < b.key;
  });
  std::string text;
  for (const ModelInfo& info : infos)
    text += (text.empty() ? "{\n  \"" : ",\n  \"") + info.key +
            "\": " + toJson(info, sphere_angle).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return text + "\n}\n";
}

void printColorNote(const std::vector<ModelInfo>& infos, bool use_colors) {
  const auto is_colored = [](const ModelInfo& info) { return info.has_unread_colors; };
  const auto num_colored = std::count_if(infos.begin(), infos.end(), is_colored);
  if (num_colored == 0) return;
  std::printf("%td of %zu models have colors, which were not looked at: %s\n", num_colored, infos.size(),
              use_colors ? "only those of vertices, and textures that PLY files name, can be read"
                         : "-color asks for rotations that keep them");
}

void report(const std::vector<ModelInfo>& infos, const BopOptions& options, bool prints) {
  nlohmann::ordered_json models = nlohmann::ordered_json::object(), missing = nlohmann::ordered_json::array();
  int num_disagreeing = 0, num_compared = 0;
  for (const ModelInfo& info : infos) {
    if (!info.check) {
      if (prints) std::printf("model %-6s is not in %s\n", info.key.c_str(), options.check_path->c_str());
      missing.push_back(info.key);
      continue;
    }
    if (prints) printCheck(info.key, *info.check, info.diameter);
    models[info.key] = toJson(*info.check, info.diameter);
    ++num_compared;
    num_disagreeing += info.check->agrees() ? 0 : 1;
  }
  if (prints)
    std::printf("%d of %d models disagree with %s\n", num_disagreeing, num_compared, options.check_path->c_str());
  if (options.report_path)
    writeText(*options.report_path, jsonText(nlohmann::ordered_json{
                                        {"disagreeing", num_disagreeing}, {"models", models}, {"missing", missing}}) +
                                        "\n");
}

void writeDope(const std::vector<ModelInfo>& infos, const std::string& folder, double sphere_angle) {
  for (const ModelInfo& info : infos) {
    const boost::filesystem::path model = boost::filesystem::path(folder) / boost::filesystem::path(info.file).stem();
    boost::system::error_code ignored;  // writeText() reports the missing folder
    boost::filesystem::create_directories(model, ignored);
    writeText((model / "model_info.json").string(), dopeJson(info.symmetries, sphere_angle).dump(2) + "\n");
  }
}

void writeIsaac(const std::vector<ModelInfo>& infos, const std::string& path) {
  std::string text;
  for (const ModelInfo& info : infos) {
    const IsaacAxes axes = isaacAxes(info.symmetries);
    text += isaacLine("\"" + info.key + "\"", axes.axes) + "  # " + info.symmetries.name() +
            (axes.is_complete ? "" : ", of which turns about x, y and z are only a part") + "\n";
  }
  writeText(path, text);
}

int run(int argc, char** argv) {
  BopOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  line.goWith("-check", options.check_path.has_value(), {"report"});
  line.goWith("-json or -dope", options.common.json_path || options.dope_folder, {"sphere_angle"});
  line.goWith("-absolute_tolerance 0", options.symmetries.absolute_tolerance == 0.0, {"tolerance"});
  line.goWith("-color", options.use_colors, {"color_tolerance"});
  const std::vector<ModelFile> files = modelFiles(options.inputs);
  const GivenSymmetries given = options.check_path ? readGiven(*options.check_path, files.size()) : GivenSymmetries{};
  ObjectSymmetryOptions& symmetries = options.symmetries;
  symmetries.num_cells = options.common.grid;
  symmetries.other_tolerances = options.explain;
  symmetries.max_points = std::max(symmetries.max_points, options.common.mesh_points);
  symmetries.seed = options.common.seed;
  const bool prints = isStandardOutputFree({options.common.json_path, options.report_path, options.isaac_path});
  const Results results = analyzeAll(files, options, given);
  if (prints) {
    for (const ModelInfo& info : results.infos) printModel(info, options.explain);
    printColorNote(results.infos, options.use_colors);
  }
  const double sphere_angle = options.sphere_angle * kDegree;
  if (!results.infos.empty()) {
    if (options.check_path) report(results.infos, options, prints);
    if (options.common.json_path) writeText(*options.common.json_path, modelsInfo(results.infos, sphere_angle));
    if (options.dope_folder) writeDope(results.infos, *options.dope_folder, sphere_angle);
    if (options.isaac_path) writeIsaac(results.infos, *options.isaac_path);
  }
  const Console console(options.common.quiet);
  for (const std::string& error : results.errors) console.error(error);
  return results.errors.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
