/// Results of shared work in a file, from which an interrupted run goes on.
#pragma once

#include <cstddef>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/processes/shared_work.h"

namespace pcl_symmetry::apps {

/// Each result is written as soon as it is there. A result that was cut off by the end of a process is left out.
class ResultJournal {
public:
  /// \param purpose what the results are made from: a journal of another purpose is not taken.
  /// \throws InputError where the file is not a journal of this purpose, or cannot be written.
  ResultJournal(std::string path, const std::string& purpose);

  /// Results of earlier runs; a name is used once.
  const std::map<std::string, std::string>& results() const { return results_; }

  /// \throws InputError where it cannot be written.
  void add(const std::string& name, const std::string& result);

private:
  void read(const std::string& purpose);

  std::string path_;
  std::map<std::string, std::string> results_;
  std::ofstream file_;
};

/// SharedWork::run() that first takes what stands in the journal, and does the others.
/// \param journal of the first process; null for none.
/// \param names of the items in the journal, the same on all processes.
void runWithJournal(SharedWork& processes, ResultJournal* journal, const std::vector<std::string>& names,
                    const WorkFunctions& functions, int num_threads);

}  // namespace pcl_symmetry::apps
