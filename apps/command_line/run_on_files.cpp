#include "command_line/run_on_files.h"

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem/path.hpp>
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <utility>

#include "command_line/input_files.h"
#include "command_line/result_files.h"
#include "command_line/tool_errors.h"
#include "core/base/parallel.h"
#include "io/answers.h"
#include "io/shape_output.h"
#include "io/standard_streams.h"

namespace pcl_symmetry::apps {

namespace {

/// Results that wait for one before them, for each thread.
constexpr std::size_t kWaitingPerThread = 64;
/// Failures that are kept to be named at the end.
constexpr std::size_t kMaxFailures = 1000;

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

std::string lineOf(const nlohmann::json& json) {
  return jsonText(json, -1) + "\n";
}

int numToStandardOutput(const BatchOptions& batch, const CommonOptions& common) {
  const auto is = [](const std::optional<std::string>& path) { return path && isStandardStream(*path) ? 1 : 0; };
  int number = is(common.json_path) + is(batch.csv_path);
  for (const std::optional<std::string>* output : batch.outputs) number += is(*output);
  if (number > 1) throw UsageError("only one output can be -, standard output");
  return number;
}

int runOnOne(const std::string& path, const BatchOptions& batch, const CommonOptions& common,
             const std::vector<std::string>& columns, const std::function<void(FileJob&)>& analyze) {
  const bool text_wanted = numToStandardOutput(batch, common) == 0;
  if (batch.resume) throw UsageError("-resume needs several inputs: a folder, a pattern, a list or more arguments");
  for (const std::optional<std::string>* output : batch.outputs)
    if (*output) checkTarget(**output);
  if (batch.csv_path) checkTarget(*batch.csv_path);
  const Console console(common.quiet);
  FileJob job(path, console, common.threads);
  const auto write = [&] {
    if (!job.reported()) return;
    const FileReport& report = *job.reported();
    if (text_wanted) writeStandardOutput(report.text);
    if (common.json_path) writeText(*common.json_path, jsonText(report.json) + "\n");
    if (!batch.csv_path) return;
    std::vector<nlohmann::json> header{"file"};
    header.insert(header.end(), columns.begin(), columns.end());
    writeText(*batch.csv_path, csvLine(header) + csvLines(path, report));
  };
  try {
    analyze(job);
  } catch (...) {
    write();
    throw;
  }
  write();
  return 0;
}

/// \throws UsageError or InputError where two inputs would write one file.
void checkOutputs(const BatchOptions& batch, const std::vector<InputFile>& files) {
  std::string pattern;
  for (const std::optional<std::string>* output : batch.outputs) {
    if (!*output) continue;
    pattern = **output;
    if (isStandardStream(pattern)) throw UsageError("with several inputs only -json and -csv can be -");
    if (pattern.find("{}") == std::string::npos)
      throw UsageError(pattern + ": with several inputs the name must hold {}, which stands for the name of the input");
  }
  if (pattern.empty()) return;
  std::map<std::string, std::size_t> input_of_name;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const auto [known, added] = input_of_name.emplace(stemOf(files[i].path), i);
    if (!added)
      throw InputError(files[i].path + ": has the name of " + files[known->second].path + ", names must differ");
  }
}

/// Hands the inputs out, and their results on in the order of the inputs.
class Batch {
public:
  Batch(const std::vector<InputFile>& files, const BatchOptions& batch, const CommonOptions& common,
        const std::vector<std::string>& columns)
      : files_(files),
        results_(batch, common, columns),
        num_threads_(static_cast<std::size_t>(resolveNumThreads(common.threads))),
        console_(common.quiet),
        step_(console_, "Working on " + std::to_string(files.size()) + " files") {}

  int run(const std::function<void(FileJob&)>& analyze) {
    parallelBlocks(std::min(num_threads_, files_.size()), static_cast<int>(num_threads_), [&](std::size_t) {
      for (std::size_t i = 0; takeNext(i);) finish(i, resultOf(files_[i].path, analyze));
    });
    if (failure_) std::rethrow_exception(failure_);
    std::string summary = std::to_string(files_.size() - num_failed_) + " done";
    if (results_.numKept() > 0) summary += ", " + std::to_string(results_.numKept()) + " of them before";
    if (num_failed_ > 0) summary += ", " + std::to_string(num_failed_) + " failed";
    step_.done(summary);
    for (const std::string& failure : failures_) console_.error(failure);
    if (num_failed_ > failures_.size())
      console_.error(std::to_string(num_failed_ - failures_.size()) + " more files failed");
    return num_failed_ > 0 ? 1 : 0;
  }

private:
  struct Result {
    std::string json_line, csv_lines, error;
  };

  /// \return false where none is left. Waits while too many results wait for an earlier one.
  bool takeNext(std::size_t& i) {
    std::unique_lock<std::mutex> lock(mutex_);
    while (next_ < files_.size() && results_.holds(files_[next_].path)) {
      waiting_[next_++] = {};
      writeWaiting();
    }
    if (failure_ || next_ >= files_.size()) return false;
    i = next_++;
    const std::size_t most = kWaitingPerThread * num_threads_;
    written_.wait(lock, [&] { return failure_ || i < num_written_ + most; });
    return !failure_;
  }

  Result resultOf(const std::string& path, const std::function<void(FileJob&)>& analyze) const {
    const Console silent(true);
    FileJob job(path, silent, 1);
    Result result;
    try {
      namingFile(path, [&] { analyze(job); });
    } catch (const std::exception& error) {
      result.error = error.what();
    }
    nlohmann::json json = job.reported() ? job.reported()->json : nlohmann::json::object();
    json["file"] = path;
    if (!result.error.empty()) json["error"] = result.error;
    result.json_line = lineOf(json);
    if (job.reported()) result.csv_lines = csvLines(path, *job.reported());
    return result;
  }

  void finish(std::size_t i, Result result) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!result.error.empty() && ++num_failed_ <= kMaxFailures) failures_.push_back(result.error);
    waiting_[i] = std::move(result);
    writeWaiting();
    step_.progress(static_cast<double>(num_written_) / static_cast<double>(files_.size()));
  }

  /// Under the lock.
  void writeWaiting() {
    try {
      for (auto first = waiting_.begin(); first != waiting_.end() && first->first == num_written_ && !failure_;) {
        if (!first->second.json_line.empty()) results_.add(first->second.json_line, first->second.csv_lines);
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
  Console console_;
  Step step_;
  std::mutex mutex_;
  std::condition_variable written_;
  std::map<std::size_t, Result> waiting_;
  std::size_t next_ = 0, num_written_ = 0, num_failed_ = 0;
  std::vector<std::string> failures_;
  std::exception_ptr failure_;
};

}  // namespace

std::string FileJob::output(const std::string& pattern) const {
  return boost::algorithm::replace_all_copy(pattern, "{}", stemOf(path_));
}

int runOnFiles(const BatchOptions& batch, const CommonOptions& common, const std::vector<std::string>& columns,
               const std::function<void(FileJob&)>& analyze) {
  if (batch.inputs.size() == 1 && !standsForSeveral(batch.inputs.front()))
    return runOnOne(batch.inputs.front(), batch, common, columns, analyze);
  const std::vector<InputFile> files = inputFiles(batch.inputs);
  numToStandardOutput(batch, common);
  checkOutputs(batch, files);
  return Batch(files, batch, common, columns).run(analyze);
}

}  // namespace pcl_symmetry::apps
