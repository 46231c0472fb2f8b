/// The canonical frame of a cloud by its symmetry, or the transform that registers it to another one; many scans of an
/// object as one cloud; completion, and symmetrized shapes with their asymmetry.
#include <pcl/common/io.h>
#include <pcl/common/transforms.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem/path.hpp>
#include <cmath>
#include <numeric>
#include <sstream>

#include "command_line/run_on_files.h"
#include "io/answers.h"
#include "io/cloud_fields.h"
#include "io/file_text.h"
#include "io/input_shape.h"
#include "io/mesh_output.h"
#include "io/shape_output.h"
#include "pcl_symmetry/completion.h"
#include "pcl_symmetry/mesh_sampling.h"
#include "pcl_symmetry/register_all.h"
#include "pcl_symmetry/symmetrization.h"
#include "pcl_symmetry/symmetry_alignment.h"
#include "pcl_symmetry/symmetry_maxima_refinement.h"
#include "pcl_symmetry/symmetry_registration.h"
#include "pictures/scene_page.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

struct AlignOptions {
  BatchOptions batch;
  std::string input;
  std::optional<std::string> output, target, merge, html_path, png_path, landmarks;
  std::vector<std::string> more;
  std::string symmetrize = "none";
  bool complete = false, any_plane = false, as_published = false, cut = false;
  CommonOptions common;
};

CommandLine commandLine(AlignOptions& options) {
  CommandLine line("pcl_symmetry_align",
                   "Turns a cloud into the frame of its symmetry: center to the origin, axes to x, y and z, that of "
                   "the best plane first. "
                   "With -target, brings it to another cloud instead, from any pose.",
                   "pcl_symmetry_align scan.pcd aligned.pcd -target model.ply -json pose.json");
  options.batch.outputs = {&options.output, &options.html_path, &options.png_path};
  line.positional("input", options.input, kOneOrManyInputs)
      .positional("output", options.output, ".pcd or .ply: the cloud after the transform")
      .positionals("more", options.more, "with -merge, where all arguments are scans", false)
      .text(
          "merge", "FILE", options.merge,
          "bring the arguments, many scans of one object, together without a guess, and write them as one cloud, .pcd "
          "or .ply, in the frame of the first one, thinned where they overlap; the field scan of a point is the index "
          "of its file. Scans that fit no others are left out and named. Other flags: -complete, -viewpoint, which is "
          "the same in the frame of each scan, and outputs")
      .text("target", "FILE", options.target, "cloud or mesh that the input is brought to")
      .text("html", "FILE.html", options.html_path,
            "page that shows the input in the target, or its center and axes, for any browser, without network")
      .text("png", "FILE.png", options.png_path, "picture of the same")
      .choice(
          "symmetrize", options.symmetrize, {"none", "mean", "left", "right"},
          "write the shape that its best plane maps onto itself, after the transform: its halves are the mean of both "
          "sides, or the side that the normal of the plane points away from (left) or to (right). A mesh keeps its "
          "faces and is written as .ply. The field asymmetry of a point tells how far the shape is outside of the "
          "reflection of its other side there, along the normal; -html and -png show it")
      .flag("cut", options.cut,
            "with -symmetrize and a mesh: cut it at the plane, and write one side (of mean the left one) and its exact "
            "reflection. Without, faces of both sides that do not match leave a deviation, which the JSON tells")
      .text("landmarks", "FILE", options.landmarks,
            "with -symmetrize: lines of six numbers, a landmark and its counterpart, or of three, one of the midline; "
            "their asymmetry is reported")
      .flag("as_published", options.as_published, "the frame by the paper's own method, to the letter of Section 5.1")
      .flag("complete", options.complete,
            "reflect the cloud across its best plane of symmetry, except into space that was seen to be empty; the "
            "field reflected_of of an added point is the index of its source, and -1 for all others")
      .flag("any_plane", options.any_plane,
            "with -complete: where there is no symmetry, reflect across the plane that comes closest")
      .common(options.common, kShapeFlags);
  options.batch.addTo(line);
  return line;
}

/// The plane by which a shape is completed or symmetrized, in the frame of the shifted points.
struct BestPlane {
  ReflectionPlane plane;
  std::string kind;
  double confidence;

