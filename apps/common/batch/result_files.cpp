#include "common/batch/result_files.h"

#include <boost/filesystem.hpp>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/batch/csv.h"
#include "common/files/file_text.h"
#include "common/shape_output/shape_output.h"
#include "common/streams/standard_streams.h"

namespace pcl_symmetry::apps {

namespace {

/// Whole lines of a file; none where there is no file.
std::vector<std::string> wholeLines(const std::string& path) {
  std::vector<std::string> lines;
  boost::system::error_code error;
  if (!boost::filesystem::exists(path, error) || boost::filesystem::file_size(path, error) == 0) return lines;
  std::istringstream text(readWholeFile(path));
  for (std::string line; std::getline(text, line);)
    if (!text.eof()) lines.push_back(line + "\n");
  return lines;
}

/// \param kept receives the inputs whose results stand in the file.
/// \return the lines to keep.
std::string linesToKeep(const std::string& path, std::set<std::string>& kept) {
  std::string result;
  for (const std::string& line : wholeLines(path)) {
    const nlohmann::json json = nlohmann::json::parse(line, nullptr, false);
    if (!json.is_object() || !json.contains("file") || !json["file"].is_string())
      throw InputError(path + ": holds a line that is no result of this tool, -resume cannot go on with it");
    if (json.contains("error")) continue;
    kept.insert(json["file"].get<std::string>());
    result += line;
  }
  return result;
}

std::string rowsToKeep(const std::string& path, const std::set<std::string>& kept) {
  std::string result;
  for (const std::string& line : wholeLines(path))
    if (kept.count(firstCell(line)) > 0) result += line;
  return result;
}

}  // namespace

ResultFiles::ResultFiles(const BatchOptions& batch, const CommonOptions& common,
                         const std::vector<std::string>& columns) {
  has_csv_ = batch.csv_path.has_value();
  has_json_ = common.json_path || !has_csv_;
  const std::string json_path = common.json_path.value_or("-");
  if (batch.resume && isStandardStream(json_path)) throw UsageError("-resume needs -json FILE");
  const std::string old_lines = batch.resume ? linesToKeep(json_path, kept_) : "";
  if (has_json_) json_.open(json_path, old_lines);
  if (!has_csv_) return;
  std::vector<nlohmann::json> header{"file"};
  header.insert(header.end(), columns.begin(), columns.end());
  csv_.open(*batch.csv_path, csvLine(header) + (batch.resume ? rowsToKeep(*batch.csv_path, kept_) : ""));
}

void ResultFiles::add(const std::string& json_line, const std::string& csv_lines) {
  // The JSON line comes last: what it names is complete.
  if (has_csv_) csv_.add(csv_lines);
  if (has_json_) json_.add(json_line);
}

void ResultFiles::Sink::open(const std::string& path, const std::string& content) {
  path_ = path;
  if (isStandardStream(path)) return add(content);
  if (content.empty()) {
    file_.open(path, std::ios::binary | std::ios::trunc);
  } else {
    writeText(path, content);
    file_.open(path, std::ios::binary | std::ios::app);
  }
  if (!file_) throw InputError(path + ": cannot be written, " + std::strerror(errno));
}

void ResultFiles::Sink::add(const std::string& text) {
  if (isStandardStream(path_)) return writeStandardOutput(text);
  file_ << text << std::flush;
  if (!file_) throw InputError(path_ + ": cannot be written, " + std::strerror(errno));
}

}  // namespace pcl_symmetry::apps
