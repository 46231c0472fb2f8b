#include "evaluate/scenes/scenes.h"

#include <pcl/common/point_tests.h>
#include <pcl/conversions.h>

#include <algorithm>
#include <boost/filesystem.hpp>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "common/command_line/command_line.h"
#include "common/command_line/console.h"
#include "common/files/json_values.h"
#include "common/shape_input/shape_input.h"
#include "common/shape_output/cloud_fields.h"
#include "common/shape_output/shape_output.h"
#include "core/base/random.h"
#include "evaluate/references/reference_cache.h"
#include "evaluate/registration/motion_error.h"
#include "evaluate/runs/packed_rows.h"
#include "evaluate/runs/shared_database.h"
#include "evaluate/runs/shared_references.h"
#include "evaluate/scenes/recognition_curve.h"
#include "evaluate/scenes/scene_report.h"
#include "evaluate/scenes/table_scene.h"
#include "evaluate/shared/model_flags.h"
#include "evaluate/shared/model_list.h"
#include "pcl_symmetry/mesh_sampling.h"
#include "pcl_symmetry/scene/symmetry_scene.h"

namespace pcl_symmetry::apps {

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

// Diagonals of the models, metres. chosen: things that stand on tables; at half, few pixels show them.
constexpr double kLeastDiagonal = 0.15, kGreatestDiagonal = 0.30;
// Greatest error of a right pose, as a share of the diameter.
// derived: the limit of the benchmark for object poses (BOP, maximum symmetry-aware surface distance).
constexpr double kRightPose = 0.05;
// Metres that an object may seem to reach into the table. chosen: three deviations of the depth at 1 m; half takes
// noise for a contradiction, twice lets reflections sink into the table.
constexpr double kTableMargin = 0.004;
// Greatest lead over another model that counts. derived: as in the confidence of the library, which leaves out models
// of the same shape; here each model counts, as hardly two are.
constexpr double kMostLead = 0.3;
// Points of a model in the database. chosen: as many as in `recognition`.
constexpr int kModelPoints = 20'000;

struct EvaluateScenesOptions {
  std::vector<std::string> folders;
  ModelSelection selection;
  ReferenceOptions references;
  std::optional<std::string> references_path, export_folder, csv, journal;
  std::vector<double> noise = {0.0, 1.0};
  int num_scenes = 100, min_points = 300, leave_out = 0, most_in_band = 0;
  double least_occlusion = 0.0;
  bool no_planes = false, fit = false;
  std::optional<std::string> seen, curve;
  std::string place = "table", sensor = "camera";
  int num_rings = 64;
  SceneOptionsOfTable table;
  MatchLimits limits;
  OperatingPoint operating_point;
  RecognitionOptions recognition;
  CommonOptions common;
};

CommandLine commandLine(EvaluateScenesOptions& o) {
  CommandLine line(
      "pcl_symmetry_evaluate scenes",
      "Puts meshes on a table or in a bin, looks at them with a depth camera or a LiDAR scanner, and measures how well "
      "planes and models of objects are found that others hide in part. Clusters are the true ones.",
      "pcl_symmetry_evaluate scenes psb/train -max 100 -scenes 100 -references references.json");
  addModelFlags(line, o.folders, o.selection);
  line.text("references", "FILE", o.references_path,
            "reference planes: read for the meshes in it, extended by the others")
      .number("scenes", o.num_scenes, Range::closed(1, 1'000'000), "number of scenes")
      .number("objects", o.table.most_objects, Range::closed(1, 100), "greatest number of objects of a scene")
      .numbers("noise", o.noise, Range::closed(0, 10),
               "factors of the depth noise of a structured-light camera, or of the range noise of a scanner; 0 = exact")
      .choice("place", o.place, {"table", "bin"}, "where objects stand: on a table, or in an open box seen from above")
      .choice("sensor", o.sensor, {"camera", "lidar"}, "depth camera of 640 x 480 pixels, or a scanner with rings")
      .number("rings", o.num_rings, Range::closed(4, 1024), "number of rings of the scanner")
      .number("min_points", o.min_points, Range::closed(20, 1'000'000), "least number of points of an object")
      .number("least_occlusion", o.least_occlusion, Range::closed(0, 1),
              "share of an object that others hide below which it is passed over")
      .number("most_in_band", o.most_in_band, Range::closed(0, 1'000'000),
              "objects of a band of occlusion after which others of it are passed over; 0 = none are")
      .number("leave_out", o.leave_out, Range::closed(0, 1'000'000),
              "also ask a database which model an object is; every N-th model is left out of it; 0 = do not ask")
      .number("accept", o.recognition.min_confidence, Range::closed(0, 1),
              "least confidence of a name that is accepted")
      .flag("fit", o.fit, "print the numbers of the confidence of names that fit these answers best")
      .number("candidates", o.recognition.num_candidates, Range::closed(1, 1'000'000),
              "number of models that are brought to an object")
      .flag("no_planes", o.no_planes, "only ask the database")
      .text("seen", "LIST", o.seen,
            "only ask in these of the ways alone, scene, table and filtered, with commas between")
      .number("min_confidence", o.operating_point.min_confidence, Range::closed(0, 1),
              "least confidence of an answer that decides")
      .text("export", "DIR", o.export_folder,
            "write every scene as PCD with the field object, ground_truth.json with poses and planes, and with "
            "-leave_out "
            "the database, models.db")
      .text("csv", "FILE", o.csv, "a row for each object")
      .text("curve", "FILE", o.curve, "CSV of what is recognized by the least confidence that is asked for")
      .common(o.common, kJson | kSeed | kThreads | kQuiet);
  ResumableRun::addFlag(line, o.journal);
  return line;
}

/// An object of a scene that can be asked about.
struct SeenObject {
  int scene;
  std::size_t noise;  ///< index
  std::size_t object;

