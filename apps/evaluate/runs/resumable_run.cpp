#include "evaluate/runs/resumable_run.h"

namespace pcl_symmetry::apps {

namespace {

/// The words that say what is computed.
std::string wordsOf(int argc, char** argv) {
  std::string words;
  for (int i = 0; i < argc; ++i) {
    std::string word = argv[i];
    const std::size_t name = word.find_first_not_of('-');
    const std::string flag = name == 0 || name == std::string::npos ? "" : word.substr(name);
    if (flag == "resume" || flag == "threads") ++i;  // its value too
    const bool has_value = flag.rfind("resume=", 0) == 0 || flag.rfind("threads=", 0) == 0;
    if (i == 0 || flag == "quiet" || flag == "resume" || flag == "threads" || has_value) continue;
    words += word + "\n";
  }
  return words;
}

}  // namespace

void ResumableRun::addFlag(CommandLine& line, std::optional<std::string>& path) {
  line.text("resume", "FILE", path,
            "keep what is done in FILE as it comes; a run with the same flags that was interrupted goes on from there");
}

ResumableRun::ResumableRun(SharedWork& processes, const std::optional<std::string>& path, int argc, char** argv)
    : processes_(processes), path_(path), purpose_(wordsOf(argc, argv)) {}

void ResumableRun::run(const std::vector<std::string>& names, const WorkFunctions& functions, int num_threads) {
  if (path_ && isFirst() && !journal_) journal_ = std::make_unique<ResultJournal>(*path_, purpose_);
  runWithJournal(processes_, journal_.get(), names, functions, num_threads);
}

}  // namespace pcl_symmetry::apps
