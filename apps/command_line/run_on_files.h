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

/// The report of a tool on an input.
struct FileReport {
  std::string text;     ///< for standard output
  nlohmann::json json;  ///< an object; with several inputs, one line
  /// Rows of the table of comma-separated values: numbers and strings, one for each column after "file".
  std::vector<std::vector<nlohmann::json>> rows;
};

class FileJob {
public:
  /// \param console silent if there are several inputs.
  /// \param use called with each report.
  FileJob(std::string path, const Console& console, const CommonOptions& common,
          std::function<void(const FileReport&)> use = {})
      : path_(std::move(path)), console_(console), common_(common), use_(std::move(use)) {}

  const std::string& path() const { return path_; }
  const Console& console() const { return console_; }
  /// The common flags, but with one thread if there are several inputs, each of which has a thread.
  const CommonOptions& common() const { return common_; }

  /// \return the name of an output of this input: {} in the pattern becomes the name of the input without its folder
  /// and extension.
  std::string output(const std::string& pattern) const;

  /// Reports stay even if a later step throws.
  void report(FileReport report) {
    report_ = std::move(report);
    if (use_) use_(*report_);
  }
  const std::optional<FileReport>& reported() const { return report_; }

private:
  std::string path_;
  const Console& console_;
  CommonOptions common_;
  std::function<void(const FileReport&)> use_;
  std::optional<FileReport> report_;
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
