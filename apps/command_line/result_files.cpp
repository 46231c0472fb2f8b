#include "command_line/result_files.h"

#include <boost/algorithm/string.hpp>
#include <boost/filesystem.hpp>
#include <cerrno>
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>

#include "io/shape_output.h"
#include "io/standard_streams.h"

namespace pcl_symmetry::apps {

namespace {

/// Calls use(line) for each line of a file that has an end, which is left out; for none where there is no file.
void forWholeLines(const std::string& path, const std::function<void(const std::string&)>& use) {
  boost::system::error_code error;
  if (!boost::filesystem::exists(path, error)) return;
  std::ifstream text(path, std::ios::binary);
  for (std::string line; std::getline(text, line) && !text.eof();) use(line);
  if (!text.eof()) throw InputError(path + ": cannot be read");
}

/// \return the input whose result the line is; empty where it failed.
std::string inputOf(const std::string& line, const std::string& path) {
  const nlohmann::json json = nlohmann::json::parse(line, nullptr, false);
  if (!json.is_object() || !json.contains("file") || !json["file"].is_string())
    throw InputError(path + ": holds a line that is no result of this tool, -resume cannot go on with it");
  return json.contains("error") ? "" : json["file"].get<std::string>();
}

}  // namespace

ResultFiles::ResultFiles(const BatchOptions& batch, const CommonOptions& common,
                         const std::vector<std::string>& columns) {
  has_csv_ = batch.csv_path.has_value();
  has_json_ = common.json_path || !has_csv_;
  const std::string json_path = common.json_path.value_or("-");
  if (batch.resume && isStandardStream(json_path)) throw UsageError("-resume needs -json FILE");
  std::vector<bool> is_kept;  // each line of the JSON file
  if (batch.resume) {
    forWholeLines(json_path, [&](const std::string& line) {
      const std::string input = inputOf(line, json_path);
      is_kept.push_back(!input.empty());
      if (!input.empty()) kept_.insert(input);
    });
  }
  std::size_t number = 0;
  const auto keeps_line = [&](const std::string&) { return is_kept[number++]; };
  const auto keeps_row = [&](const std::string& line) { return holds(firstCell(line)); };
  if (has_json_) json_.open(json_path, "", keeps_line, !kept_.empty());
  if (!has_csv_) return;
  std::vector<nlohmann::json> header{"file"};
  header.insert(header.end(), columns.begin(), columns.end());
  csv_.open(*batch.csv_path, csvLine(header), keeps_row, !kept_.empty());
}

void ResultFiles::add(const std::string& json_line, const std::string& csv_lines) {
  // The JSON line comes last: what it names is complete.
  if (has_csv_) csv_.add(csv_lines);
  if (has_json_) json_.add(json_line);
}

void ResultFiles::Sink::open(const std::string& path, const std::string& header, const LineFilter& keeps, bool resume) {
  path_ = path;
  if (isStandardStream(path)) return add(header);
  if (resume) {
    // Line by line, because the file may be larger than what the tool needs besides.
    writeAtomically(path, [&](const std::string& temporary) {
      file_.open(temporary, std::ios::binary | std::ios::trunc);
      file_ << header;
      forWholeLines(path, [&](const std::string& line) {
        if (keeps(line)) file_ << line << '\n';
      });
      file_.close();
      if (!file_) fail();
    });
    file_.open(path, std::ios::binary | std::ios::app);
    size_ = boost::filesystem::file_size(path);
  } else {
    file_.open(path, std::ios::binary | std::ios::trunc);
  }
  if (!file_) fail();
  if (!resume) add(header);
}

void ResultFiles::Sink::add(const std::string& text) {
  if (isStandardStream(path_)) return writeStandardOutput(text);
  file_ << text << std::flush;
  if (!file_) {
    const int reason = errno;
    boost::system::error_code ignored;  // a device has no size
    boost::filesystem::resize_file(path_, size_, ignored);
    if (size_ == 0 && !ignored) boost::filesystem::remove(path_, ignored);
    errno = reason;
    fail();
  }
  size_ += text.size();
}

void ResultFiles::Sink::fail() const {
  throw InputError(path_ + ": cannot be written, " + std::strerror(errno));
}

namespace {

std::string cellOf(const nlohmann::json& value) {
  if (value.is_null()) return "";
  if (!value.is_string()) return value.dump();
  const std::string text = value.get<std::string>();
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  return "\"" + boost::algorithm::replace_all_copy(text, "\"", "\"\"") + "\"";
}

}  // namespace

std::string csvLine(const std::vector<nlohmann::json>& cells) {
  std::string line;
  for (const nlohmann::json& cell : cells) line += (line.empty() ? "" : ",") + cellOf(cell);
  return line + "\n";
}

std::string firstCell(const std::string& line) {
  if (line.empty() || line.front() != '"') return line.substr(0, line.find(','));
  std::string cell;
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (line[i] == '"' && (i + 1 == line.size() || line[++i] != '"')) break;
    cell += line[i];
  }
  return cell;
}

}  // namespace pcl_symmetry::apps
