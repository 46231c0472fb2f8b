/// Builds and keeps a database of models that pcl_symmetry_match asks.
#include <pcl/conversions.h>

#include <boost/filesystem.hpp>
#include <cstdio>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "command_line/command_line.h"
#include "command_line/console.h"
#include "command_line/file_errors.h"
#include "command_line/input_files.h"
#include "command_line/run_tool.h"
#include "io/json_values.h"
#include "io/shape_output.h"
#include "tools/database_listing.h"
#include "tools/model_files.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;
namespace fs = boost::filesystem;

struct DatabaseToolOptions {
  std::string command, file, names = "file";
  std::vector<std::string> arguments;
  std::optional<std::string> csv, tag, unit;
  bool is_part = false;
  CommonOptions common;

  DatabaseToolOptions() { common.mesh_points = kDatabaseMeshPoints; }
};

/// "1 model", "2 models".
std::string counted(std::size_t number, const std::string& what) {
  return std::to_string(number) + " " + what + (number == 1 ? "" : "s");
}

CommandLine commandLine(DatabaseToolOptions& options) {
  CommandLine line(
      "pcl_symmetry_database",
      "Keeps models in a file to be found by their symmetry. Commands: build or add (files, folders, patterns, @LISTS; "
      "goes on where it was interrupted: files that are stored and unchanged are kept), remove (names), list, info "
      "(names, or none), check (is anything damaged?), export (a folder, and names or none: clouds as PCD files), "
      "merge (other databases, or @LISTS of them; names of models must differ), rebuild (after many changes).",
      "pcl_symmetry_database build models.db meshes/*.off");
  line.positional("command", options.command, "build, add, remove, list, info, check, export, merge or rebuild")
      .positionals("database", options.arguments, "the database, and what the command takes behind it")
      .choice("names", options.names, {"file", "path"},
              "models of folders are named by the file without its ending, or by its path in the folder")
      .text("tag", "WORD", options.tag, "stored with the models of build and add, such as their class")
      .text("unit", "WORD", options.unit, "unit of the coordinates, such as m; stored with a new database")
      .flag("part", options.is_part, "build and add: fit nothing to the models, as merge fits the whole")
      .text("csv", "FILE", options.csv, "list and info: a row for each model")
      .common(options.common, kMeshPoints | kJson | kThreads | kQuiet);
  return line;
}

class DatabaseTool {
public:
  explicit DatabaseTool(const DatabaseToolOptions& options) : options_(options), console_(options.common.quiet) {}

  /// \return the exit code.
  int run() {
    if (options_.command == "check") return check();
    DatabaseOptions database_options;
    database_options.num_threads = options_.common.threads;
    database_options.unit = options_.unit.value_or("");
    database_options.is_part = options_.is_part;
    const bool makes_file = isBuild() || options_.command == "merge";
    if (!makes_file && !fs::exists(options_.file)) throw InputError(options_.file + ": there is no such file");
    SymmetryDatabase database(options_.file, database_options);
    if (isBuild()) return build(database);
    if (options_.command == "merge") return merge(database);
    if (options_.command == "export") return exportClouds(database);
    if (options_.command == "list" || options_.command == "info") return show(database);
    change(database);
    return 0;
  }

private:
  bool isBuild() const { return options_.command == "build" || options_.command == "add"; }

  void printFailures(const BuildReport& report) const {
    for (const auto& [name, reason] : report.failures)
      console_.error("left out: " + (reason.rfind("name = ", 0) == 0 || reason.find(name) != std::string::npos
                                         ? reason
                                         : name + ": " + reason));
  }

  int build(SymmetryDatabase& database) const {
    const std::vector<ModelFile> files = modelFiles(options_.arguments, options_.names == "path");
    std::vector<std::string> tags;
    if (options_.tag) tags.push_back(*options_.tag);
    Step step(console_, "Describing " + counted(files.size(), "model"));
    const std::vector<ModelInput> inputs =
        modelInputs(files, options_.common.mesh_points, options_.common.librarySeed(), tags);
    const BuildReport report = database.build(inputs, [&](double share) { return step.progress(share), true; });
    step.done(counted(static_cast<std::size_t>(report.num_added), "model") +
              (report.num_kept > 0 ? ", " + std::to_string(report.num_kept) + " kept" : ""));
    return finish(report, {{"kept", report.num_kept}});
  }

  int merge(SymmetryDatabase& database) const {
    const InputFiles inputs = inputFiles(options_.arguments);
    std::vector<std::string> files;
    for (std::size_t i = 0; i < inputs.size(); ++i) files.push_back(inputs.path(i));
    Step step(console_, "Merging " + counted(files.size(), "database"));
    BuildReport report;
    report.num_added = database.merge(files, [&](double share) { return step.progress(share), true; });
    step.done(counted(static_cast<std::size_t>(report.num_added), "model"));
    return finish(report, nlohmann::json::object());
  }

