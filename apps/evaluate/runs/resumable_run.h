/// The work of an evaluation over items, shared by processes, and gone on with after an interruption.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/command_line/command_line.h"
#include "common/processes/result_journal.h"
#include "common/processes/shared_work.h"

namespace pcl_symmetry::apps {

/// The processes of a run and the journal of its results.
class ResumableRun {
public:
  /// -resume FILE.
  static void addFlag(CommandLine& line, std::optional<std::string>& path);

  /// \param path of the journal; none for no journal.
  /// \param argc,argv the command line: a journal is taken for the same one alone, but for -resume, -threads, -quiet.
  ResumableRun(SharedWork& processes, const std::optional<std::string>& path, int argc, char** argv);

  SharedWork& processes() { return processes_; }
  bool isFirst() const { return processes_.isFirst(); }
  /// Gives all processes the text of the first one.
  void broadcast(std::string& text) { processes_.broadcast(text); }
  /// \param num_threads that were asked for, 0 = one per core.
  /// \return threads for one item: one where processes share the items and nothing else was asked for.
  int threadsOfItem(int num_threads) const { return processes_.isShared() && num_threads == 0 ? 1 : num_threads; }

  /// Does all items that are not in the journal, and takes those that are.
  /// \param names of the items, none twice in a run.
  void run(const std::vector<std::string>& names, const WorkFunctions& functions, int num_threads = 1);

private:
  SharedWork& processes_;
  std::optional<std::string> path_;
  std::string purpose_;
  std::unique_ptr<ResultJournal> journal_;
};

}  // namespace pcl_symmetry::apps
