#include "evaluate/runs/shared_database.h"

#include <boost/filesystem.hpp>
#include <fstream>

#include "common/command_line/tool_errors.h"
#include "database/shared_build.h"

namespace pcl_symmetry::apps {

namespace {

// Bytes of a message. chosen: the database of a thousand models takes ten; half and twice take the same time.
constexpr std::size_t kPart = 16'000'000;

}  // namespace

SharedDatabase::SharedDatabase(const std::vector<ModelInput>& models, const DatabaseOptions& options,
                               ResumableRun& work, const std::function<void(double)>& progress)
    : path_(boost::filesystem::unique_path(temporaryModel(".db")).string()),
      file_(path_),
      log_(path_ + "-wal"),
      memory_(path_ + "-shm") {
  report_ = buildShared(work.processes(), path_, options, models, StoreOrder::OfInputs, [&](double share) {
    progress(share);
    return true;
  });
  shareFile(work);
  database_.emplace(path_, options);
}

void SharedDatabase::shareFile(ResumableRun& work) const {
  if (!work.processes().isShared()) return;
  std::ifstream from;
  std::ofstream to;
  if (work.isFirst()) from.open(path_, std::ios::binary);
  std::string part;
  do {
    if (work.isFirst()) {
      part.resize(kPart);
      from.read(part.data(), static_cast<std::streamsize>(kPart));
      part.resize(static_cast<std::size_t>(from.gcount()));
    }
    work.broadcast(part);
    if (work.isFirst() || part.empty()) continue;
    if (!to.is_open()) to.open(path_, std::ios::binary);
    if (!to.write(part.data(), static_cast<std::streamsize>(part.size())).flush())
      throw InputError(path_ + ": cannot be written");
  } while (!part.empty());
}

}  // namespace pcl_symmetry::apps