  nlohmann::json json(const Eigen::Vector3d& shift) const {
    return {{"plane", numbersOf(plane, shift)}, {"kind", kind}, {"confidence", confidence}};
  }
};

/// The best plane of symmetry, or one through the axis of a body of revolution or the center of a ball.
BestPlane bestPlane(const Console& console, const InputShape& input, const CommonOptions& common) {
  Step step(console, "Searching planes");
  DetectionOptions detection;
  common.applyTo(detection);
  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  const std::vector<SymmetryPlane> planes = namingFile(input.path, [&] {
    refinement.setOptions(detection);
    setInput(refinement, input, common);
    if (input.shape.mesh) refinement.setMesh(meshSurface(*input.shape.mesh));
    return checked(refinement, input, refinement.compute());
  });
  const Detection& found = refinement.getDetection();
  const Eigen::Vector3d scanner =
      refinement.getUsedViewpoint().value_or(input.shape.points->sensor_origin_.head<3>().cast<double>().eval());
  if (const std::optional<ReflectionPlane> plane = planeAcrossView(found, scanner)) {
    const bool is_ball = !found.centers.empty();
    step.done(is_ball ? "center of symmetry" : "axis of revolution");
    return {*plane, is_ball ? "through the center" : "through the axis",
            is_ball ? found.centers.front().confidence : found.axes.front().confidence};
  }
  if (const auto& best = found.best; planes.empty() && best) {
    step.done("no symmetry");
    return {*best, toString(best->kind), best->confidence};
  }
  if (planes.empty()) throw InputError(input.path + ": has no plane of symmetry to complete it across");
  step.done("confidence " + std::to_string(std::lround(100.0 * planes.front().confidence)) + " %");
  return {planes.front(), toString(planes.front().kind), planes.front().confidence};
}

BestPlane completingPlane(const Console& console, const InputShape& input, const CommonOptions& common,
                          bool by_any_plane) {
  BestPlane best = bestPlane(console, input, common);
  if (!by_any_plane && best.kind == toString(PlaneKind::Approximate))
    throw InputError(input.path + ": has no plane of symmetry to complete it across; -any_plane takes the best one");
  if (best.kind == toString(PlaneKind::Possible))
    console.warn(input.path +
                 formatted(": completed across a plane that is only possible, of confidence %.2f", best.confidence));
  return best;
}

/// Adds to the fields what the symmetry shows of the side that was not seen.
/// \return the points and the added ones, in the frame of the shifted points.
Cloud complete(const Console& console, const InputShape& input, const CommonOptions& common, const BestPlane& best,
               pcl::PCLPointCloud2& fields, nlohmann::json& json) {
  const ReflectionPlane& plane = best.plane;
  Step step(console, "Completing");
  CompletionOptions options;
  options.num_threads = common.threads;
  const auto completed = completeBySymmetry(*input.points, plane, options, input.viewpoint(common));
  fields = appendCopies(fields, completed.sources, "reflected_of");
  movePoints(fields, shiftedBack(plane, input.shift()).reflection(), fields.width - completed.sources.size());
  json = best.json(input.shift());
  json["num_added"] = completed.added.size();
  step.done(counted(completed.added.size(), "point") + " added");
  return completed.cloud;
}

/// Landmarks of a file, minus the shift.
struct Landmarks {
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> pairs;
  std::vector<Eigen::Vector3d> midline;
};

Landmarks readLandmarks(const std::string& path, const Eigen::Vector3d& shift) {
  std::istringstream file(readTextFile(path));
  Landmarks landmarks;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    line = line.substr(0, line.find('#'));
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == ',' || c == ';' || c == '\r'; }, ' ');
    std::istringstream words(line);
    std::vector<double> values;
    for (double value = 0.0; words >> value;) values.push_back(value);
    if (!words.eof() || (values.size() != 0 && values.size() != 3 && values.size() != 6))
      throw InputError(path + ": line " + std::to_string(number) + " must hold three or six numbers");
    if (values.empty()) continue;
    const Eigen::Vector3d first = Eigen::Map<const Eigen::Vector3d>(values.data()) - shift;
    if (values.size() == 3) landmarks.midline.push_back(first);
    if (values.size() == 6) landmarks.pairs.emplace_back(first, Eigen::Map<const Eigen::Vector3d>(&values[3]) - shift);
  }
  return landmarks;
}