  bool operator<(const SeenObject& other) const {
    return std::tie(scene, noise, object) < std::tie(other.scene, other.noise, other.object);
  }
};

/// And how much of it others hide.
struct SeenObjectInBand {
  SeenObject object;
  std::size_t band;
};

void put(detail::PackedBytes& bytes, const SeenObjectInBand& seen) {
  bytes.put(seen);
}

void get(detail::UnpackedBytes& bytes, SeenObjectInBand& seen) {
  seen = bytes.get<SeenObjectInBand>();
}

class ScenesEvaluation {
public:
  ScenesEvaluation(const EvaluateScenesOptions& options, ResumableRun& work)
      : options_(options),
        work_(work),
        console_(options.common.quiet || !work.isFirst()),
        cache_(options.references_path.value_or(""), options.references) {}

  void run() {
    load();
    if (options_.leave_out > 0) build();
    if (options_.export_folder) makeFolder(*options_.export_folder);
    if (options_.export_folder && database_ && work_.isFirst()) exportDatabase();
    if (options_.most_in_band > 0) choose();
    Step step(console_, "Looking at " + std::to_string(options_.num_scenes) + " scenes");
    const auto evaluated = rowsOfItems<SceneResult>(
        namesOfScenes("scene "), [&](std::size_t i) { return evaluate(static_cast<int>(i)); }, work_, step);
    if (!work_.isFirst()) return;
    for (const ItemRows<SceneResult>& scene : evaluated)
      if (!scene.attached.empty()) ground_truth_.update(nlohmann::json::parse(scene.attached));
    const std::size_t num_left_out = left_out_.size();
    results_ = joinedRows(evaluated, left_out_);
    step.done(std::to_string(results_.size()) + " objects");
    for (std::size_t i = num_left_out; i < left_out_.size(); ++i) console_.warn("left out: " + left_out_[i]);
    report();
  }

private:
  void load() {
    const std::vector<Model> models = listModels(options_.folders, options_.selection);
    shareReferences(models, options_.references, cache_, work_, console_);
    Step step(console_, "Loading " + std::to_string(models.size()) + " models");
    for (std::size_t i = 0; i < models.size(); ++i) {
      step.progress(static_cast<double>(i) / static_cast<double>(models.size()));
      try {
        add(models[i]);
      } catch (const std::exception& error) {
        left_out_.push_back(models[i].path + ": " + error.what());
      }
    }
    step.done(std::to_string(models_.size()) + " models");
    for (const std::string& reason : left_out_) console_.warn("left out: " + reason);
    if (models_.empty()) throw InputError(options_.folders.front() + ": no mesh could be used");
  }