  int finish(const BuildReport& report, nlohmann::json json) const {
    printFailures(report);
    json["added"] = report.num_added;
    json["failures"] = nlohmann::json::array();
    for (const auto& [name, reason] : report.failures) json["failures"].push_back({{"name", name}, {"reason", reason}});
    writeJson(json);
    return report.failures.empty() ? 0 : 1;
  }

  void change(SymmetryDatabase& database) const {
    Step step(console_, "Changing " + options_.file);
    if (options_.command == "remove")
      for (const std::string& name : options_.arguments) database.remove(name);
    else
      database.rebuild();
    step.done(counted(database.size(), "model"));
  }

  int show(const SymmetryDatabase& database) const {
    const bool all = options_.command == "list" || options_.arguments.empty();
    const std::vector<ModelInfo> models = infosOf(database, all ? database.names() : options_.arguments);
    nlohmann::json json{{"models", modelsJson(models)}};
    if (options_.command == "list") {
      for (const ModelInfo& model : models) std::printf("%s\n", model.name.c_str());
    } else if (all) {
      json = {{"database", options_.file},
              {"num_models", database.size()},
              {"unit", database.unit()},
              {"bytes", fs::file_size(options_.file)}};
      std::printf("models  %zu\nunit    %s\nbytes   %ju\n", database.size(),
                  database.unit().empty() ? "not given" : database.unit().c_str(),
                  static_cast<std::uintmax_t>(fs::file_size(options_.file)));
    } else {
      for (const ModelInfo& model : models) std::printf("%s", modelText(model).c_str());
    }
    if (options_.csv) writeText(*options_.csv, modelsCSV(models));
    writeJson(json);
    return 0;
  }

  int check() const {
    std::vector<std::string> damages;
    {
      Step step(console_, "Checking " + options_.file);
      damages = SymmetryDatabase::check(options_.file);
      step.done(damages.empty() ? "no damage" : std::to_string(damages.size()) + " damages");
    }
    for (const std::string& damage : damages) std::printf("%s\n", damage.c_str());
    writeJson({{"damages", damages}});
    return damages.empty() ? 0 : 1;
  }

  /// Files that are there are not replaced.
  int exportClouds(const SymmetryDatabase& database) const {
    const fs::path folder = options_.arguments.front();
    std::vector<std::string> names(options_.arguments.begin() + 1, options_.arguments.end());
    if (names.empty()) names = database.names();
    makeFolder(folder.string());
    Step step(console_, "Writing " + std::to_string(names.size()) + " clouds");
    std::vector<std::string> failures;
    for (const std::string& name : names) {
      const std::string path = (folder / (name + ".pcd")).string();
      try {
        if (fs::exists(path)) throw InputError(path + ": exists, is not replaced");
        pcl::PCLPointCloud2 cloud;
        pcl::toPCLPointCloud2(database.cloud(name), cloud);
        saveCloud(path, cloud, Eigen::Vector4f::Zero(), Eigen::Quaternionf::Identity());
      } catch (const pcl::PCLException& reason) {
        failures.push_back(plainMessage(reason));
      } catch (const InputError& reason) {
        failures.emplace_back(reason.what());
      }
    }
    step.done(std::to_string(names.size() - failures.size()) + " clouds");
    for (const std::string& failure : failures) console_.error("left out: " + failure);
    return failures.empty() ? 0 : 1;
  }

  void writeJson(const nlohmann::json& json) const {
    if (options_.common.json_path) writeText(*options_.common.json_path, jsonText(json) + "\n");
  }

  const DatabaseToolOptions& options_;
  const Console console_;
};

int run(int argc, char** argv) {
  DatabaseToolOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  options.file = options.arguments.front();
  options.arguments.erase(options.arguments.begin());
  enum Takes { Nothing, Something, Anything };
  const std::map<std::string, Takes> commands{{"build", Something},  {"add", Something},   {"remove", Something},
                                              {"export", Something}, {"merge", Something}, {"rebuild", Nothing},
                                              {"check", Nothing},    {"list", Nothing},    {"info", Anything}};
  const auto command = commands.find(options.command);
  if (command == commands.end())
    throw UsageError("command = " + options.command +
                     ", must be build, add, remove, list, info, check, export, merge or rebuild");
  if (command->second == Something && options.arguments.empty())
    throw UsageError("missing argument behind the database");
  if (command->second == Nothing && !options.arguments.empty())
    throw UsageError("too many arguments behind the database");
  return DatabaseTool(options).run();
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
