#include "evaluate/frames/alignment.h"

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "common/command_line/command_line.h"
#include "common/command_line/console.h"
#include "common/shape_input/shape_input.h"
#include "common/shape_output/shape_output.h"
#include "core/base/constants.h"
#include "evaluate/clouds/test_clouds.h"
#include "evaluate/frames/alignment_report.h"
#include "evaluate/frames/frame_difference.h"
#include "evaluate/frames/mesh_ties.h"
#include "evaluate/references/reference_symmetries.h"
#include "evaluate/runs/packed_rows.h"
#include "evaluate/segmentation/patches.h"
#include "evaluate/shared/class_file.h"
#include "evaluate/shared/model_flags.h"
#include "evaluate/shared/model_list.h"
#include "pcl_symmetry/core/frame/symmetry_frame.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"

namespace pcl_symmetry::apps {

namespace {

constexpr int kNumPatches = 10;      // chosen: half removes whole parts, twice small spots everywhere
constexpr double kRightAngle = 5.0;  // degrees; chosen: of the design page; half and twice shift all methods alike

struct EvaluateAlignmentOptions {
  std::vector<std::string> folders;
  ModelSelection selection;
  std::optional<std::string> class_path;
  int num_points = 10'000, num_views = 8;
  double noise = 0.0, missing = 0.0;
  bool ties = false;
  std::optional<std::string> methods;
  std::optional<std::string> cloud_csv, histogram_csv, png, journal;
  CommonOptions common;
};

CommandLine commandLine(EvaluateAlignmentOptions& o) {
  CommandLine line("pcl_symmetry_evaluate alignment",
                   "Scans meshes from the corners of a cube and compares the canonical frames of scans and wholes, by "
                   "symmetry and by center of mass with principal axes (Section 5.1).",
                   "pcl_symmetry_evaluate alignment psb/train -every 8 -csv frames.csv -png misalignment.png");
  addModelFlags(line, o.folders, o.selection);
  line.text("cla", "FILE", o.class_path, "only the models of this classification of the Princeton Shape Benchmark")
      .number("num_views", o.num_views, Range::closed(1, 8), "number of scans of each mesh")
      .number("points", o.num_points, Range::closed(100, 10'000'000), "number of points per cloud")
      .number("noise", o.noise, Range::closed(0, 1),
              "standard deviation of the noise, along the ray for scans, in diagonals")
      .number("missing", o.missing, Range{0, 1, false, true}, "share of the points of each cloud, taken in ten patches")
      .text("methods", "A,B,...", o.methods,
            "rows beside symmetry and mass and PCA: no free space, first maximum, exact map, exact map ISP, mass + "
            "0.15 R "
            "(all)")
      .flag("ties", o.ties,
            "compare with the frame of the whole up to the symmetries of the mesh, by brute force (a second a mesh)")
      .text("csv", "FILE", o.cloud_csv, "a row for each cloud and method")
      .text("histogram_csv", "FILE", o.histogram_csv, "histograms of misalignment (Figure 12)")
      .picture("png", o.png, "their charts: NAME_translation.png, NAME_rotation.png")
      .common(o.common, kJson | kSeed | kThreads | kQuiet);
  ResumableRun::addFlag(line, o.journal);
  return line;
}

class AlignmentEvaluation {
public:
  AlignmentEvaluation(const EvaluateAlignmentOptions& options, ResumableRun& work)
      : options_(options), work_(work), console_(options.common.quiet || !work.isFirst()) {
    clouds_.num_points = options.num_points;
    clouds_.noise = clouds_.scan_noise = {options.noise};
    clouds_.num_views = options.num_views;
    clouds_.seed = options.common.seed;
    std::vector<std::string> names;
    if (options.methods) boost::split(names, *options.methods, boost::is_any_of(","));
    methods_ = alignmentMethods(names);
  }

