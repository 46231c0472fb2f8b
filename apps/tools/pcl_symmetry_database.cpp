/// Builds and keeps a database of models that pcl_symmetry_match asks.
#include <boost/filesystem.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "common/command_line/command_line.h"
#include "common/command_line/console.h"
#include "common/command_line/file_errors.h"
#include "common/command_line/run_tool.h"
#include "common/shape_input/input_shape.h"
#include "pcl_symmetry/recognition/symmetry_database.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

struct DatabaseToolOptions {
  std::string command, folder;
  std::vector<std::string> arguments;
  CommonOptions common;

  DatabaseToolOptions() { common.mesh_points = kDatabaseMeshPoints; }
};

CommandLine commandLine(DatabaseToolOptions& options) {
  CommandLine line(
      "pcl_symmetry_database",
      "Keeps models in a folder to be found by their symmetry. Commands: build (a new database of files), "
      "add (files, named as they are without extension; models of the names are replaced), remove (names), "
      "rebuild (after many changes), list.",
      "pcl_symmetry_database build models.db meshes/*.off");
  line.positional("command", options.command, "build, add, remove, rebuild or list")
      .positionals("folder", options.arguments, "the database, and files or names behind it")
      .common(options.common, kMeshPoints | kThreads | kQuiet);
  return line;
}

/// \return whether all files could be used; the others are in the database.
bool add(const Console& console, SymmetryDatabase& database, const DatabaseToolOptions& options) {
  Step step(console, "Describing " + std::to_string(options.arguments.size()) + " models");
  std::vector<std::string> failures;
  for (std::size_t i = 0; i < options.arguments.size(); ++i) {
    const std::string& path = options.arguments[i];
    try {
      const InputShape input = loadInput(path, options.common.mesh_points, options.common.librarySeed());
      // Poses of recognition are those of the model's file; a shift would be lost.
      if (!input.shift().isZero(0.0))
        throw InputError(path + ": its coordinates are too large for its extent, must be moved near the origin");
      namingFile(path, [&] { database.add(boost::filesystem::path(path).stem().string(), *input.points); });
    } catch (const InputError& error) {
      failures.emplace_back(error.what());
    }
    step.progress(static_cast<double>(i + 1) / static_cast<double>(options.arguments.size()));
  }
  step.done(std::to_string(options.arguments.size() - failures.size()) + " models");
  for (const std::string& failure : failures) console.error("left out: " + failure);
  if (failures.size() == options.arguments.size()) throw InputError(options.folder + ": no model could be used");
  return failures.empty();
}

/// \return whether all that was asked for could be done.
bool change(const Console& console, SymmetryDatabase& database, const DatabaseToolOptions& options) {
  if (options.command == "build" && database.size() > 0)
    throw InputError(options.folder + ": holds models already, must be new for build");
  bool complete = true;
  if (options.command == "remove")
    for (const std::string& name : options.arguments) database.remove(name);
  else if (options.command != "rebuild")
    complete = add(console, database, options);
  Step step(console, "Saving " + options.folder);
  if (options.command == "rebuild") database.rebuild();
  database.save();
  step.done(std::to_string(database.size()) + " models");
  return complete;
}

int run(int argc, char** argv) {
  DatabaseToolOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  options.folder = options.arguments.front();
  options.arguments.erase(options.arguments.begin());
  const bool takes_arguments = options.command == "build" || options.command == "add" || options.command == "remove";
  if (!takes_arguments && options.command != "list" && options.command != "rebuild")
    throw UsageError("command = " + options.command + ", must be build, add, remove, rebuild or list");
  if (takes_arguments == options.arguments.empty())
    throw UsageError(takes_arguments ? "missing argument behind the folder" : "too many arguments behind the folder");
  const Console console(options.common.quiet);
  const bool makes_folder = options.command == "build" || options.command == "add";
  if (!makes_folder && !boost::filesystem::is_directory(options.folder))
    throw InputError(options.folder + ": there is no such folder");
  DatabaseOptions database_options;
  database_options.num_threads = options.common.threads;
  SymmetryDatabase database(options.folder, database_options);
  if (options.command != "list") return change(console, database, options) ? 0 : 1;
  for (const std::string& name : database.names()) std::printf("%s\n", name.c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