  void add(const Model& model) {
    const Shape shape = loadShape(model.path);
    if (!shape.mesh) throw InputError("has no faces");
    const TriangleScene own(*shape.mesh);
    RandomStream random(options_.common.seed, models_.size());
    const double diagonal = kLeastDiagonal + (kGreatestDiagonal - kLeastDiagonal) * random.uniform();
    SceneModel scene_model(model.name, *shape.mesh, diagonal);
    const std::optional<ReferenceSymmetries> known = cache_.find(model.key, shape.mesh->polygons.size());
    const ReferenceSymmetries references = known ? *known : findReferenceSymmetries(*shape.mesh, options_.references);
    models_.push_back(std::move(scene_model));
    references_.push_back(references.scaled(own.center(), diagonal / own.diagonal()));
  }

  bool isLeftOut(std::size_t model) const {
    const auto every = static_cast<std::size_t>(options_.leave_out);
    return every < 1 || model % every == every - 1;
  }

  void build() {
    Step step(console_, "Building a database");
    std::vector<ModelInput> inputs;
    for (std::size_t i = 0; i < models_.size(); ++i) {
      if (isLeftOut(i)) continue;
      const SceneModel& model = models_[i];
      inputs.push_back(
          {model.name, {}, [&model, this] { return *sampleMesh(model.mesh, kModelPoints, options_.common.seed + 1); }});
    }
    DatabaseOptions database;
    database.num_threads = options_.common.threads;
    database_.emplace(inputs, database, work_, [&](double share) { step.progress(share); });
    for (const auto& [name, reason] : database_->failures()) throw InputError(name + ": " + reason);
    step.done(std::to_string((*database_)->size()) + " models");
  }

  void exportDatabase() const {
    const boost::filesystem::path path = boost::filesystem::path(*options_.export_folder) / "models.db";
    boost::filesystem::remove(path);
    SymmetryDatabase(path.string()).importFrom(database_->path());
  }

  std::vector<std::string> namesOfScenes(const std::string& what) const {
    std::vector<std::string> names;
    for (int i = 0; i < options_.num_scenes; ++i) names.push_back(what + std::to_string(i));
    return names;
  }

  struct Scene {
    std::uint64_t seed;
    TableScene scene;
  };

  Scene sceneOf(int number) const {
    const std::uint64_t seed = RandomStream(options_.common.seed, static_cast<std::uint64_t>(number))();
    return {seed, drawScene(models_, options_.table, seed)};
  }

  /// What the sensor sees of a scene.
  struct Look {
    SceneImage image;
    std::vector<pcl::Indices> clusters;  ///< points of each object

    bool shows(std::size_t object, const EvaluateScenesOptions& options) const {
      const double occlusion = image.occlusion(object);
      return !image.cropped[object] && clusters[object].size() >= static_cast<std::size_t>(options.min_points) &&
             bandOf(occlusion) && occlusion >= options.least_occlusion;
    }
  };

  Look lookAt(const Scene& scene, double noise) const {
    DepthNoise camera;
    camera.factor = noise;
    Look look{renderScene(models_, scene.scene, camera, scene.seed),
              std::vector<pcl::Indices>(scene.scene.objects.size())};
    const SceneImage& image = look.image;
    for (std::size_t i = 0; i < image.ids.size(); ++i)
      if (image.ids[i] >= 0 && pcl::isXYZFinite((*image.cloud)[i]))
        look.clusters[static_cast<std::size_t>(image.ids[i])].push_back(static_cast<pcl::index_t>(i));
    return look;
  }

