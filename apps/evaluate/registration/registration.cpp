#include "evaluate/registration/registration.h"

#include <pcl/console/print.h>

#include <boost/algorithm/string.hpp>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/command_line/command_line.h"
#include "common/command_line/console.h"
#include "common/shape_input/shape_input.h"
#include "common/shape_output/shape_output.h"
#include "core/base/constants.h"
#include "core/base/random.h"
#include "evaluate/clouds/test_clouds.h"
#include "evaluate/planes/plane_statistics.h"
#include "evaluate/references/reference_cache.h"
#include "evaluate/registration/motion_error.h"
#include "evaluate/registration/registration_methods.h"
#include "evaluate/runs/packed_rows.h"
#include "evaluate/runs/shared_references.h"
#include "evaluate/segmentation/patches.h"
#include "evaluate/shared/model_flags.h"
#include "evaluate/shared/model_list.h"
#include "pcl_symmetry/mesh_sampling.h"

namespace pcl_symmetry::apps {

namespace {

constexpr int kNumPatches = 10;  // chosen: half removes whole parts, twice small spots everywhere

struct EvaluateRegistrationOptions {
  std::vector<std::string> folders;
  ModelSelection selection;
  std::optional<std::string> references_path;
  int num_points = 10'000, num_views = 8;
  double noise = 0.0, missing = 0.0;
  double max_angle = 5.0, max_distance = 0.02;
  std::optional<double> around;  ///< degrees
  double around_distance = 0.1;  ///< diagonals
  std::optional<std::string> methods;
  bool impostors = false;
  std::optional<std::string> csv, journal;
  CommonOptions common;
};

CommandLine commandLine(EvaluateRegistrationOptions& o) {
  CommandLine line("pcl_symmetry_evaluate registration",
                   "Scans meshes from one side, in random poses, and measures how well the scans are brought back to "
                   "whole clouds of the meshes.",
                   "pcl_symmetry_evaluate registration psb/train -every 8 -first 2 -csv registration.csv");
  addModelFlags(line, o.folders, o.selection);
  line.text("references", "FILE", o.references_path,
            "symmetries of the meshes: read for the meshes in it, extended by the others")
      .number("points", o.num_points, Range::closed(100, 10'000'000),
              "number of points of a model, and wanted number for a scan")
      .number("num_views", o.num_views, Range::closed(1, 8), "number of scans of each mesh, from the corners of a cube")
      .number("noise", o.noise, Range::closed(0, 1), "standard deviation of the depth in scans, in diagonals")
      .number("missing", o.missing, Range{0, 1, false, true}, "share of a scan that is removed, in patches")
      .number("max_angle", o.max_angle, Range::open(0, 180), "largest rotation error of a right registration, degrees")
      .number("max_distance", o.max_distance, Range::open(0, 1),
              "largest error at the center of the model of a right registration, in diagonals")
      .number("around", o.around, Range::upTo(0, 90),
              "tracks: gives a guess that is off by this angle, degrees, for a search within half as much again")
      .number("around_distance", o.around_distance, Range::closed(0, 10), "and by this distance, diagonals")
      .text("methods", "A,B,...", o.methods,
            "methods: symmetry, anew, frames, rotations, pca, features (symmetry,pca,features)")
      .flag("impostors", o.impostors, "also try each scan with the mesh before its own, where nothing should fit")
      .text("csv", "FILE", o.csv, "a row for each scan and method")
      .common(o.common, kJson | kSeed | kThreads | kQuiet);
  ResumableRun::addFlag(line, o.journal);
  return line;
}

std::vector<RegistrationMethod> chosenMethods(const std::string& names) {
  std::vector<std::string> wanted;
  boost::algorithm::split(wanted, names, boost::algorithm::is_any_of(","));
  std::vector<RegistrationMethod> chosen;
  for (const std::string& name : wanted) {
    bool known = false;
    for (const RegistrationMethod& method : registrationMethods()) {
      if (name != method.name) continue;
      chosen.push_back(method);
      known = true;
    }
    if (!known)
      throw UsageError("-methods = " + names + ", must be of symmetry, anew, frames, rotations, pca, features");
  }
  return chosen;
}

/// One scan brought to one model by one method.
struct Trial {
  std::string scan, model;
  std::size_t method = 0;  ///< index
  bool impostor = false;   ///< the model is not of the scan's object
  RegistrationAnswer answer;
  MotionError error;  ///< radians and diagonals; of impostors without meaning
  bool right = false;
};

/// Where the scan was brought to is left out: nothing asks for it later.
void put(detail::PackedBytes& bytes, const Trial& trial) {
  bytes.putText(trial.scan);
  bytes.putText(trial.model);
  bytes.put(trial.method);
  for (const bool is : {trial.impostor, trial.answer.converged, trial.right}) bytes.put(is);
  for (const double number : {trial.answer.support, trial.answer.conflict, trial.answer.milliseconds,
                              trial.answer.processor_ms, trial.error.angle, trial.error.distance})
    bytes.put(number);
}

void get(detail::UnpackedBytes& bytes, Trial& trial) {
  trial.scan = bytes.text();
  trial.model = bytes.text();
  trial.method = bytes.get<std::size_t>();
  for (bool* is : {&trial.impostor, &trial.answer.converged, &trial.right}) *is = bytes.get<bool>();
  for (double* number : {&trial.answer.support, &trial.answer.conflict, &trial.answer.milliseconds,
                         &trial.answer.processor_ms, &trial.error.angle, &trial.error.distance})
    *number = bytes.get<double>();
}

/// What the trials of one method add up to. Rates in [0, 1], NaN where there is nothing to count.
struct Summary {
  int num_scans = 0;
  double right_rate = 0.0;                           ///< whether the method says converged or not
  double converged_rate = 0.0;                       ///< says that it fits
  double trusted_rate = 0.0;                         ///< of those that say so, right
  double impostor_rate = 0.0;                        ///< impostors that are said to fit
  double median_angle = 0.0, median_distance = 0.0;  ///< of the right ones, degrees and diagonals
  double median_ms = 0.0, p95_ms = 0.0;
  double median_processor_ms = 0.0;  ///< of all threads
};

double share(int part, int whole) {
  return whole > 0 ? static_cast<double>(part) / whole : std::numeric_limits<double>::quiet_NaN();
}

Summary summarize(const std::vector<Trial>& trials, std::size_t method) {
  Summary summary;
  int num_right = 0, num_converged = 0, num_trusted = 0, num_impostors = 0, num_taken_in = 0;
  std::vector<double> angles, distances, times, processor_times;
  for (const Trial& trial : trials) {
    if (trial.method != method) continue;
    if (trial.impostor) {
      ++num_impostors;
      num_taken_in += trial.answer.converged ? 1 : 0;
      continue;
    }
    ++summary.num_scans;
    times.push_back(trial.answer.milliseconds);
    processor_times.push_back(trial.answer.processor_ms);
    num_converged += trial.answer.converged ? 1 : 0;
    if (!trial.right) continue;
    ++num_right;
    num_trusted += trial.answer.converged ? 1 : 0;
    angles.push_back(trial.error.angle / kDegree);
    distances.push_back(trial.error.distance);
  }
  summary.right_rate = share(num_right, summary.num_scans);
  summary.converged_rate = share(num_converged, summary.num_scans);
  summary.trusted_rate = share(num_trusted, num_converged);
  summary.impostor_rate = share(num_taken_in, num_impostors);
  summary.median_angle = quantile(angles, 0.5);
  summary.median_distance = quantile(distances, 0.5);
  summary.median_ms = quantile(times, 0.5);
  summary.p95_ms = quantile(times, 0.95);
  summary.median_processor_ms = quantile(processor_times, 0.5);
  return summary;
}

class RegistrationEvaluation {
public:
  RegistrationEvaluation(const EvaluateRegistrationOptions& options, ResumableRun& work)
      : options_(options),
        work_(work),
        console_(options.common.quiet || !work.isFirst()),
        methods_(chosenMethods(options.methods.value_or("symmetry,pca,features"))),
        cache_(options.references_path.value_or(""), ReferenceOptions()) {
    clouds_.num_points = options.num_points;
    clouds_.noise.clear();
    clouds_.scan_noise = {options.noise};
    clouds_.num_views = options.num_views;
    clouds_.seed = options.common.seed;
    references_.num_threads = options.common.threads;
  }

