#include "command_line/run_on_files.h"

#include <unistd.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem.hpp>
#include <cerrno>
#include <cmath>
#include <condition_variable>
#include <fstream>
#include <map>
#include <mutex>
#include <set>

#include "io/answers.h"
#include "io/file_text.h"
#include "io/shape_output.h"

namespace pcl_symmetry::apps {

namespace {

constexpr std::size_t kWaitingPerThread = 64;  // results that wait for an earlier one, for each thread
constexpr std::size_t kMaxFailures = 1000;     // failures that are kept to be listed at the end

std::string cellOf(const nlohmann::json& value) {
  if (value.is_null() || (value.is_number_float() && std::isnan(value.get<double>()))) return "";
  if (!value.is_string()) return value.dump();
  const std::string text = value.get<std::string>();
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  return "\"" + boost::algorithm::replace_all_copy(text, "\"", "\"\"") + "\"";
}

/// \return the first cell of a line of comma-separated values.
std::string firstCell(const std::string& line) {
  if (line.empty() || line.front() != '"') return line.substr(0, line.find(','));
  std::string cell;
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (line[i] == '"' && (i + 1 == line.size() || line[++i] != '"')) break;
    cell += line[i];
  }
  return cell;
}

std::string stemOf(const std::string& path) {
  return isStandardStream(path) ? "stdin" : boost::filesystem::path(path).stem().string();
}

std::string csvLines(const std::string& path, const FileReport& report) {
  std::string lines;
  for (const std::vector<nlohmann::json>& row : report.rows) {
    std::vector<nlohmann::json> cells{path};
    cells.insert(cells.end(), row.begin(), row.end());
    lines += csvLine(cells);
  }
  return lines;
}

bool isTextWanted(const BatchOptions& batch, const CommonOptions& common) {
  std::vector<std::optional<std::string>> outputs{common.json_path, batch.csv_path};
  for (const std::optional<std::string>* output : batch.outputs) outputs.push_back(*output);
  return isStandardOutputFree(outputs);
}

int runOnOne(const std::string& path, const BatchOptions& batch, const CommonOptions& common,
             const std::string& csv_header, const std::function<void(FileJob&)>& analyze) {
  const bool text_wanted = isTextWanted(batch, common);
  if (batch.resume) throw UsageError("-resume needs several inputs: a folder, a pattern, a list or more arguments");
  for (const std::optional<std::string>* output : batch.outputs)
    if (*output) checkTarget(**output);
  if (batch.csv_path) checkTarget(*batch.csv_path);
  const Console console(common.quiet);
  // Files before pictures are drawn, which takes longer and may fail; the table after the steps that the console shows.
  FileJob job{path, console, common, [&](const FileReport& report) {
                writeJson(common, report.json);
                if (batch.csv_path) writeText(*batch.csv_path, csv_header + csvLines(path, report));
              }};
  const auto print = [&] {
    if (text_wanted && job.reported) writeText("-", job.reported->text);
  };
  try {
    analyze(job);
  } catch (...) {
    print();
    throw;
  }
  print();
  return 0;
}

/// \throws UsageError or InputError if two inputs would write one file, or the folder of an output is missing.
void checkOutputs(const BatchOptions& batch, const std::vector<InputFile>& files) {
  std::string pattern;
  for (const std::optional<std::string>* output : batch.outputs) {
    if (!*output) continue;
    pattern = **output;
    if (isStandardStream(pattern)) throw UsageError("with several inputs only -json and -csv can be -");
    if (pattern.find("{}") == std::string::npos)
      throw UsageError(pattern + ": with several inputs the name must hold {}, which represents the name of the input");
    if (boost::filesystem::path(pattern).parent_path().string().find("{}") == std::string::npos) checkTarget(pattern);
  }
  if (!pattern.empty()) checkNames(files);
}

/// Calls use(line) for each complete line of a file, without its end; for none if there is no file.
void forWholeLines(const std::string& path, const std::function<void(const std::string&)>& use) {
  boost::system::error_code error;
  if (!boost::filesystem::exists(path, error)) return;
  std::ifstream text(path, std::ios::binary);
  for (std::string line; std::getline(text, line) && !text.eof();) use(line);
  if (!text.eof()) throw InputError(path + ": cannot be read");
}

/// \return how a result was made, without flags that change no value of it.
nlohmann::json analysisOf(nlohmann::json made_by) {
  for (const char* flag : {"csv", "html", "json", "png", "profile", "quiet", "report", "resume", "support", "threads"})
    if (made_by.contains("options")) made_by["options"].erase(flag);
  return made_by;
}

/// \return the input whose result is in a line of a file; empty if it failed, or has changed since.
std::string inputOf(const std::string& line, const std::string& path) {
  const nlohmann::json json = nlohmann::json::parse(line, nullptr, false);
  if (!json.is_object() || !json.contains("file") || !json["file"].is_string())
    throw InputError(path + ": holds a line that is no result of this tool, -resume cannot go on with it");
  if (json.contains("made_by") && analysisOf(json["made_by"]) != analysisOf(madeBy()))
    throw InputError(path + ": was made by " + analysisOf(json["made_by"]).dump() +
                     ", -resume goes on with the same version, options and seed");
  const std::string input = json["file"];
  boost::system::error_code missing;
  const std::time_t changed = boost::filesystem::last_write_time(input, missing);
  const bool has_changed = !missing && changed > boost::filesystem::last_write_time(path);
  return json.contains("error") || has_changed ? "" : input;
}

/// A file that grows, or standard output.
class Sink {
public:
  /// \param keeps lines of an existing file for which this is true are kept; none without \p resume.
  Sink(const std::string& path, const std::string& header, const std::function<bool(const std::string&)>& keeps,
       bool resume)
      : path_(path) {
    if (isStandardStream(path)) {
      add(header);
      return;
    }
    if (resume) {
      // Line by line, because the file may be larger than everything else that the tool needs.
      writeStream(path, [&](std::ostream& kept) {
        kept << header;
        forWholeLines(path, [&](const std::string& line) {
          if (keeps(line)) kept << line << '\n';
        });
      });
      size_ = boost::filesystem::file_size(path);
    }
    file_.open(path, std::ios::binary | (resume ? std::ios::app : std::ios::trunc));
    if (!file_) fail();
    if (!resume) add(header);
  }

