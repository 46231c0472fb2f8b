#include "scene/folder_watch.h"

#include <algorithm>
#include <boost/filesystem/path.hpp>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "command_line/tool_errors.h"

#if __has_include(<sys/inotify.h>)
#include <poll.h>
#include <sys/inotify.h>
#include <unistd.h>
#define PCL_SYMMETRY_INOTIFY
#endif

namespace pcl_symmetry::apps {

namespace {

volatile std::sig_atomic_t stopped = 0;

extern "C" void stopWatching(int) {
  stopped = 1;
}

}  // namespace

#ifdef PCL_SYMMETRY_INOTIFY

namespace {

// What a user, a service manager and a closed terminal end a program by.
constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};

// Bytes.
constexpr std::size_t kBufferSize = 1u << 16;

}  // namespace

struct FolderWatch::System {
  int descriptor = -1;
  sigset_t signals = {};
  struct sigaction old_actions[3] = {};
  sigset_t old_mask = {};
};

FolderWatch::FolderWatch(const std::string& folder) : folder_(folder), system_(new System) {
  system_->descriptor = inotify_init1(IN_CLOEXEC | IN_NONBLOCK);
  const std::uint32_t events = IN_CLOSE_WRITE | IN_MOVED_TO | IN_DELETE_SELF | IN_MOVE_SELF | IN_ONLYDIR;
  if (system_->descriptor < 0 || inotify_add_watch(system_->descriptor, folder.c_str(), events) < 0) {
    const std::string reason = std::strerror(errno);
    if (system_->descriptor >= 0) close(system_->descriptor);
    delete system_;
    throw InputError(folder + ": cannot be watched, " + reason);
  }
  // The signals are let through only while next() waits: none comes between its question and its wait, and threads that
  // are made later do not take them.
  stopped = 0;
  sigemptyset(&system_->signals);
  struct sigaction action = {};
  action.sa_handler = stopWatching;
  for (std::size_t i = 0; i < std::size(kSignals); ++i) {
    sigaddset(&system_->signals, kSignals[i]);
    sigaction(kSignals[i], &action, &system_->old_actions[i]);
  }
  pthread_sigmask(SIG_BLOCK, &system_->signals, &system_->old_mask);
}

FolderWatch::~FolderWatch() {
  close(system_->descriptor);
  for (std::size_t i = 0; i < std::size(kSignals); ++i) sigaction(kSignals[i], &system_->old_actions[i], nullptr);
  pthread_sigmask(SIG_SETMASK, &system_->old_mask, nullptr);
  delete system_;
}

std::optional<std::string> FolderWatch::next() {
  for (;;) {
    // ppoll() does not let a signal through while names keep coming.
    const timespec at_once{0, 0};
    if (stopped || sigtimedwait(&system_->signals, nullptr, &at_once) > 0) return std::nullopt;
    pollfd asked{system_->descriptor, POLLIN, 0};
    const int ready = ppoll(&asked, 1, waiting_.empty() ? nullptr : &at_once, &system_->old_mask);
    if (ready > 0) readEvents();
    if (waiting_.empty()) continue;
    std::string path = (boost::filesystem::path(folder_) / waiting_.front()).string();
    waiting_.pop_front();
    return path;
  }
}

void FolderWatch::readEvents() {
  alignas(inotify_event) char buffer[kBufferSize];
  const ssize_t size = read(system_->descriptor, buffer, sizeof(buffer));
  for (ssize_t at = 0; at < size;) {
    const auto* event = reinterpret_cast<const inotify_event*>(buffer + at);
    at += static_cast<ssize_t>(sizeof(inotify_event) + event->len);
    if (event->mask & IN_Q_OVERFLOW) missed_ = true;
    if (event->mask & (IN_DELETE_SELF | IN_MOVE_SELF | IN_UNMOUNT)) throw InputError(folder_ + ": is gone");
    if (event->len == 0 || (event->mask & IN_ISDIR)) continue;
    const std::string name = event->name;
    if (std::find(waiting_.begin(), waiting_.end(), name) == waiting_.end()) waiting_.push_back(name);
  }
}

#else

struct FolderWatch::System {};

FolderWatch::FolderWatch(const std::string& folder) : system_(nullptr) {
  throw InputError(folder + ": cannot be watched, this needs inotify (Linux)");
}

FolderWatch::~FolderWatch() = default;

std::optional<std::string> FolderWatch::next() {
  return std::nullopt;
}

#endif

bool FolderWatch::hasMissed() {
  const bool missed = missed_;
  missed_ = false;
  return missed;
}

}  // namespace pcl_symmetry::apps