  /// Chooses the first objects of each band, in the order of the scenes.
  void choose() {
    Step step(console_, "Counting objects of " + std::to_string(options_.num_scenes) + " scenes");
    const auto seen = rowsOfItems<SeenObjectInBand>(
        namesOfScenes("objects of scene "), [&](std::size_t i) { return objectsOf(static_cast<int>(i)); }, work_, step);
    std::map<std::pair<double, std::size_t>, int> num_in_band;  // by noise
    detail::PackedBytes wanted;
    std::vector<std::string> lost;  // these scenes are looked for once more
    for (const SeenObjectInBand& one : joinedRows(seen, lost))
      if (++num_in_band[{options_.noise[one.object.noise], one.band}] <= options_.most_in_band) wanted.put(one.object);
    std::string text = wanted.bytes();
    work_.broadcast(text);
    detail::UnpackedBytes bytes(text);
    while (bytes.left() > 0) wanted_.insert(bytes.get<SeenObject>());
    step.done(std::to_string(wanted_.size()) + " objects");
  }

  ItemRows<SeenObjectInBand> objectsOf(int number) const {
    const Scene scene = sceneOf(number);
    ItemRows<SeenObjectInBand> item;
    for (std::size_t n = 0; n < options_.noise.size(); ++n) {
      const Look look = lookAt(scene, options_.noise[n]);
      for (std::size_t k = 0; k < look.clusters.size(); ++k)
        if (look.shows(k, options_)) item.rows.push_back({{number, n, k}, bandOf(look.image.occlusion(k)).value()});
    }
    return item;
  }

  bool isWanted(const SeenObject& object) const { return options_.most_in_band == 0 || wanted_.count(object) > 0; }

  bool isLookedAt(int number, std::size_t noise) const {
    if (options_.most_in_band == 0 || options_.export_folder) return true;
    const auto first = wanted_.lower_bound({number, noise, 0});
    return first != wanted_.end() && first->scene == number && first->noise == noise;
  }

  ItemRows<SceneResult> evaluate(int number) {
    ItemRows<SceneResult> item;
    nlohmann::json ground_truth = nlohmann::json::object();
    std::optional<Scene> scene;
    for (std::size_t n = 0; n < options_.noise.size(); ++n) {
      if (!isLookedAt(number, n)) continue;
      if (!scene) scene = sceneOf(number);
      const Look look = lookAt(*scene, options_.noise[n]);
      if (options_.export_folder) exportScene(number, scene->scene, look.image, options_.noise[n], ground_truth);
      evaluate(number, n, *scene, look, item.rows);
    }
    if (!ground_truth.empty()) item.attached = ground_truth.dump();
    return item;
  }