  void add(const std::string& text) {
    if (isStandardStream(path_)) return writeText(path_, text);
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

private:
  [[noreturn]] void fail() const { throw InputError(path_ + ": cannot be written, " + std::strerror(errno)); }

  std::string path_;
  std::ofstream file_;
  std::uintmax_t size_ = 0;  // bytes of the file that are complete lines
};

/// JSON Lines and CSV, or tables at a terminal. Files hold complete lines, even if the program is killed, except
/// perhaps for the last line, which a later run with -resume drops.
class ResultFiles {
public:
  /// Opens the files. If neither a JSON nor a CSV file is named, a terminal gets tables, and a pipe JSON.
  /// \throws InputError if one cannot be written, or if -resume is given and it holds something other than results.
  ResultFiles(const BatchOptions& batch, const CommonOptions& common, const std::string& csv_header) {
    has_text_ = !common.json_path && !batch.csv_path && isatty(STDOUT_FILENO);
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
    if (common.json_path || (!batch.csv_path && !has_text_)) json_.emplace(json_path, "", keeps_line, !kept_.empty());
    if (batch.csv_path) csv_.emplace(*batch.csv_path, csv_header, keeps_row, !kept_.empty());
  }

  /// \return whether -resume found the result of the input; failed inputs are tried again.
  bool holds(const std::string& input) const { return kept_.count(input) > 0; }
  std::size_t numKept() const { return kept_.size(); }

  /// \param json_line,csv_lines,text with their line ends.
  void add(const std::string& json_line, const std::string& csv_lines, const std::string& text) {
    // The JSON line comes last: what it names is then complete.
    if (csv_) csv_->add(csv_lines);
    if (json_) json_->add(json_line);
    if (has_text_) writeText("-", text);
  }

private:
  std::set<std::string> kept_;
  std::optional<Sink> json_, csv_;
  bool has_text_;
};

/// Distributes the inputs, and passes their results on in the order of the inputs.
class Batch {
public:
  Batch(const std::vector<InputFile>& files, const BatchOptions& batch, const CommonOptions& common,
        const std::string& csv_header)
      : files_(files),
        results_(batch, common, csv_header),
        num_threads_(static_cast<std::size_t>(resolveNumThreads(common.threads))),
        common_(common),
        console_(common.quiet) {
    common_.threads = 1;
    // Results on the same terminal must not cut a line of progress in two.
    const bool is_free = isTextWanted(batch, common) && (common.json_path || batch.csv_path);
    if (is_free || (isatty(STDERR_FILENO) && !isatty(STDOUT_FILENO)))
      step_.emplace(console_, "Working on " + counted(files.size(), "file"));
  }

  int run(const std::function<void(FileJob&)>& analyze) {
    parallelBlocks(std::min(num_threads_, files_.size()), static_cast<int>(num_threads_), [&](std::size_t) {
      for (std::size_t i = 0; takeNext(i);) finish(i, resultOf(files_[i].path, analyze));
    });
    if (failure_) std::rethrow_exception(failure_);
    std::string summary = std::to_string(files_.size() - num_failed_) + " done";
    if (results_.numKept() > 0) summary += ", " + std::to_string(results_.numKept()) + " of them before";
    if (num_failed_ > 0) summary += ", " + std::to_string(num_failed_) + " failed";
    if (step_)
      step_->done(summary);
    else
      console_.info(counted(files_.size(), "file") + ": " + summary);
    for (const std::string& failure : failures_) console_.error(failure);
    if (num_failed_ > failures_.size())
      console_.error(std::to_string(num_failed_ - failures_.size()) + " more files failed");
    return num_failed_ > 0 ? 1 : 0;
  }

private:
  struct Result {
    std::string json_line, csv_lines, text, error;
  };