  void run() {
    models_ = listModels(options_.folders, options_.selection);
    shareReferences(models_, references_, cache_, work_, console_);
    Step step(console_, "Registering scans of " + std::to_string(models_.size()) + " models");
    std::vector<std::string> names;
    for (const Model& model : models_) names.push_back(model.key);
    trials_ = joinedRows(rowsOfItems<Trial>(
                             names, [&](std::size_t i) { return evaluate(i); }, work_, step),
                         left_out_);
    if (!work_.isFirst()) return;
    step.done(std::to_string(trials_.size()) + " trials");
    for (const std::string& reason : left_out_) console_.warn("left out: " + reason);
    if (trials_.empty()) throw InputError(options_.folders.front() + ": no mesh could be used");
    report();
  }

private:
  struct Target {
    std::string name;
    pcl::PolygonMesh::ConstPtr mesh;
    pcl::PointCloud<pcl::PointXYZ>::Ptr cloud;
    std::vector<RegisterToTarget> methods;
  };

  ItemRows<Trial> evaluate(std::size_t i) {
    ItemRows<Trial> item;
    try {
      addTrials(i, item.rows);
    } catch (const std::exception& error) {
      item.left_out = models_[i].path + ": " + error.what();
    }
    return item;
  }

  void addTrials(std::size_t i, std::vector<Trial>& trials) {
    const Model& model = models_[i];
    const std::shared_ptr<const Target> target = targetOf(i), other = options_.impostors ? targetBefore(i) : nullptr;
    const std::optional<ReferenceSymmetries> known = cache_.find(model.key, target->mesh->polygons.size());
    const ReferenceSymmetries references = known ? *known : findReferenceSymmetries(*target->mesh, references_);
    const TestCloudMaker maker(*target->mesh, model.key, clouds_);
    for (const CloudRecipe& recipe : recipesFor(clouds_)) {
      const TestCloud scan = maker.make(recipe);
      removePatches(*scan.cloud, options_.missing, kNumPatches,
                    options_.common.seed + static_cast<std::uint64_t>(recipe.view) + 1);
      const std::string name = model.name + "_" + recipe.name;
      tryAll(name, scan, *target, &references, trials);
      if (other) tryAll(name, scan, *other, nullptr, trials);
    }
  }