nlohmann::json landmarksJson(const Landmarks& landmarks, const ReflectionPlane& plane) {
  const LandmarkAsymmetry found = landmarkAsymmetry(landmarks.pairs, landmarks.midline, plane);
  const auto pairJson = [](const Eigen::Vector3d& apart) -> nlohmann::json {
    return {{"distance", apart.norm()}, {"vector", numbersOf(apart)}};
  };
  return {{"object_rms", found.object_rms},
          {"paired_rms", found.paired_rms},
          {"paired", listOf(found.paired, pairJson)},
          {"midline", found.unpaired}};
}

/// A symmetrized shape in the frame of the shifted points, and what is reported about it.
struct Symmetrized {
  pcl::PCLPointCloud2 fields;  ///< fields of a cloud
  std::optional<pcl::PolygonMesh> mesh;
  std::vector<float> asymmetry;       ///< asymmetry at each point of the input
  std::vector<float> mesh_asymmetry;  ///< asymmetry at each vertex of the mesh
  nlohmann::json json;
  std::string text;
};

Symmetrized symmetrized(const Console& console, const InputShape& input, const AlignOptions& options,
                        const CommonOptions& common, const BestPlane& best) {
  const ReflectionPlane& plane = best.plane;
  Step step(console, "Symmetrizing");
  const SymmetrizedHalf half = options.symmetrize == "left"    ? SymmetrizedHalf::Left
                               : options.symmetrize == "right" ? SymmetrizedHalf::Right
                                                               : SymmetrizedHalf::Mean;
  Symmetrized result;
  result.json = best.json(input.shift());
  result.json["half"] = options.symmetrize;
  const auto report = [&](const auto& shape) {
    result.asymmetry = shape.asymmetry;
    result.json["mean_asymmetry"] = shape.mean_asymmetry;
    result.json["greatest_asymmetry"] = shape.greatest_asymmetry;
    result.text = formatted("asymmetry: mean %.4g, greatest %.4g\n", shape.mean_asymmetry, shape.greatest_asymmetry);
  };
  if (input.shape.mesh) {
    const SymmetrizedMesh shape = symmetrize(*input.shape.mesh, plane, half, common.threads);
    report(shape);
    result.mesh_asymmetry = shape.asymmetry;
    result.mesh = options.cut ? mirroredHalf(shape.mesh, plane, half != SymmetrizedHalf::Right, &result.mesh_asymmetry)
                              : shape.mesh;
    result.json["deviation"] = options.cut ? 0.0 : shape.deviation;
    if (!options.cut)
      result.text += formatted("up to %.2g from its own reflection, exact with -cut\n", shape.deviation);
  } else {
    const SymmetrizedCloud<pcl::PointXYZ> shape = symmetrize(*input.points, plane, half, common.threads);
    report(shape);
    const std::size_t size = shape.sources.size() / 2;
    pcl::PCLPointCloud2 kept;
    pcl::copyPointCloud(withFields(input.fields(), {"asymmetry"}, {result.asymmetry}),
                        pcl::Indices(shape.sources.begin(), shape.sources.begin() + size), kept);
    const VectorField position(kept);
    for (std::size_t i = 0; i < size; ++i)
      position.set(kept, i, shape.cloud[i].getVector3fMap().cast<double>() + input.shift());
    pcl::Indices all(size);
    std::iota(all.begin(), all.end(), 0);
    result.fields = appendCopies(kept, all, "reflected_of");
    movePoints(result.fields, shiftedBack(plane, input.shift()).reflection(), size);
  }
  if (options.landmarks) {
    const nlohmann::json found = landmarksJson(readLandmarks(*options.landmarks, input.shift()), plane);
    result.text += formatted("landmarks: object asymmetry %.4g, paired %.4g, root mean square\n",
                             found["object_rms"].get<double>(), found["paired_rms"].get<double>());
    result.json["landmarks"] = found;
  }
  step.done();
  return result;
}