  /// \return false if none is left. Waits while too many results wait for an earlier one.
  bool takeNext(std::size_t& i) {
    std::unique_lock<std::mutex> lock(mutex_);
    while (next_ < files_.size() && results_.holds(files_[next_].path)) {
      waiting_[next_++] = {};
      writeWaiting();
    }
    if (failure_ || next_ >= files_.size()) return false;
    i = next_++;
    const std::size_t max_waiting = kWaitingPerThread * num_threads_;
    written_.wait(lock, [&] { return failure_ || i < num_written_ + max_waiting; });
    return !failure_;
  }

  Result resultOf(const std::string& path, const std::function<void(FileJob&)>& analyze) const {
    const Console silent(true);
    FileJob job{path, silent, common_};
    Result result;
    try {
      namingFile(path, [&] { analyze(job); });
    } catch (const std::exception& error) {
      result.error = error.what();
    }
    nlohmann::json json = job.reported ? job.reported->json : nlohmann::json::object();
    json["file"] = path;
    if (!result.error.empty()) json["error"] = result.error;
    result.json_line = jsonText(json, -1) + "\n";
    if (!job.reported) return result;
    result.csv_lines = csvLines(path, *job.reported);
    result.text = path + "\n" + job.reported->text;
    return result;
  }

  void finish(std::size_t i, Result result) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!result.error.empty() && ++num_failed_ <= kMaxFailures) failures_.push_back(result.error);
    waiting_[i] = std::move(result);
    writeWaiting();
    if (step_) step_->progress(static_cast<double>(num_written_) / static_cast<double>(files_.size()));
  }

  /// To be called under the lock.
  void writeWaiting() {
    try {
      for (auto first = waiting_.begin(); first != waiting_.end() && first->first == num_written_ && !failure_;) {
        if (!first->second.json_line.empty())
          results_.add(first->second.json_line, first->second.csv_lines, first->second.text);
        first = waiting_.erase(first);
        ++num_written_;
      }
    } catch (...) {
      failure_ = std::current_exception();
    }
    written_.notify_all();
  }

  const std::vector<InputFile>& files_;
  ResultFiles results_;
  std::size_t num_threads_;
  CommonOptions common_;
  Console console_;
  std::optional<Step> step_;
  std::mutex mutex_;
  std::condition_variable written_;
  std::map<std::size_t, Result> waiting_;
  std::size_t next_ = 0, num_written_ = 0, num_failed_ = 0;
  std::vector<std::string> failures_;
  std::exception_ptr failure_;
};

}  // namespace

std::string csvLine(const std::vector<nlohmann::json>& cells) {
  std::string line;
  for (const nlohmann::json& cell : cells) line += (line.empty() ? "" : ",") + cellOf(cell);
  return line + "\n";
}

void checkNames(const std::vector<InputFile>& files) {
  std::map<std::string, std::string> path_of_name;
  for (const InputFile& file : files) {
    const auto [known, added] = path_of_name.emplace(stemOf(file.path), file.path);
    if (!added) throw InputError(file.path + ": has the name of " + known->second + ", names must differ");
  }
}

std::vector<std::string> workOnAll(std::size_t num_items, int num_threads, Step& step,
                                   const std::function<void(std::size_t)>& work) {
  std::vector<std::string> failures(num_items);
  std::mutex mutex;
  std::size_t num_done = 0;
  parallelBlocks(num_items, num_threads, [&](std::size_t i) {
    try {
      work(i);
    } catch (const InputError& error) {
      failures[i] = error.what();
    }
    const std::lock_guard<std::mutex> lock(mutex);
    step.progress(static_cast<double>(++num_done) / static_cast<double>(num_items));
  });
  return failures;
}

std::string FileJob::output(const std::string& pattern) const {
  return boost::algorithm::replace_all_copy(pattern, "{}", stemOf(path));
}

int runOnFiles(const BatchOptions& batch, const CommonOptions& common, const std::vector<std::string>& columns,
               const std::function<void(FileJob&)>& analyze) {
  std::vector<nlohmann::json> header{"file"};
  header.insert(header.end(), columns.begin(), columns.end());
  if (batch.inputs.size() == 1 && !standsForSeveral(batch.inputs.front()))
    return runOnOne(batch.inputs.front(), batch, common, csvLine(header), analyze);
  const std::vector<InputFile> files = inputFiles(batch.inputs);
  isTextWanted(batch, common);
  checkOutputs(batch, files);
  const int status = Batch(files, batch, common, csvLine(header)).run(analyze);
  const std::string& last = batch.inputs.back();
  boost::system::error_code error;
  if (status != 0 && batch.inputs.size() > 1 && !standsForSeveral(last) && !isStandardStream(last) &&
      !boost::filesystem::exists(last, error))
    Console(common.quiet).error("all arguments are inputs; outputs are named by flags, such as -json FILE, see -h");
  return status;
}

}  // namespace pcl_symmetry::apps
