/// Files of results: tables of comma-separated values (RFC 4180, lines end with a line feed), and lines of JSON that
/// are kept when a batch goes on.
#pragma once

#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "command_line/run_on_files.h"

namespace pcl_symmetry::apps {

/// JSON Lines and CSV. What stands in them is whole lines, also if the program is killed, but perhaps for the last
/// line, which a later run with -resume drops.
class ResultFiles {
public:
  /// Opens the files. JSON goes to standard output where neither a JSON nor a CSV file is named.
  /// \throws InputError where one cannot be written, or holds something else than results and -resume is given.
  ResultFiles(const BatchOptions& batch, const CommonOptions& common, const std::vector<std::string>& columns);

  /// \return whether -resume found the result of the input; failed inputs are tried again.
  bool holds(const std::string& input) const { return kept_.count(input) > 0; }
  std::size_t numKept() const { return kept_.size(); }

  /// \param json_line,csv_lines with their ends.
  /// \throws InputError where they cannot be written.
  void add(const std::string& json_line, const std::string& csv_lines);

private:
  /// A file that grows, or standard output.
  class Sink {
  public:
    using LineFilter = std::function<bool(const std::string& line)>;
    /// \param resume keep those lines of the file that \p keeps says; none otherwise.
    void open(const std::string& path, const std::string& header, const LineFilter& keeps, bool resume);
    void add(const std::string& text);

  private:
    [[noreturn]] void fail() const;

    std::string path_;
    std::ofstream file_;
    std::uintmax_t size_ = 0;  // bytes of the file that are whole lines
  };

  std::set<std::string> kept_;
  Sink json_, csv_;
  bool has_json_ = false, has_csv_ = false;
};

/// \param cells strings and numbers; null is an empty cell.
/// \return a line with its end
std::string csvLine(const std::vector<nlohmann::json>& cells);

/// \return the first cell of a line
std::string firstCell(const std::string& line);

}  // namespace pcl_symmetry::apps