  /// The last two are kept: a process that does one model after the other makes each target once.
  std::shared_ptr<const Target> targetOf(std::size_t i) {
    if (const auto kept = targets_.find(i); kept != targets_.end()) return kept->second;
    const Shape shape = loadShape(models_[i].path);
    if (!shape.mesh) throw InputError("has no faces");
    Target target{models_[i].name,
                  pcl::make_shared<pcl::PolygonMesh>(*shape.mesh),
                  sampleMesh(*shape.mesh, options_.num_points, options_.common.seed + 1),
                  {}};
    for (const RegistrationMethod& method : methods_)
      target.methods.push_back(method.toTarget(target.cloud, options_.common.seed + 1, options_.common.threads));
    while (targets_.size() > 1) targets_.erase(targets_.begin());
    return targets_[i] = std::make_shared<const Target>(std::move(target));
  }

  /// \return null where no model before can be used.
  std::shared_ptr<const Target> targetBefore(std::size_t i) {
    while (i-- > 0) {
      try {
        return targetOf(i);
      } catch (const std::exception&) {  // its own item says so
      }
    }
    return nullptr;
  }

  /// The true pose, turned about the middle of the target and moved, both in random directions.
  PoseGuess guessFor(const std::string& name, const TestCloud& scan, const Target& target, double diagonal) const {
    // Half as much again as the guess is off: the search has to find where to stop. chosen: at 1 the truth lies on the
    // edge, at 2 the search takes longer.
    constexpr double kSearched = 1.5;
    RandomStream random(options_.common.seed + std::hash<std::string>{}(name));
    const auto direction = [&]() -> Eigen::Vector3d {
      const double z = 2.0 * random.uniform() - 1.0, phi = 2.0 * kPi * random.uniform(), r = std::sqrt(1.0 - z * z);
      return {r * std::cos(phi), r * std::sin(phi), z};
    };
    const double angle = *options_.around * kDegree, distance = options_.around_distance * diagonal;
    const Eigen::Vector3d middle = centerOfMass(target.cloud->getMatrixXfMap(3, 4, 0));
    const Eigen::Isometry3d off = Eigen::Translation3d(middle + distance * direction()) *
                                  Eigen::AngleAxisd(angle, direction()) * Eigen::Translation3d(-middle);
    // The center of the scan is at most a diagonal from the middle that the guess turns about.
    return {off * scan.T_cloud_model.inverse(), kSearched * angle,
            kSearched * distance + 2.0 * std::sin(0.5 * kSearched * angle) * diagonal};
  }