/// The input, colored by its asymmetry: blue inside, yellow outside of the reflection of the other side. Values that
/// are only rounding errors of coordinates have no color.
PictureScene sceneOf(const InputShape& input, const Symmetrized& shape) {
  // Share of the points within the scale, so that a few outlying ones do not hide the others.
  constexpr double kShown = 0.97;
  const float rounding =
      std::numeric_limits<float>::epsilon() * finitePoints(*input.shape.points).cwiseAbs().maxCoeff();
  std::vector<float> sizes;
  for (const float value : shape.asymmetry)
    if (std::isfinite(value)) sizes.push_back(std::abs(value));
  const auto last = sizes.begin() + static_cast<std::ptrdiff_t>(kShown * static_cast<double>(sizes.size()));
  if (last != sizes.end()) std::nth_element(sizes.begin(), last, sizes.end());
  const float scale = last != sizes.end() && *last > rounding ? *last : rounding;
  PicturePanel panel{scale > rounding ? formatted("asymmetry: blue %.3g inside, yellow %.3g outside", scale, scale)
                                      : "no asymmetry beyond the rounding of coordinates"};
  panel.show_points = !input.shape.mesh;
  for (const float value : shape.asymmetry)
    panel.support.push_back(std::abs(value) > rounding ? std::clamp(0.5f + 0.5f * value / scale, 0.0f, 1.0f) : 0.5f);
  PictureScene scene{input.shape.points, input.shape.mesh, {panel}};
  scene.show_color_bar = false;
  return scene;
}

/// A motion of the input, between input frames, and what is reported about it.
struct Motion {
  Eigen::Isometry3d transform;
  bool converged = true;
  std::string text;
  nlohmann::json json;
  PictureScene scene;  ///< scene that a page shows
};

PictureScene sceneOf(const InputShape& input, const SymmetryFrame& frame) {
  PicturePanel panel{"center and axes: 1 red, 2 green, 3 blue"};
  panel.show_points = !input.shape.mesh;
  for (int k = 0; k < 3; ++k) panel.axes.push_back({frame.center, frame.axes.col(k), Eigen::Vector3d::Unit(k)});
  return {input.points, input.shape.mesh, {panel}};
}

/// \param num_first number of points of the first of two clouds, which have two colors.
PictureScene sceneOf(const Cloud& both, std::size_t num_first, const std::string& label, const std::string& first,
                     const std::string& second) {
  PicturePanel panel{label};
  panel.legend = {{0, first}, {1, second}};
  panel.segments.assign(num_first, 0);
  panel.segments.resize(both.size(), 1);
  return {pcl::make_shared<Cloud>(both), std::nullopt, {panel}};
}

PictureScene sceneOf(const InputShape& input, const InputShape& target, const Eigen::Isometry3d& T_target_input) {
  Cloud moved;
  const Eigen::Isometry3d motion =
      Eigen::Translation3d(-target.shift()) * T_target_input * Eigen::Translation3d(input.shift());
  pcl::transformPointCloud(*input.points, moved, motion.matrix());
  return sceneOf(*target.points + moved, target.points->size(), "the input in the target", "target", "input");
}

Motion toTarget(const Console& console, const InputShape& input, const AlignOptions& options,
                const CommonOptions& common) {
  const InputShape target = loadInput(console, *options.target, common);
  Step step(console, "Registering");
  SymmetryRegistration<pcl::PointXYZ, pcl::PointXYZ, double> registration;
  registration.setSourceViewpoint(input.viewpoint(common));
  registration.setRandomSeed(common.seed);
  registration.setNumberOfThreads(common.threads);
  registration.setInputSource(input.points);
  registration.setInputTarget(target.points);
  Cloud aligned;
  registration.align(aligned);
  Motion result;
  result.transform =
      shiftedBack(Eigen::Isometry3d(registration.getFinalTransformation()), input.shift(), target.shift());
  result.converged = registration.hasConverged();
  // A rejected answer also gives the best pose.
  const std::vector<RegisteredPose>& poses = registration.getPoses();
  const Eigen::Isometry3d best = poses.empty() ? Eigen::Isometry3d::Identity() : poses.front().T_target_source;
  result.json = {{"transform", rowMajor(shiftedBack(best, input.shift(), target.shift()))},
                 {"converged", result.converged},
                 {"fitness", registration.getFitnessScore()},
                 {"support", registration.getScore().support},
                 {"conflict", registration.getScore().conflict},
                 {"timing_ms", timingJson(registration.getTiming())},
                 {"confidence", registration.getConfidence()}};
  const PoseEvidence& evidence = registration.getEvidence();
  result.json["evidence"] = {{"overlap_source", evidence.overlap_source},
                             {"overlap_target", evidence.overlap_target},
                             {"agreement", evidence.agreement},
                             {"on_surface", evidence.on_surface},
                             {"contradicted", evidence.contradicted},
                             {"missing", evidence.missing},
                             {"aside", evidence.aside},
                             {"outside", evidence.outside},
                             {"noise", evidence.noise},
                             {"size_ratio", evidence.size_ratio},
                             {"uniqueness", evidence.uniqueness}};
  if (!result.converged) result.json["reason"] = registration.getReason();
  step.done(result.converged ? formatted("confidence %.3f", registration.getConfidence()) : "nothing fits");
  result.scene = sceneOf(input, target, result.transform);
  if (result.converged)
    result.text = matrixLines(result.transform, std::max(lengthDigits(input.shift()), lengthDigits(target.shift())));
  return result;
}

