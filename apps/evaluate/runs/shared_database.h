/// A database that the processes of a run make together, and of which each has a copy.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/streams/temporary_file.h"
#include "evaluate/runs/resumable_run.h"
#include "pcl_symmetry/recognition/symmetry_database.h"

namespace pcl_symmetry::apps {

/// The copies lie in the folder of temporary files while the object lives. All processes answer alike, and as one alone
/// does.
class SharedDatabase {
public:
  /// The processes describe the models, and the first one gives the others its file.
  SharedDatabase(const std::vector<ModelInput>& models, const DatabaseOptions& options, ResumableRun& work,
                 const std::function<void(double)>& progress);

  const SymmetryDatabase& operator*() const { return *database_; }
  const SymmetryDatabase* operator->() const { return &*database_; }
  /// The copy of this process.
  const std::string& path() const { return path_; }
  /// Name and reason of models that could not be used; on the first process.
  const std::vector<std::pair<std::string, std::string>>& failures() const { return report_.failures; }

private:
  void shareFile(ResumableRun& work) const;

  const std::string path_;
  const TemporaryFile file_, log_, memory_;  // the last two are SQLite's
  BuildReport report_;
  std::optional<SymmetryDatabase> database_;
};

}  // namespace pcl_symmetry::apps
