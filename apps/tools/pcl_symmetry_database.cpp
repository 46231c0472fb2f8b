/// Builds and maintains a database of models, which pcl_symmetry_match queries.
#include <pcl/conversions.h>

#include <algorithm>
#include <boost/algorithm/string/join.hpp>
#include <boost/crc.hpp>
#include <boost/filesystem.hpp>
#include <ctime>
#include <fstream>
#include <map>

#include "command_line/run_on_files.h"
#include "io/answers.h"
#include "io/file_text.h"
#include "io/input_shape.h"
#include "io/shape_output.h"
#include "pcl_symmetry/symmetry_database.h"

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
};

CommandLine commandLine(DatabaseToolOptions& options) {
  CommandLine line(
      "pcl_symmetry_database",
      "Keeps models in a file, to be found by their symmetry.\n\n"
      "build, add DATABASE FILE ...: files, folders, patterns, @LISTS; an interrupted run goes on, as stored files "
      "that did not change are kept\n"
      "remove DATABASE NAME ...\n"
      "list DATABASE\n"
      "info DATABASE [NAME ...]\n"
      "check DATABASE: is anything damaged?\n"
      "export DATABASE FOLDER [NAME ...]: the clouds as PCD files\n"
      "merge DATABASE OTHER ...: takes over the models of other databases, or @LISTS of them; names must differ\n"
      "rebuild DATABASE: fits the compact forms anew, after many changes",
      "pcl_symmetry_database build models.db meshes/*.off");
  line.positional("command", options.command, "build, add, remove, list, info, check, export, merge or rebuild")
      .positionals("database", options.arguments, "the database, and what the command takes behind it")
      .choice("names", options.names, {"file", "path"},
              "models of folders are named by the file without its ending, or by its path in the folder")
      .text("tag", "WORD", options.tag, "stored with the models of build and add, such as their class")
      .text("unit", "WORD", options.unit,
            "unit of the coordinates, such as m: stored with a new database, refused where the database has another")
      .flag("part", options.is_part, "build and add: fit nothing to the models, as merge fits the whole")
      .text("csv", "FILE", options.csv, "list and info: a row for each model")
      .common(options.common, kMeshPoints | kJson | kThreads | kQuiet);
  return line;
}

/// \return 16 hexadecimal digits, the CRC-64 of the bytes of a file.
/// \throws InputError if it cannot be read.
std::string fileChecksum(const std::string& path) {
  // CRC-64/XZ of ECMA-182.
  boost::crc_optimal<64, 0x42F0E1EBA9EA3693, 0xFFFFFFFFFFFFFFFF, 0xFFFFFFFFFFFFFFFF, true, true> checksum;
  std::array<char, 1 << 16> piece;  // bytes read at once
  checkReadableFile(path);
  std::ifstream file(path, std::ios::binary);
  while (file.read(piece.data(), piece.size()) || file.gcount() > 0)
    checksum.process_bytes(piece.data(), static_cast<std::size_t>(file.gcount()));
  if (!file.eof()) throw InputError(path + ": cannot be read");
  return formatted("%016llx", static_cast<unsigned long long>(checksum.checksum()));
}