  void run() {
    std::vector<Model> models = listModels(options_.folders, options_.selection);
    if (options_.class_path) {
      const std::set<std::string> wanted = modelsOfClassFile(*options_.class_path);
      models.erase(std::remove_if(models.begin(), models.end(), [&](const Model& m) { return !wanted.count(m.name); }),
                   models.end());
    }
    Step step(console_, "Evaluating " + std::to_string(models.size()) + " models");
    errors_ = joinedRows(rowsOfModels<FrameErrors>(
                             models, [&](const Model& model) { return evaluate(model); }, work_, step),
                         left_out_);
    if (!work_.isFirst()) return;
    step.done(std::to_string(errors_.size() / methods_.size()) + " clouds");
    for (const std::string& reason : left_out_) console_.warn("left out: " + reason);
    if (errors_.empty()) throw InputError(options_.folders.front() + ": no mesh could be used");
    report();
  }

private:
  ItemRows<FrameErrors> evaluate(const Model& model) {
    try {
      const Shape shape = loadShape(model.path);
      if (!shape.mesh) throw InputError(model.path + ": has no faces");
      const TestCloudMaker maker(*shape.mesh, model.key, clouds_);
      const double diagonal = VirtualScanner(*shape.mesh).diagonal();
      Wholes wholes;
      if (options_.ties) wholes.ties = tiesOf(findReferenceSymmetries(*shape.mesh, referenceOptions()));
      std::vector<FrameErrors> errors;
      std::vector<Eigen::Matrix3d> axes;  // axes of each frame, in the frame of the whole cloud
      for (const CloudRecipe& recipe : recipesFor(clouds_))
        evaluate(model, maker, recipe, diagonal, wholes, errors, axes);
      markAsGood(wholes, axes, errors);
      return {std::move(errors), ""};
    } catch (const InputError& error) {
      return {{}, error.what()};
    } catch (const std::exception& error) {
      return {{}, model.path + ": " + error.what()};
    }
  }

  /// The whole cloud of a model.
  struct Wholes {
    std::vector<FoundFrame> frames;  ///< by each method, in the model's frame
    pcl::PointCloud<pcl::PointXYZ>::ConstPtr cloud;
    Eigen::Isometry3d T_cloud_model = Eigen::Isometry3d::Identity();
    std::optional<MeshTies> ties;  ///< of the mesh, in its frame
  };

  ReferenceOptions referenceOptions() const {
    ReferenceOptions search;
    search.seed = options_.common.seed + 1;
    search.num_threads = options_.common.threads;
    return search;
  }

  /// \param wholes filled by the first recipe.
  void evaluate(const Model& model, const TestCloudMaker& maker, const CloudRecipe& recipe, double diagonal,
                Wholes& wholes, std::vector<FrameErrors>& errors, std::vector<Eigen::Matrix3d>& axes) {
    const TestCloud made = maker.make(recipe);
    if (options_.missing > 0.0)
      removePatches(*made.cloud, options_.missing, kNumPatches, options_.common.seed + recipe.view + 1);
    const bool whole = recipe.view < 0;
    if (whole) {
      wholes.cloud = made.cloud;
      wholes.T_cloud_model = made.T_cloud_model;
    }
    std::optional<Eigen::Vector3d> viewpoint;
    if (!whole) viewpoint = made.cloud->sensor_origin_.head<3>().cast<double>();
    const Eigen::Isometry3d T_model_cloud = made.T_cloud_model.inverse();
    for (std::size_t m = 0; m < methods_.size(); ++m) {
      const auto find = [&] {
        return findFrame(methods_[m], made.cloud, viewpoint, options_.common.seed + 1, options_.common.threads);
      };
      if (!warm_) find();  // threads, tables and pages are there from the second call on
      warm_ = true;
      const FoundFrame found = find().transformed(T_model_cloud);
      if (whole) wholes.frames.push_back(found);
      FrameErrors e = errorsOf(found, wholes.frames[m], diagonal);
      if (wholes.ties) e.tied_angle = angleUpToTies(found.axes, wholes.frames[m].axes, *wholes.ties);
      e.model = model.name;
      e.view = recipe.view;
      e.method = methods_[m];
      errors.push_back(std::move(e));
      axes.emplace_back(wholes.T_cloud_model.linear() * found.axes);
    }
  }