  /// \param references of the target; null where it is an impostor.
  void tryAll(const std::string& name, const TestCloud& scan, const Target& target,
              const ReferenceSymmetries* references, std::vector<Trial>& trials) {
    std::optional<PoseGuess> guess;
    if (options_.around && references) guess = guessFor(name, scan, target, references->diagonal);
    for (std::size_t k = 0; k < methods_.size(); ++k) {
      const auto run = [&] { return target.methods[k](scan.cloud, guess); };
      if (num_warm_ == k) {
        run();  // threads, tables and pages are there from the second call on
        ++num_warm_;
      }
      Trial trial{name, target.name, k, !references, run(), {}, false};
      if (references) {
        trial.error = motionError(trial.answer.T_target_source, scan.T_cloud_model.inverse(), *references);
        trial.right = trial.error.within(options_.max_angle * kDegree, options_.max_distance * references->diagonal);
        trial.error.distance /= references->diagonal;
      }
      trials.push_back(trial);
    }
  }

  void report() const {
    std::printf("%-10s %6s %8s %10s %8s %10s %8s %9s %9s %9s %9s\n", "method", "scans", "right %", "converged",
                "of these", "impostors", "deg", "diagonal", "median ms", "95 % ms", "processor");
    nlohmann::json methods = nlohmann::json::object();
    for (std::size_t k = 0; k < methods_.size(); ++k) {
      const Summary s = summarize(trials_, k);
      std::printf("%-10s %6d %8.1f %10.1f %8.1f %10.1f %8.2f %9.4f %9.0f %9.0f %9.0f\n", methods_[k].name, s.num_scans,
                  100.0 * s.right_rate, 100.0 * s.converged_rate, 100.0 * s.trusted_rate, 100.0 * s.impostor_rate,
                  s.median_angle, s.median_distance, s.median_ms, s.p95_ms, s.median_processor_ms);
      methods[methods_[k].name] = {{"scans", s.num_scans},
                                   {"right_rate", s.right_rate},
                                   {"converged_rate", s.converged_rate},
                                   {"right_rate_of_converged", s.trusted_rate},
                                   {"impostor_rate", s.impostor_rate},
                                   {"median_angle_deg", s.median_angle},
                                   {"median_distance", s.median_distance},
                                   {"median_ms", s.median_ms},
                                   {"p95_ms", s.p95_ms},
                                   {"median_processor_ms", s.median_processor_ms}};
    }
    if (options_.csv) writeText(*options_.csv, csv());
    if (!options_.common.json_path) return;
    const nlohmann::json summary{
        {"noise", options_.noise},
        {"missing", options_.missing},
        {"seed", options_.common.seed},
        {"limits", {{"max_angle_deg", options_.max_angle}, {"max_distance", options_.max_distance}}},
        {"left_out", left_out_},
        {"methods", methods}};
    writeText(*options_.common.json_path, summary.dump(2) + "\n");
  }

  std::string csv() const {
    std::ostringstream text;
    text << "scan,model,impostor,method,right,converged,angle_deg,distance,support,conflict,milliseconds\n";
    for (const Trial& trial : trials_) {
      text << trial.scan << ',' << trial.model << ',' << trial.impostor << ',' << methods_[trial.method].name << ','
           << trial.right << ',' << trial.answer.converged << ',' << trial.error.angle / kDegree << ','
           << trial.error.distance << ',' << trial.answer.support << ',' << trial.answer.conflict << ','
           << trial.answer.milliseconds << '\n';
    }
    return text.str();
  }

  const EvaluateRegistrationOptions& options_;
  ResumableRun& work_;
  const Console console_;
  const std::vector<RegistrationMethod> methods_;
  TestCloudOptions clouds_;
  ReferenceOptions references_;
  ReferenceCache cache_;
  std::vector<Model> models_;
  std::map<std::size_t, std::shared_ptr<const Target>> targets_;  // by index of the model
  std::size_t num_warm_ = 0;                                      // methods that were called before
  std::vector<std::string> left_out_;
  std::vector<Trial> trials_;
};

}  // namespace

int evaluateRegistration(int argc, char** argv, SharedWork& processes) {
  EvaluateRegistrationOptions options;
  if (!commandLine(options).parse(argc, argv)) return 0;
  ResumableRun work(processes, options.journal, argc, argv);
  options.common.threads = work.threadsOfItem(options.common.threads);
  // Classes that find nothing say so once a scan; the table counts them.
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  RegistrationEvaluation(options, work).run();
  return 0;
}

}  // namespace pcl_symmetry::apps