/// \return the name of a file without its extension, or its path within the given folder, with "_" for "/".
std::string modelName(const InputFile& file, bool by_path) {
  const fs::path path = file.path;
  if (!by_path || file.folder.empty()) return path.stem().string();
  std::string name = fs::relative(path, file.folder).replace_extension().string();
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

/// A missing file is included, to be reported with those that cannot be used.
std::vector<ModelInput> modelInputs(const DatabaseToolOptions& options) {
  std::vector<std::string> tags;
  if (options.tag) tags.push_back(*options.tag);
  const std::vector<InputFile> files = inputFiles(options.arguments);
  std::vector<ModelInput> inputs;
  for (std::size_t i = 0; i < files.size(); ++i) {
    // The number of points is part of the checksum: another number gives another model.
    const auto source = [path = files[i].path, num_points = options.common.mesh_points, tags] {
      return ModelSource{fs::absolute(path).lexically_normal().string(),
                         fileChecksum(path) + "-" + std::to_string(num_points), tags};
    };
    const auto load = [path = files[i].path, &common = options.common] {
      const InputShape input = loadInput(path, common.mesh_points, common.seed);
      // Poses of recognition are in the frame of the model's file; a shift would be lost.
      if (!input.shift().isZero(0.0))
        throw InputError(path + ": its coordinates are too large for its extent, must be moved near the origin");
      return *input.points;
    };
    inputs.push_back({modelName(files[i], options.names == "path"), source, load});
  }
  return inputs;
}

/// Seconds since 1970 as "2025-01-31T12:00:00Z".
std::string timeText(std::int64_t time) {
  const auto seconds = static_cast<std::time_t>(time);
  std::tm parts{};
  ::gmtime_r(&seconds, &parts);
  char text[32];
  std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

nlohmann::json jsonOf(const ModelInfo& model) {
  return {{"name", model.name},          {"points", model.num_points},        {"time", timeText(model.time)},
          {"source", model.source.path}, {"checksum", model.source.checksum}, {"tags", model.source.tags}};
}

class DatabaseTool {
public:
  explicit DatabaseTool(const DatabaseToolOptions& options) : options_(options), console_(options.common.quiet) {}

  /// \return the exit code.
  int run() {
    DatabaseOptions database_options;
    database_options.num_threads = options_.common.threads;
    database_options.unit = options_.unit.value_or("");
    database_options.is_part = options_.is_part;
    const bool makes_file = isBuild() || options_.command == "merge";
    if (!makes_file) checkReadableFile(options_.file);
    if (options_.command == "check") return check();
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

  int build(SymmetryDatabase& database) const {
    const std::vector<ModelInput> inputs = modelInputs(options_);
    Step step(console_, "Describing " + counted(inputs.size(), "model"));
    const BuildReport report = database.build(inputs, [&](double share) { return step.progress(share), true; });
    step.done(counted(static_cast<std::size_t>(report.num_added), "model") +
              (report.num_kept > 0 ? ", " + std::to_string(report.num_kept) + " kept" : ""));
    return finish(report, {{"kept", report.num_kept}});
  }

  int merge(SymmetryDatabase& database) const {
    for (const std::string& argument : options_.arguments)
      if (fs::is_directory(argument) || !standsForSeveral(argument)) checkReadableFile(argument);
    std::vector<std::string> files;
    for (const InputFile& file : inputFiles(options_.arguments)) files.push_back(file.path);
    Step step(console_, "Merging " + counted(files.size(), "database"));
    BuildReport report;
    report.num_added = database.merge(files, [&](double share) { return step.progress(share), true; });
    step.done(counted(static_cast<std::size_t>(report.num_added), "model"));
    return finish(report, nlohmann::json::object());
  }

  int finish(const BuildReport& report, nlohmann::json json) const {
    json["added"] = report.num_added;
    json["failures"] = nlohmann::json::array();
    for (const auto& [name, reason] : report.failures) {
      const bool is_named = reason.rfind("name = ", 0) == 0 || reason.find(name) != std::string::npos;
      console_.error("left out: " + (is_named ? reason : name + ": " + reason));
      json["failures"].push_back({{"name", name}, {"reason", reason}});
    }
    writeJson(options_.common, json);
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
    const bool prints = isStandardOutputFree({options_.csv, options_.common.json_path});
    nlohmann::json json{{"models", nlohmann::json::array()}};
    std::string table = "name,points,time,source,checksum,tags\n";
    for (const std::string& name : all ? database.names() : options_.arguments) {
      const ModelInfo model = database.info(name);
      const std::string time = timeText(model.time), tags = boost::algorithm::join(model.source.tags, " ");
      json["models"].push_back(jsonOf(model));
      table += csvLine({name, model.num_points, time, model.source.path, model.source.checksum, tags});
      if (prints && options_.command == "list") std::printf("%s\n", name.c_str());
      if (prints && !all)
        std::printf("%s\n  points    %zu\n  stored    %s\n  source    %s\n  checksum  %s\n  tags      %s\n",
                    name.c_str(), static_cast<std::size_t>(model.num_points), time.c_str(), model.source.path.c_str(),
                    model.source.checksum.c_str(), tags.c_str());
    }
    if (all && options_.command == "info") {
      const std::uintmax_t bytes = fs::file_size(options_.file);
      json = {
          {"database", options_.file}, {"num_models", database.size()}, {"unit", database.unit()}, {"bytes", bytes}};
      if (prints)
        std::printf("models  %zu\nunit    %s\nbytes   %ju\n", database.size(),
                    database.unit().empty() ? "not given" : database.unit().c_str(), bytes);
    }
    if (options_.csv) writeText(*options_.csv, table);
    writeJson(options_.common, json);
    return 0;
  }

  int check() const {
    std::vector<std::string> damages;
    {
      Step step(console_, "Checking " + options_.file);
      damages = SymmetryDatabase::check(options_.file);
      step.done(damages.empty() ? "no damage" : counted(damages.size(), "damage"));
    }
    writeJson(options_.common, {{"damages", damages}});
    if (!damages.empty()) throw InputError(options_.file + ": " + boost::algorithm::join(damages, "; "));
    return 0;
  }

  /// Writes clouds to files; existing files are not replaced.
  int exportClouds(const SymmetryDatabase& database) const {
    const fs::path folder = options_.arguments.front();
    std::vector<std::string> names(options_.arguments.begin() + 1, options_.arguments.end());
    if (names.empty()) names = database.names();
    makeFolder(folder.string());
    Step step(console_, "Writing " + counted(names.size(), "cloud"));
    std::vector<std::string> failures;
    for (const std::string& name : names) {
      const std::string path = (folder / (name + ".pcd")).string();
      try {
        if (fs::exists(path)) throw InputError(path + ": exists, is not replaced");
        pcl::PCLPointCloud2 cloud;
        pcl::toPCLPointCloud2(database.cloud(name), cloud);
        saveCloud(path, cloud);
      } catch (const pcl::PCLException& reason) {
        failures.push_back(plainMessage(reason));
      } catch (const InputError& reason) {
        failures.emplace_back(reason.what());
      }
    }
    step.done(counted(names.size() - failures.size(), "cloud"));
    for (const std::string& failure : failures) console_.error("left out: " + failure);
    return failures.empty() ? 0 : 1;
  }

  const DatabaseToolOptions& options_;
  const Console console_;
};

int run(int argc, char** argv) {
  DatabaseToolOptions options;
  options.common.mesh_points = kDatabaseMeshPoints;
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
  const bool builds = options.command == "build" || options.command == "add";
  line.goWith("build and add", builds, {"tag", "names", "part", "points"});
  line.goWith("build, add and merge", builds || options.command == "merge", {"unit"});
  line.goWith("all commands but remove, export and rebuild",
              options.command != "remove" && options.command != "export" && options.command != "rebuild", {"json"});
  line.goWith("list and info", options.command == "list" || options.command == "info", {"csv"});
  return DatabaseTool(options).run();
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