  /// Frames whose planes are as good symmetries of the whole, each in its rank, as those of the frame that was found of
  /// it by symmetry, or that are near one that the whole's frame says is equally good.
  void markAsGood(const Wholes& wholes, const std::vector<Eigen::Matrix3d>& axes,
                  std::vector<FrameErrors>& errors) const {
    FrameOptions options;
    options.num_threads = options.edt.num_threads = options_.common.threads;
    const Points points = detail::selectPoints(*wholes.cloud, nullptr, wholes.cloud->size(), 0).points;
    std::vector<Eigen::Vector3d> scores = axisScores(points, axes, options);
    for (Eigen::Vector3d& s : scores) std::sort(s.data(), s.data() + 3);
    for (std::size_t i = 0; i < errors.size(); ++i)
      errors[i].as_good =
          errors[i].equal_axes_angle < kRightAngle || (scores[i].array() >= scores.front().array() - options.tie).all();
  }

  static FrameErrors errorsOf(const FoundFrame& found, const FoundFrame& whole, double diagonal) {
    FrameErrors e;
    const Eigen::Matrix3d own = Eigen::Matrix3d::Identity();
    e.own_angle = angleOfAxes(found.axes, own);
    e.own_turned_angle = std::min(e.own_angle, angleOfAxes(found.axes, own, ownRevolution(whole)));
    e.center = (found.center - whole.center).norm() / diagonal;
    e.axes_angle = angleOfAxes(found.axes, whole.axes);
    e.frame_angle = angleToNearest(found.axes, whole.equivalent, whole.revolution_axis);
    e.equal_axes_angle = e.axes_angle;
    for (const Eigen::Matrix3d& axes : whole.equivalent)
      e.equal_axes_angle = std::min(e.equal_axes_angle, angleOfAxes(found.axes, axes, whole.revolution_axis));
    e.milliseconds = found.milliseconds;
    return e;
  }

  /// The model's own axis that its axis of revolution is; -1: none is, 3: a sphere.
  static int ownRevolution(const FoundFrame& whole) {
    if (whole.revolution_axis < 0 || whole.revolution_axis > 2) return whole.revolution_axis;
    int axis = 0;
    const double cosine = whole.axes.col(whole.revolution_axis).cwiseAbs().maxCoeff(&axis);
    return cosine >= std::cos(kRightAngle * kPi / 180.0) ? axis : -1;
  }

  void report() {
    const std::vector<AlignmentStatistics> statistics = summarize(errors_);
    printTable(statistics);
    printIntervals(statistics);
    if (options_.cloud_csv) writeText(*options_.cloud_csv, frameCSV(errors_));
    if (options_.histogram_csv) writeText(*options_.histogram_csv, histogramCSV(errors_));
    if (options_.common.json_path) {
      const nlohmann::json summary{{"noise", options_.noise},
                                   {"missing", options_.missing},
                                   {"seed", options_.common.seed},
                                   {"left_out", left_out_},
                                   {"methods", toJson(statistics)}};
      writeText(*options_.common.json_path, summary.dump(2) + "\n");
    }
    if (options_.png) drawHistograms(errors_, *options_.png);
  }

  const EvaluateAlignmentOptions& options_;
  ResumableRun& work_;
  const Console console_;
  TestCloudOptions clouds_;
  std::vector<AlignmentMethod> methods_;
  bool warm_ = false;
  std::vector<FrameErrors> errors_;
  std::vector<std::string> left_out_;
};

}  // namespace

int evaluateAlignment(int argc, char** argv, SharedWork& processes) {
  EvaluateAlignmentOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  ResumableRun work(processes, options.journal, argc, argv);
  options.common.threads = work.threadsOfItem(options.common.threads);
  AlignmentEvaluation(options, work).run();
  return 0;
}

}  // namespace pcl_symmetry::apps
