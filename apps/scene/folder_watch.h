/// Files that arrive in a folder, one after the other, until a signal ends the program.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>

namespace pcl_symmetry::apps {

/// Names files of a folder as soon as they are whole: when a program that wrote one closes it, or when one is moved
/// into the folder, also in place of another. Files that are there before are not named. SIGINT, SIGTERM and SIGHUP end
/// the wait, not the program, while an object of this class lives.
class FolderWatch {
public:
  /// \throws InputError naming the folder where it cannot be watched; this needs inotify (Linux).
  explicit FolderWatch(const std::string& folder);
  ~FolderWatch();
  FolderWatch(const FolderWatch&) = delete;
  FolderWatch& operator=(const FolderWatch&) = delete;

  /// Waits for the next file. A file that was written again before it is named is named once.
  /// \return its path; nothing once a signal has come.
  /// \throws InputError where the folder is gone.
  std::optional<std::string> next();

  /// \return whether files came faster than the system keeps their names, since the last call: some were missed.
  bool hasMissed();

private:
  struct System;

  void readEvents();

  std::string folder_;
  System* system_;
  std::deque<std::string> waiting_;
  bool missed_ = false;
};

}  // namespace pcl_symmetry::apps