  void evaluate(int number, std::size_t noise, const Scene& of, const Look& look, std::vector<SceneResult>& results) {
    const SceneImage& image = look.image;
    const TableScene& scene = of.scene;
    const auto seen = std::make_shared<const SeenSpace>(*image.cloud);
    const auto on_table = std::make_shared<const SeenSpace>(withPlace(*seen, scene));
    const Cloud::ConstPtr filtered =
        isAsked("filtered") ? withoutDepthErrors(image.cloud, *seen, options_.common.threads) : image.cloud;
    const auto filtered_seen = std::make_shared<const SeenSpace>(withPlace(SeenSpace(*filtered), scene));
    for (std::size_t k = 0; k < look.clusters.size(); ++k) {
      if (!look.shows(k, options_) || !isWanted({number, noise, k})) continue;
      const pcl::Indices& cluster = look.clusters[k];
      // The cluster alone: as a user who cuts it out and keeps the viewpoint gives it.
      auto alone = pcl::make_shared<Cloud>(*image.cloud, cluster);
      alone->sensor_origin_ = image.cloud->sensor_origin_;
      alone->sensor_orientation_ = image.cloud->sensor_orientation_;
      SceneResult result;
      result.scene = number;
      result.noise = options_.noise[noise];
      result.occlusion = image.occlusion(k);
      if (isAsked("alone"))
        results.push_back(judged(
            scene.objects[k], "alone", *alone, result,
            [&] { return detectAnswers(alone, options_.common.seed + 1, options_.common.threads); },
            [&] { return (*database_)->recognize(*alone, recognition()); }));
      const auto judgeIn = [&](const char* row, const Cloud::ConstPtr& frame, const SeenSpace::ConstPtr& space) {
        if (!isAsked(row)) return;
        results.push_back(judged(
            scene.objects[k], row, *alone, result,
            [&] { return detectAnswers(frame, cluster, space, options_.common.seed + 1, options_.common.threads); },
            [&] { return (*database_)->recognize(*frame, cluster, recognition(), space); }));
      };
      judgeIn("scene", image.cloud, seen);
      judgeIn("table", image.cloud, on_table);
      if (filtered != image.cloud) judgeIn("filtered", filtered, filtered_seen);
    }
  }

  bool isAsked(const std::string& row) const {
    return !options_.seen || ("," + *options_.seen + ",").find("," + row + ",") != std::string::npos;
  }

  /// No object reaches into the table or into the walls of a bin.
  static SeenSpace withPlace(const SeenSpace& seen, const TableScene& scene) {
    SeenSpace result = seen.withSupport(Eigen::Vector4d::UnitZ(), kTableMargin);
    if (!scene.bin) return result;
    for (const Eigen::Vector4d& face : scene.bin->innerFaces()) result = result.withSupport(face, kTableMargin);
    return result;
  }

  RecognitionOptions recognition() const {
    RecognitionOptions options = options_.recognition;
    options.num_threads = options_.common.threads;
    options.min_merit = -1.0;
    options.min_confidence = 0.0;  // answers that are not accepted show what another operating point would give
    return options;
  }

  /// \param result knows scene, noise and occlusion.
  template <typename Detect, typename Recognize>
  SceneResult judged(const PlacedModel& object, const std::string& row, const Cloud& cluster, SceneResult result,
                     const Detect& detect, const Recognize& recognize) const {
    const ReferenceSymmetries references = references_[object.model].transformed(object.T_scene_model);
    result.row = row;
    result.asked_planes = !options_.no_planes;
    CloudResult planes;
    planes.model = models_[object.model].name;
    planes.num_points = cluster.size();
    planes.kind = references.kind;
    planes.best_share = references.best_share;
    planes.operating_point = options_.operating_point;
    if (!options_.no_planes) planes.answers = detect();
    planes.match = matchAnswers(planes.answers.answers, references, options_.limits);
    result.planes = std::move(planes);
    if (options_.leave_out > 0) result.recognition = judged(object, recognize);
    return result;
  }

  template <typename Recognize>
  RecognitionResult judged(const PlacedModel& object, const Recognize& recognize) const {
    RecognitionResult result;
    result.is_known = !isLeftOut(object.model);
    Stopwatch watch;
    const Recognition found = recognize();
    result.milliseconds = watch.lap();
    if (found.empty()) return result;
    result.answer = found.front().name;
    result.support = found.front().score.support;
    result.conflict = found.front().score.conflict;
    result.merit = found.front().score.merit();
    result.confidence = found.front().confidence;
    result.lead = std::min(kMostLead, result.merit - (found.size() > 1 ? found[1].score.merit() : 0.0));
    result.accepted =
        result.confidence >= options_.recognition.min_confidence && result.merit >= options_.recognition.min_merit;
    result.is_right = result.answer == models_[object.model].name;
    const ReferenceSymmetries& symmetries = references_[object.model];
    const MotionError error = motionError(found.front().T_model_scan, object.T_scene_model.inverse(), symmetries);
    // No point of the model is farther off than this.
    const double farthest = error.distance + symmetries.diagonal * std::sin(0.5 * error.angle);
    result.right_pose = result.is_right && farthest < kRightPose * symmetries.diameter;
    return result;
  }