nlohmann::json describe(const SymmetryFrame& frame, const Eigen::Vector3d& shift) {
  nlohmann::json json = frameJson(frame, shift);
  json["stray_points"] = frame.num_stray_points;
  json["timing_ms"] = timingJson(frame.timing_ms);
  json["equivalent"] = listOf(frame.equivalent, [&](const Eigen::Isometry3d& T_canonical_input) {
    return rowMajor(shiftedBack(T_canonical_input, shift, Eigen::Vector3d::Zero()));
  });
  json["rotations"] = rotationsJson(frame.rotations, shift);
  json["probable"] = listOf(frame.probable, [&](const ProbableFrame& other) -> nlohmann::json {
    return {{"center", numbersOf(shiftedBack(other.center, shift))},
            {"axes", axesJson(other.axes)},
            {"revolution_axis", other.revolution_axis},
            {"probability", other.probability}};
  });
  return json;
}

std::string linesOf(const SymmetryFrame& frame, const Eigen::Vector3d& shift) {
  std::string lines = "center " + spelled(shiftedBack(frame.center, shift), lengthDigits(shift)) + "\n";
  for (int k = 0; k < 3; ++k)
    lines += formatted("axis %d %9.6f %9.6f %9.6f  score %.3f%s\n", k + 1, frame.axes(0, k), frame.axes(1, k),
                       frame.axes(2, k), frame.scores[k], frame.revolution_axis == k ? "  axis of revolution" : "");
  for (const SymmetryRotation& rotation : frame.rotations)
    if (rotation.confidence >= DetectionOptions().min_confidence) lines += lineOf(rotation, rotation.fold, shift);
  double others = 0.0;
  for (std::size_t i = 1; i < frame.probable.size(); ++i) others += frame.probable[i].probability;
  if (frame.revolution_axis == 3)
    lines += "every line through the center is an axis of revolution\n";
  else if (!frame.probable.empty())
    lines += formatted("probability of these axes %.2f, of ", frame.probable.front().probability) +
             counted(frame.probable.size() - 1, "other") + formatted(" %.2f\n", others);
  return lines;
}

/// The motion to the frame of the input.
/// \param best plane that the frame is to have at x = 0; nothing: its own first plane.
Motion toOwnFrame(const Console& console, const InputShape& input, const AlignOptions& options,
                  const CommonOptions& common, const std::optional<BestPlane>& best) {
  Step step(console, "Searching the frame");
  FrameOptions how;
  how.as_published = options.as_published;
  // Otherwise it is refined on the mesh itself.
  how.refined = !input.shape.mesh || common.viewpoint.mode == Viewpoint::Mode::Given;
  common.applyTo(how);
  SymmetryAlignment<pcl::PointXYZ> alignment;
  SymmetryFrame frame = namingFile(input.path, [&] {
    alignment.setOptions(how);
    alignment.setViewpoint(input.viewpoint(common));
    alignment.setInputCloud(input.points);
    SymmetryFrame found = checked(alignment, input, alignment.compute());
    if (input.shape.mesh && !alignment.usedViewpoint()) refineOnMesh(meshSurface(*input.shape.mesh), found);
    return found;
  });
  step.done(alignment.usedViewpoint() ? "seen from one side" : "");
  if (best) bringToPlane(best->plane, frame);
  return {shiftedBack(frame.T_canonical_input, input.shift(), Eigen::Vector3d::Zero()), true,
          linesOf(frame, input.shift()), describe(frame, input.shift()), sceneOf(input, frame)};
}

