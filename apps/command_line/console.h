/// Messages of a tool to its user: PCL's `[done, 12.3 ms : 10000 points]` lines, and a progress bar on a terminal.
#pragma once

#include <optional>
#include <string>

#include "core/base/parallel.h"
#include "core/base/stopwatch.h"

namespace pcl_symmetry::apps {

/// Messages go to standard error, so that standard output carries results only.
class Console {
public:
  explicit Console(bool quiet = false) : quiet_(quiet) {}

  bool quiet() const { return quiet_; }

  /// One line of information. Silent when quiet.
  void info(const std::string& line) const;

  /// A warning, one line. Silent when quiet.
  void warn(const std::string& line) const;

  /// A failure that does not stop the rest, one line. Printed also when quiet.
  void error(const std::string& line) const;

private:
  bool quiet_;
};

/// One step of a tool, whose progress a terminal shows: prints "Loading a.pcd " when it begins and "[done, 12.3 ms :
/// 10000 points]" when it is done; a step that is left by an exception ends its line with "[failed]".
class Step {
public:
  Step(const Console& console, const std::string& what);
  ~Step();
  Step(const Step&) = delete;
  Step& operator=(const Step&) = delete;

  /// Redraws the bar; nothing happens unless standard error is a terminal.
  /// \param fraction in [0, 1]
  void progress(double fraction);

  /// \param result e.g. "10000 points"; empty for the time alone
  /// \return milliseconds since the step began
  double done(const std::string& result = "");

private:
  void clearBar();
  void draw(double fraction);

  bool quiet_;
  bool terminal_;
  bool open_ = true;
  int drawn_ = -1;
  std::string what_;
  bool told_ = false;  ///< progress() was called: progress of loops is ignored
  Stopwatch time_;
  std::optional<ProgressMonitor> loops_;
};

}  // namespace pcl_symmetry::apps