  void exportScene(int number, const TableScene& scene, const SceneImage& image, double noise,
                   nlohmann::json& ground_truth) const {
    char name[64];
    std::snprintf(name, sizeof(name), "scene_%04d_noise_%g", number, noise);
    pcl::PCLPointCloud2 fields;
    pcl::toPCLPointCloud2(*image.cloud, fields);
    const std::vector<float> ids(image.ids.begin(), image.ids.end());
    saveCloud((boost::filesystem::path(*options_.export_folder) / (std::string(name) + ".pcd")).string(),
              withFields(fields, {"object"}, {ids}), image.cloud->sensor_origin_, image.cloud->sensor_orientation_);
    nlohmann::json objects = nlohmann::json::array();
    for (std::size_t k = 0; k < scene.objects.size(); ++k) {
      const PlacedModel& object = scene.objects[k];
      objects.push_back({{"object", k},
                         {"model", models_[object.model].name},
                         {"diagonal", references_[object.model].diagonal},
                         {"T_scene_model", rowMajor(object.T_scene_model)},
                         {"num_visible", image.num_visible[k]},
                         {"num_alone", image.num_alone[k]},
                         {"symmetries", toJson(references_[object.model].transformed(object.T_scene_model))}});
    }
    ground_truth[name] = objects;
  }

  void report() const {
    if (options_.export_folder)
      writeText((boost::filesystem::path(*options_.export_folder) / "ground_truth.json").string(),
                nlohmann::json{{"scenes", ground_truth_}}.dump(1) + "\n");
    std::fputs(sceneTable(results_).c_str(), stdout);
    if (options_.leave_out > 0) printReliability(recognitionReliability(results_));
    if (options_.fit) std::fputs(fittedConfidence(results_).c_str(), stdout);
    if (options_.csv) writeText(*options_.csv, sceneCSV(results_));
    if (options_.curve) writeText(*options_.curve, recognitionCurveCSV(results_));
    if (!options_.common.json_path) return;
    const nlohmann::json summary{{"models", models_.size()},     {"scenes", options_.num_scenes},
                                 {"place", options_.place},      {"sensor", options_.sensor},
                                 {"seed", options_.common.seed}, {"left_out", left_out_},
                                 {"rows", sceneJson(results_)}};
    writeText(*options_.common.json_path, summary.dump(2) + "\n");
  }

  const EvaluateScenesOptions& options_;
  ResumableRun& work_;
  const Console console_;
  ReferenceCache cache_;
  std::optional<SharedDatabase> database_;
  std::vector<SceneModel> models_;
  std::vector<ReferenceSymmetries> references_;  ///< of the models
  std::vector<std::string> left_out_;
  std::set<SeenObject> wanted_;  ///< where bands have a limit
  std::vector<SceneResult> results_;
  nlohmann::json ground_truth_ = nlohmann::json::object();
};

}  // namespace

int evaluateScenes(int argc, char** argv, SharedWork& processes) {
  EvaluateScenesOptions options;
  if (!commandLine(options).parse(argc, argv)) return 0;
  if (options.fit && options.leave_out < 1) throw UsageError("-fit needs -leave_out");
  if (options.no_planes && options.leave_out < 1) throw UsageError("-no_planes needs -leave_out");
  options.table.in_bin = options.place == "bin";
  if (options.sensor == "lidar") options.table.sensor = SceneSensor::lidar(options.num_rings);
  ResumableRun work(processes, options.journal, argc, argv);
  options.common.threads = options.references.num_threads = work.threadsOfItem(options.common.threads);
  ScenesEvaluation(options, work).run();
  return 0;
}

}  // namespace pcl_symmetry::apps
