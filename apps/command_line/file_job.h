/// One input of a tool, and what the tool reports of it.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command_line/console.h"

namespace pcl_symmetry::apps {

/// What a tool reports of an input.
struct FileReport {
  std::string text;     ///< for standard output, where there is one input
  nlohmann::json json;  ///< an object; in a file of several inputs it is a line
  /// Rows of the table of comma-separated values: numbers and strings, one for each column after "file".
  std::vector<std::vector<nlohmann::json>> rows;
};

class FileJob {
public:
  /// \param console says nothing where there are several inputs.
  /// \param num_threads as -threads; 1 where there are several inputs, of which each has a thread.
  FileJob(std::string path, const Console& console, int num_threads)
      : path_(std::move(path)), console_(console), num_threads_(num_threads) {}

  const std::string& path() const { return path_; }
  const Console& console() const { return console_; }
  int numThreads() const { return num_threads_; }

  /// \return the name of an output of this input: {} in the pattern becomes the name of the input without its folder and
  /// extension.
  std::string output(const std::string& pattern) const;

  /// What is reported stays reported if something later throws.
  void report(FileReport report) { report_ = std::move(report); }
  const std::optional<FileReport>& reported() const { return report_; }

private:
  std::string path_;
  const Console& console_;
  int num_threads_;
  std::optional<FileReport> report_;
};

}  // namespace pcl_symmetry::apps
