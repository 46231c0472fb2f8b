/// The objects of one frame of a sensor and their symmetries: a table, JSON, the completed scene, a picture, a page; or
/// of each frame that arrives in a folder.
#include <poll.h>
#include <sys/inotify.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <boost/filesystem/path.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <deque>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "command_line/command_line.h"
#include "command_line/console.h"
#include "command_line/tool_errors.h"
#include "io/answers.h"
#include "io/exact_coordinates.h"
#include "io/file_text.h"
#include "io/input_shape.h"
#include "io/shape_output.h"
#include "pcl_symmetry/symmetry_scene.h"
#include "pictures/scene_page.h"
#include "scene/scene_report.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

struct SceneToolOptions {
  std::optional<std::string> input, output, database_path, png_path, html_path, watched;
  bool no_frames = false, no_completion = false, no_separation = false;
  std::optional<Eigen::Vector4d> ground;
  SceneOptions scene;
  CommonOptions common;
};

CommandLine commandLine(SceneToolOptions& o) {
  CommandLine line("pcl_symmetry_scene",
                   "Finds the objects of one frame of a depth camera or scanner, and their symmetries.",
                   "pcl_symmetry_scene table.pcd completed.pcd -json objects.json -png objects.png");
  line.positional("input", o.input, ".pcd or .ply: organized, or with the viewpoint of the sensor; not with -watch")
      .positional(
          "output", o.output,
          "completed scene, .pcd or .ply, with the fields object (-1 = supporting plane, 0 = none) and completed")
      .text("database", "FILE", o.database_path, "names objects by the models of this file of pcl_symmetry_database")
      .picture("png", o.png_path, "picture: the scene, and each object with what its symmetry adds")
      .text("html", "FILE", o.html_path, "page that shows the scene, its objects, planes and axes in any browser")
      .text("watch", "FOLDER", o.watched,
            "handles each .pcd or .ply that is written to this folder or moved there, one line of JSON each, until "
            "interrupted")
      .plane("ground", o.ground,
             "what the objects stand on, a x + b y + c z + d = 0, in place of supporting planes that are searched for")
      .number("max_range", o.scene.max_range, Range::atLeast(0),
              "points farther from the sensor are left out, input units; 0 = none is")
      .number("plane_distance", o.scene.plane_distance, Range::atLeast(0),
              "distance of points that belong to a supporting plane, input units; 0 = from the points")
      .number("cluster_distance", o.scene.cluster_distance, Range::atLeast(0),
              "distance between points of one object, input units; 0 = from the points")
      .number("min_points", o.scene.min_points, Range::closed(20, 1'000'000'000), "least number of points of an object")
      .number("max_points", o.scene.max_points, Range::closed(100, 1'000'000'000),
              "points of an object that are analyzed")
      .number("accept", o.scene.recognition.min_confidence, Range::closed(0, 1),
              "with -database: least confidence of a name that is accepted")
      .number("min_confidence", o.scene.detection.min_confidence, Range::closed(0, 1),
              "least probability of a plane that is called a symmetry")
      .flag("no_separation", o.no_separation, "leaves objects that touch together")
      .flag("no_frames", o.no_frames, "leaves the frames of the objects out")
      .flag("no_completion", o.no_completion, "leaves the completion of the objects out")
      .common(o.common, kAnalysisFlags);
  return line;
}

/// Names files of a folder as soon as they are whole: when a program that wrote one closes it, or when one is moved
/// into the folder, also in place of another. Files that are there before are not named. SIGINT, SIGTERM and SIGHUP end
/// the watch, not the program: what a user, a service manager and a closed terminal end a program by.
class FolderWatch {
public:
  /// \throws InputError naming the folder where it cannot be watched.
  explicit FolderWatch(const std::string& folder) : folder_(folder) {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, signal);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);  // also of threads that are made later
    signals_.fd = signalfd(-1, &signals, SFD_CLOEXEC);
    events_.fd = inotify_init1(IN_CLOEXEC);
    const std::uint32_t events = IN_CLOSE_WRITE | IN_MOVED_TO | IN_DELETE_SELF | IN_MOVE_SELF | IN_ONLYDIR;
    if (inotify_add_watch(events_.fd, folder.c_str(), events) < 0)
      throw InputError(folder + ": cannot be watched, " + std::strerror(errno));
  }

  /// Waits for the next file. A file that was written again before it is named is named once.
  /// \return its path; nothing once a signal has come.
  /// \throws InputError where the folder is gone.
  std::optional<std::string> next() {
    for (;;) {
      pollfd asked[] = {signals_, events_};
      poll(asked, 2, waiting_.empty() ? -1 : 0);
      if (asked[0].revents != 0) return std::nullopt;
      if (asked[1].revents != 0) readEvents();
      if (waiting_.empty()) continue;
      std::string path = (boost::filesystem::path(folder_) / waiting_.front()).string();
      waiting_.pop_front();
      return path;
    }
  }

  /// \return whether files came faster than the system keeps their names, since the last call: some were missed.
  bool hasMissed() { return std::exchange(missed_, false); }

private:
  void readEvents() {
    alignas(inotify_event) char buffer[1u << 16];
    const ssize_t size = read(events_.fd, buffer, sizeof(buffer));
    for (ssize_t at = 0; at < size;) {
      const auto* event = reinterpret_cast<const inotify_event*>(buffer + at);
      at += static_cast<ssize_t>(sizeof(inotify_event) + event->len);
      if (event->mask & IN_Q_OVERFLOW) missed_ = true;
      if (event->mask & (IN_DELETE_SELF | IN_MOVE_SELF | IN_UNMOUNT)) throw InputError(folder_ + ": is gone");
      if (event->len == 0 || (event->mask & IN_ISDIR)) continue;
      const std::string name = event->name;
      if (std::find(waiting_.begin(), waiting_.end(), name) == waiting_.end()) waiting_.push_back(name);
    }
  }

  std::string folder_;
  pollfd signals_{-1, POLLIN, 0}, events_{-1, POLLIN, 0};
  std::deque<std::string> waiting_;
  bool missed_ = false;
};

SymmetryScene makeScene(const SceneToolOptions& options) {
  SymmetryScene scene;
  SceneOptions used = options.scene;
  options.common.applyTo(used.detection);
  options.common.applyTo(used.frame);
  used.num_threads = used.completion.num_threads = used.recognition.num_threads = options.common.threads;
  used.frames = !options.no_frames;
  used.complete = !options.no_completion;
  used.separate = !options.no_separation;
  scene.setOptions(used);
  if (options.database_path) {
    checkReadableFile(*options.database_path);
    DatabaseOptions database;
    database.num_threads = options.common.threads;
    scene.setDatabase(namingFile(*options.database_path, [&] {
      return std::make_shared<const SymmetryDatabase>(*options.database_path, database);
    }));
  }
  return scene;
}

InputShape loadFrame(const Console& console, const std::string& path, const CommonOptions& common) {
  InputShape input = loadInput(console, path, common);
  if (input.shape.mesh) throw InputError(path + ": is a mesh, must be a cloud as a sensor sees it");
  return input;
}

SceneAnalysis analyze(const Console& console, SymmetryScene& scene, const InputShape& input,
                      const SceneToolOptions& options) {
  scene.setViewpoint(shifted(options.common.viewpoint, input.shift()));
  if (options.ground) scene.setGround(shifted(*options.ground, input.shift()));
  scene.setInputCloud(input.points);
  Step searching(console, "Searching objects");
  SceneAnalysis found;
  namingFile(input.path, [&] { found = scene.compute(); });
  if (found.timing_ms.empty()) throw InputError(input.path + ": input cloud: no finite point");
  const double total = searching.done(counted(found.objects.size(), "object"));
  found.timing_ms.emplace_back("load", input.loading_ms);
  found.timing_ms.emplace_back("total", total);
  return found;
}

/// Whether a file of the watched folder is meant: hidden files are those that programs write before they move them.
bool isFrame(const std::string& path) {
  const boost::filesystem::path file(path);
  const std::string extension = boost::algorithm::to_lower_copy(file.extension().string());
  return file.filename().string().front() != '.' && (extension == ".pcd" || extension == ".ply");
}

/// Handles files as they arrive. A file that cannot be handled has a line with "error".
int watch(const SceneToolOptions& options) {
  const Console console(options.common.quiet);
  FolderWatch folder(*options.watched);  // before there are other threads
  SymmetryScene scene = makeScene(options);
  console.info("Watching " + *options.watched);
  while (const std::optional<std::string> path = folder.next()) {
    if (folder.hasMissed()) console.error(*options.watched + ": files came too fast, some were missed");
    if (!isFrame(*path)) continue;
    nlohmann::json line;
    try {
      namingFile(*path, [&] {
        const InputShape input = loadFrame(console, *path, options.common);
        line = describeScene(input, analyze(console, scene, input, options));
      });
    } catch (const InputError& error) {
      line = {{"file", *path}, {"error", error.what()}};
      console.error(error.what());
    }
    std::puts(line.dump().c_str());
    if (std::fflush(stdout) != 0) throw InputError("standard output: cannot be written");
  }
  return 0;
}

void checkUse(const SceneToolOptions& o) {
  if (o.watched && (o.input || o.png_path || o.html_path || o.common.json_path))
    throw UsageError(
        "-watch writes lines of JSON to standard output, and goes without input, output, -json, -png, -html");
  if (!o.watched && !o.input) throw UsageError("missing argument 'input'");
  if (o.output) checkCloudExtension(*o.output);
}

int run(int argc, char** argv) {
  SceneToolOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  checkUse(options);
  if (options.watched) return watch(options);
  const Console console(options.common.quiet);
  const InputShape input = loadFrame(console, *options.input, options.common);
  SymmetryScene searched = makeScene(options);
  const SceneAnalysis scene = analyze(console, searched, input, options);
  const std::string table = tableOf(scene, input.shift());
  std::fputs(table.c_str(), stdout);
  if (options.common.json_path) writeText(*options.common.json_path, jsonText(describeScene(input, scene)) + "\n");
  if (options.output)
    saveCloud(*options.output, completedScene(input, scene), input.shape.sensor_origin, input.shape.sensor_orientation);
  if (options.png_path) {
    Step drawing(console, "Drawing " + *options.png_path);
    drawScene(input, scene, *options.png_path);
    drawing.done();
  }
  if (options.html_path)
    writePage(selectableObjects(input, scene), {*options.input, table, cameraPicture(input)}, *options.html_path);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