void save(const Console& console, const Shape& shape, pcl::PCLPointCloud2 fields, const Eigen::Isometry3d& motion,
          const std::string& path) {
  Step step(console, "Saving " + path);
  movePoints(fields, Eigen::Affine3d(motion.matrix()));
  Eigen::Vector4f origin = shape.sensor_origin;
  origin.head<3>() = (motion * origin.head<3>().cast<double>()).cast<float>();
  const Eigen::Quaternionf orientation(
      Eigen::Quaterniond(motion.linear() * shape.sensor_orientation.cast<double>()).cast<float>());
  saveCloud(path, fields, origin, orientation);
  step.done(counted(finiteIndices(fields).size(), "point"));
}

void analyze(const AlignOptions& options, FileJob& job) {
  const Console& console = job.console;
  const CommonOptions& common = job.common;
  const InputShape input = loadInput(console, job.path, common);
  const bool symmetrizes = options.symmetrize != "none";
  if (options.cut && !input.shape.mesh) throw InputError(job.path + ": has no faces, -cut needs a mesh");
  if (symmetrizes && options.output && input.shape.mesh && !boost::iends_with(*options.output, ".ply"))
    throw UsageError(job.output(*options.output) + ": a symmetrized mesh is written as .ply");
  const auto find_plane = [&]() -> std::optional<BestPlane> {
    if (symmetrizes) return bestPlane(console, input, common);
    if (options.complete) return completingPlane(console, input, common, options.any_plane);
    return std::nullopt;
  };
  std::optional<BestPlane> best;  // what is written is symmetric in the frame in which it is written
  if (!options.target) best = find_plane();
  Motion motion =
      options.target ? toTarget(console, input, options, common) : toOwnFrame(console, input, options, common, best);
  if (options.target && motion.converged) best = find_plane();
  std::optional<Symmetrized> shape;
  if (symmetrizes && motion.converged) {
    shape = symmetrized(console, input, options, common, *best);
    motion.text += shape->text;
    motion.json["symmetrized"] = shape->json;
    motion.scene = sceneOf(input, *shape);
  }
  pcl::PCLPointCloud2 fields = shape ? std::move(shape->fields) : input.fields();
  if (options.complete && motion.converged) {
    const Cloud both = complete(console, input, common, *best, fields, motion.json["completed"]);
    motion.scene = sceneOf(both, input.points->size(), "the input and what completes it", "input", "added");
  }
  std::vector<nlohmann::json> row{motion.converged};
  for (const double value : rowMajor(motion.transform)) row.emplace_back(value);
  job.report({motion.text, motion.json, {row}});
  if (!motion.converged)
    throw InputError(job.path + ": does not fit " + *options.target + ": " + motion.json["reason"].get<std::string>());
  if (options.html_path) writePage(motion.scene, {job.path, motion.text}, job.output(*options.html_path));
  if (options.png_path) renderPicture({motion.scene}, job.output(*options.png_path), 800, 600);
  if (shape && shape->mesh) {
    const Eigen::Isometry3d T_output_shifted = motion.transform * Eigen::Translation3d(input.shift());
    if (options.output)
      saveMesh(job.output(*options.output), *shape->mesh, T_output_shifted, "asymmetry", shape->mesh_asymmetry);
    return;
  }
  if (options.output) save(console, input.shape, std::move(fields), motion.transform, job.output(*options.output));
}

nlohmann::json describe(const std::vector<InputShape>& inputs, const RegisteredScans& registered,
                        const std::vector<Eigen::Isometry3d>& motions) {
  nlohmann::json json{{"scans", nlohmann::json::array()},
                      {"resolution", registered.resolution},
                      {"timing_ms", timingJson(registered.timing_ms)}};
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    nlohmann::json scan{{"file", inputs[k].path}};
    if (registered.scans[k].left_out.empty())
      scan.update({{"transform", rowMajor(motions[k])}, {"confidence", registered.scans[k].confidence}});
    else
      scan["left_out"] = registered.scans[k].left_out;
    json["scans"].push_back(scan);
  }
  json["pairs"] = listOf(registered.pairs, [&](const ScanPair& pair) -> nlohmann::json {
    return {{"source", inputs[pair.source].path},
            {"target", inputs[pair.target].path},
            {"overlap", pair.overlap},
            {"used", pair.used}};
  });
  return json;
}

