#include "io/temporary_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <boost/filesystem.hpp>
#include <climits>
#include <csignal>
#include <cstring>

namespace pcl_symmetry::apps {

namespace fs = boost::filesystem;

namespace {

constexpr std::size_t kNumSlots = 64;

/// Names of the files being written, in storage that a signal handler may read.
struct PendingFile {
  std::atomic<bool> used{false};
  std::atomic<bool> ready{false};
  std::array<char, PATH_MAX> name;
};
std::array<PendingFile, kNumSlots> pending_files;

extern "C" void removePendingFiles(int signal) {
  for (PendingFile& file : pending_files) {
    if (file.ready) unlink(file.name.data());
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void installSignalHandlers() {
  static const bool installed = [] {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
      struct sigaction old {};
      sigaction(signal, nullptr, &old);
      if (old.sa_handler == SIG_DFL) std::signal(signal, removePendingFiles);
    }
    return true;
  }();
  static_cast<void>(installed);
}

}  // namespace

TemporaryFile::TemporaryFile(const std::string& name) : name_(name) {
  installSignalHandlers();
  for (std::size_t i = 0; i < pending_files.size(); ++i) {
    PendingFile& file = pending_files[i];
    bool expected = false;
    if (name.size() < PATH_MAX && file.used.compare_exchange_strong(expected, true)) {
      std::memcpy(file.name.data(), name.c_str(), name.size() + 1);
      file.ready = true;
      slot_ = static_cast<int>(i);
      break;
    }
  }
}

TemporaryFile::~TemporaryFile() {
  unlink(name_.c_str());
  if (slot_ < 0) return;
  pending_files[slot_].ready = false;
  pending_files[slot_].used = false;
}

std::string makeUniqueFile(const std::string& model) {
  const std::string name = fs::unique_path(model).string();
  const int descriptor = open(name.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
  if (descriptor < 0) return "";
  close(descriptor);
  return name;
}

}  // namespace pcl_symmetry::apps
