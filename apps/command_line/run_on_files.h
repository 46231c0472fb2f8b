/// Runs the analysis of a tool on one input or on many.
///
/// One input: text on standard output, JSON and CSV in files. Several: its text for each at a terminal, else one line
/// of JSON, in the order of the inputs, as soon as it is known; inputs side by side on all threads; an input that fails
/// has a line with "error", is named again at the end, and does not stop the others. Memory does not grow with the
/// number of inputs.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command_line/command_line.h"
#include "command_line/console.h"
#include "command_line/input_files.h"

namespace pcl_symmetry::apps {

/// For the help of tools all of whose arguments without a flag are inputs.
inline const char* const kManyInputs =
    "files (.pcd, .ply, .obj, .stl, .off, .glb, .xyz, .pts, .asc, .txt or .csv), folders, patterns in quotes, lists "
    "@FILE, or - for standard input";
/// For the help of tools that take an output after their input.
inline const char* const kOneOrManyInputs =
    "file (.pcd, .ply, .obj, .stl, .off, .glb, .xyz, .pts, .asc, .txt or .csv), - for standard input, or many: a "
    "folder, a pattern in quotes, a list @FILE";

struct BatchOptions {
  std::vector<std::string> inputs;  ///< arguments as for inputFiles()
  std::optional<std::string> csv_path;
  bool resume = false;
  /// Outputs of the tool for each input, in addition to JSON and CSV: names in which {} is replaced by the name of the
  /// input.
  std::vector<const std::optional<std::string>*> outputs;

  /// Adds -csv and -resume.
  void addTo(CommandLine& line) {
    line.text("csv", "FILE", csv_path, "write the result as a table of comma-separated values")
        .flag("resume", resume,
              "with several inputs, of which -json FILE has a line each (JSON Lines): keep what FILE holds, and go on "
              "with the inputs that it does not");
  }
};

/// Rows of a table of comma-separated values, of strings and numbers; null = an empty cell.
using Rows = std::vector<std::vector<nlohmann::json>>;

/// The report of a tool on an input.
struct FileReport {
  std::string text;     ///< for standard output
  nlohmann::json json;  ///< an object; with several inputs, one line
  Rows rows;            ///< a cell for each column after "file"
};

/// The work of a tool on an input.
struct FileJob {
  std::string path;
  const Console& console;  ///< silent if there are several inputs
  /// The common flags; with one thread if there are several inputs, each of which has one.
  const CommonOptions& common;
  std::function<void(const FileReport&)> use = {};  ///< called with each report
  std::optional<FileReport> reported = {};

  /// \return the name of an output of this input: {} in the pattern becomes the name of the input without its folder
  /// and extension.
  std::string output(const std::string& pattern) const;

  /// Reports stay even if a later step throws.
  void report(FileReport report) {
    reported = std::move(report);
    if (use) use(*reported);
  }
};

/// \param cells strings and numbers; null = an empty cell.
/// \return a line of comma-separated values (RFC 4180) that ends with a line feed.
std::string csvLine(const std::vector<nlohmann::json>& cells);

/// \throws InputError if two files have the same name, without folder and extension.
void checkNames(const std::vector<InputFile>& files);

/// Works on items in parallel, and shows the progress in the step.
/// \param work throws InputError for an item that fails.
/// \return the error of each item; empty if there is none.
std::vector<std::string> workOnAll(std::size_t num_items, int num_threads, Step& step,
                                   const std::function<void(std::size_t)>& work);

/// \param columns columns of the CSV table, after "file".
/// \param analyze called once for each input, from several threads at once; throws what stops this input.
/// \return exit status of the tool: 1 if an input failed.
/// \throws what the analysis of a single input throws; UsageError where outputs of several inputs would have one name;
/// InputError where results cannot be written.
int runOnFiles(const BatchOptions& batch, const CommonOptions& common, const std::vector<std::string>& columns,
               const std::function<void(FileJob&)>& analyze);

}  // namespace pcl_symmetry::apps