struct Merged {
  InputShape shape;            ///< its points in the frame of the first scan that is kept, minus its shift
  pcl::PCLPointCloud2 fields;  ///< fields of the scans, and the index of each point's scan
  std::vector<int> scans;      ///< scan of each point
};

bool haveSameFields(const pcl::PCLPointCloud2& a, const pcl::PCLPointCloud2& b) {
  return std::equal(a.fields.begin(), a.fields.end(), b.fields.begin(), b.fields.end(),
                    [](const pcl::PCLPointField& x, const pcl::PCLPointField& y) {
                      return x.name == y.name && x.datatype == y.datatype && x.count == y.count;
                    });
}

Merged merged(const std::vector<InputShape>& inputs, const std::vector<ObjectScan>& scans,
              const std::vector<pcl::Indices>& indices, const RegisteredScans& registered,
              const std::vector<Eigen::Isometry3d>& motions, std::size_t first) {
  Merged merged;
  merged.shape.shape.points = merged.shape.points = pcl::make_shared<Cloud>();
  merged.shape.shape.shift = inputs[first].shift();
  std::vector<pcl::Indices> kept(inputs.size());
  for (const ScanPoint& point : registered.mergedPoints(scans))
    kept[point.scan].push_back(indices[point.scan][point.index]);
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    if (!registered.scans[k].left_out.empty()) continue;
    Cloud moved;
    pcl::transformPointCloud(*inputs[k].points, kept[k], moved, registered.scans[k].T_first_scan.matrix());
    *merged.shape.points += moved;
    merged.scans.resize(merged.shape.points->size(), static_cast<int>(k));
    pcl::PCLPointCloud2 part;
    pcl::copyPointCloud(inputs[k].fields(), kept[k], part);
    movePoints(part, Eigen::Affine3d(motions[k].matrix()));
    part = withFields(part, {"scan"}, {std::vector<float>(kept[k].size(), static_cast<float>(k))});
    if (k == first)
      merged.fields = part;
    else
      pcl::concatenate(merged.fields, pcl::PCLPointCloud2(part), merged.fields);
  }
  return merged;
}

