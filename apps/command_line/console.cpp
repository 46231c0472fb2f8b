#include "command_line/console.h"

#include <pcl/console/print.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace pcl_symmetry::apps {

namespace {

constexpr int kBarWidth = 30;  // characters

void printColored(const std::string& text, int attribute, int color, bool terminal) {
  if (terminal) pcl::console::change_text_color(stderr, attribute, color);
  std::fputs(text.c_str(), stderr);
  if (terminal) pcl::console::reset_text_color(stderr);
}

}  // namespace

void Console::info(const std::string& line) const {
  if (!quiet_) std::fprintf(stderr, "%s\n", line.c_str());
}

void Console::warn(const std::string& line) const {
  if (quiet_) return;
  printColored("warning: ", pcl::console::TT_BRIGHT, pcl::console::TT_YELLOW, isatty(STDERR_FILENO));
  std::fprintf(stderr, "%s\n", line.c_str());
}

void Console::error(const std::string& line) const {
  printColored("error: ", pcl::console::TT_BRIGHT, pcl::console::TT_RED, isatty(STDERR_FILENO));
  std::fprintf(stderr, "%s\n", line.c_str());
}

Step::Step(const Console& console, const std::string& what)
    : quiet_(console.quiet()), terminal_(isatty(STDERR_FILENO)), what_(what) {
  if (quiet_) return;
  std::fprintf(stderr, "%s ", what_.c_str());
  std::fflush(stderr);
  if (terminal_)
    loops_.emplace([this](double share) {
      if (!told_) draw(share);
    });
}

Step::~Step() {
  if (quiet_ || !open_) return;
  clearBar();
  std::fputs("[failed]\n", stderr);
}

void Step::clearBar() {
  if (drawn_ >= 0) std::fprintf(stderr, "\r\033[K%s ", what_.c_str());
  drawn_ = -1;
}

void Step::progress(double fraction) {
  told_ = true;
  draw(fraction);
}

void Step::draw(double fraction) {
  if (quiet_ || !terminal_ || !open_) return;
  const int percent = static_cast<int>(100.0 * std::clamp(fraction, 0.0, 1.0));
  if (percent == drawn_) return;
  const int filled = percent * kBarWidth / 100;
  std::fprintf(stderr, "\r%s [%s%s] %3d %%", what_.c_str(), std::string(filled, '=').c_str(),
               std::string(kBarWidth - filled, ' ').c_str(), percent);
  std::fflush(stderr);
  drawn_ = percent;
}

double Step::done(const std::string& result) {
  const double elapsed = time_.lap();
  if (!quiet_ && open_) {
    clearBar();
    char time[32];
    std::snprintf(time, sizeof(time), "%.1f", elapsed);
    std::fputs("[done, ", stderr);
    printColored(time, pcl::console::TT_RESET, pcl::console::TT_CYAN, terminal_);
    std::fputs(" ms", stderr);
    if (!result.empty()) std::fprintf(stderr, " : %s", result.c_str());
    std::fputs("]\n", stderr);
  }
  open_ = false;
  return elapsed;
}

}  // namespace pcl_symmetry::apps