int mergeScans(const AlignOptions& options) {
  const Console console(options.common.quiet);
  checkCloudExtension(*options.merge);
  const std::vector<std::optional<std::string>> outputs{options.merge, options.html_path, options.png_path,
                                                        options.common.json_path};
  for (const std::optional<std::string>& output : outputs)
    if (output) checkTarget(*output);
  const bool prints = isStandardOutputFree(outputs);
  std::vector<std::string> arguments{options.input};
  if (options.output) arguments.push_back(*options.output);
  arguments.insert(arguments.end(), options.more.begin(), options.more.end());
  std::vector<InputShape> inputs;
  for (const InputFile& file : inputFiles(arguments)) inputs.push_back(loadInput(console, file.path, options.common));
  for (const InputShape& input : inputs)
    if (!haveSameFields(input.fields(), inputs.front().fields()))
      throw InputError(input.path + ": has other fields than " + inputs.front().path);
  std::vector<ObjectScan> scans;
  std::vector<pcl::Indices> indices(inputs.size());
  for (std::size_t k = 0; k < inputs.size(); ++k)
    scans.push_back(namingFile(inputs[k].path, [&] {
      return objectScan(*inputs[k].points, inputs[k].viewpoint(options.common), indices[k]);
    }));
  Step step(console, "Registering " + counted(inputs.size(), "scan"));
  CloudRegistrationOptions registration;
  registration.seed = options.common.seed;
  registration.num_threads = options.common.threads;
  const RegisteredScans registered = registerAll(scans, registration);
  std::size_t first = inputs.size(), num_kept = 0;
  for (std::size_t k = inputs.size(); k-- > 0;) {
    if (!registered.scans[k].left_out.empty()) continue;
    first = k;
    ++num_kept;
  }
  step.done(std::to_string(num_kept) + " kept");
  if (num_kept == 0) throw InputError(inputs.front().path + ": " + registered.scans.front().left_out);
  std::vector<Eigen::Isometry3d> motions;
  std::string text;
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    motions.push_back(shiftedBack(registered.scans[k].T_first_scan, inputs[k].shift(), inputs[first].shift()));
    const ScanPose& scan = registered.scans[k];
    text += inputs[k].path + ": " +
            (scan.left_out.empty() ? formatted("confidence %.3f", scan.confidence) : "left out, " + scan.left_out) +
            "\n";
  }
  nlohmann::json json = describe(inputs, registered, motions);
  if (num_kept == 1 && inputs.size() > 1) {
    writeJson(options.common, json);
    if (prints) writeText("-", text);
    throw InputError(*options.merge + ": is not written, as no two of the scans fit each other");
  }
  Merged cloud = merged(inputs, scans, indices, registered, motions, first);
  cloud.shape.path = *options.merge;
  PicturePanel panel{"scans"};
  panel.segments = cloud.scans;
  for (std::size_t k = 0; k < inputs.size(); ++k)
    if (registered.scans[k].left_out.empty())
      panel.legend.emplace_back(k, boost::filesystem::path(inputs[k].path).filename().string());
  PictureScene scene{cloud.shape.points, std::nullopt, {panel}};
  std::exception_ptr incomplete;
  if (options.complete) {
    CommonOptions common = options.common;
    common.viewpoint = {Viewpoint::Mode::None, Eigen::Vector3d::Zero()};
    try {
      const BestPlane best = completingPlane(console, cloud.shape, common, options.any_plane);
      const auto both = complete(console, cloud.shape, common, best, cloud.fields, json["completed"]);
      scene = sceneOf(both, cloud.shape.points->size(), "the scans and what completes them", "scans", "added");
    } catch (const InputError&) {
      json.erase("completed");
      incomplete = std::current_exception();
    }
  }
  const std::size_t num_points = finiteIndices(cloud.fields).size();
  text += formatted("%zu of ", num_kept) + counted(inputs.size(), "scan") + ", " + counted(num_points, "point") +
          formatted(", one in each cube of %.3g\n", registered.resolution);
  writeJson(options.common, json);
  if (options.html_path) writePage(scene, {*options.merge, text}, *options.html_path);
  if (options.png_path) renderPicture({scene}, *options.png_path, 800, 600);
  save(console, cloud.shape.shape, std::move(cloud.fields), Eigen::Isometry3d::Identity(), *options.merge);
  if (prints) writeText("-", text);
  if (incomplete) std::rethrow_exception(incomplete);
  return 0;
}

int run(int argc, char** argv) {
  AlignOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  line.goWith("-complete", options.complete, {"any_plane"});
  const bool searches_plane = options.complete || options.symmetrize != "none";
  line.goWith("frames, -complete and -symmetrize", searches_plane || !(options.merge || options.target), {"grid"});
  if (options.merge) {
    for (const char* flag : {"target", "symmetrize", "cut", "landmarks", "as_published", "csv", "resume"})
      if (line.given(flag)) throw UsageError(std::string("-merge and -") + flag + " exclude each other");
    return mergeScans(options);
  }
  if (!options.more.empty()) throw UsageError("unexpected argument '" + options.more.front() + "' without -merge");
  if (options.output) checkCloudExtension(*options.output);
  if (options.complete && options.symmetrize != "none")
    throw UsageError("-complete and -symmetrize exclude each other");
  line.goWith("frames, without -target", !options.target, {"as_published"});
  line.goWith("-complete, -symmetrize and frames without -as_published", searches_plane || !options.as_published,
              {"viewpoint"});
  line.goWith("-symmetrize", options.symmetrize != "none", {"cut", "landmarks"});
  const bool is_written = options.output || options.html_path || options.png_path;
  if (options.complete && !is_written)
    throw UsageError("-complete needs an output, -html or -png to show what it adds");
  if (options.symmetrize != "none" && !is_written && !options.common.json_path && !options.landmarks)
    throw UsageError("-symmetrize needs an output, -html, -png, -json or -landmarks");
  options.batch.inputs = {options.input};
  std::vector<std::string> columns{"converged"};
  for (const char row : {'0', '1', '2', '3'})
    for (const char column : {'0', '1', '2', '3'}) columns.push_back(std::string("t") + row + column);
  return runOnFiles(options.batch, options.common, columns, [&](FileJob& job) { analyze(options, job); });
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
