#include "pictures/private_display.h"

#include <X11/Xlib.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <thread>

namespace pcl_symmetry::apps {

namespace {

using Clock = std::chrono::steady_clock;
/// For an X server to start. chosen: half is short on a loaded machine, twice only delays the error message.
constexpr std::chrono::seconds kPatience{10};

bool canDraw(const char* name) {
  if (!name || !*name) return false;
  Display* display = XOpenDisplay(name);
  if (!display) return false;
  int opcode = 0, event = 0, error = 0;
  const bool has_opengl = XQueryExtension(display, "GLX", &opcode, &event, &error);
  XCloseDisplay(display);
  return has_opengl;
}

/// \return what the server wrote up to the end of its line, empty if it ended or took too long.
std::string readLine(int descriptor, Clock::time_point deadline) {
  std::string line;
  while (Clock::now() < deadline) {
    pollfd ready{descriptor, POLLIN, 0};
    if (poll(&ready, 1, 100) <= 0) continue;
    char c = 0;
    const ssize_t got = read(descriptor, &c, 1);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return "";
    if (c == '\n') return line;
    line += c;
  }
  return "";
}

/// Runs in the forked child, where only async-signal-safe calls are allowed.
[[noreturn]] void becomeServer(pid_t parent, int read_end, int write_end) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(127);
  close(read_end);
  const int null_device = open("/dev/null", O_RDWR);
  dup2(null_device, STDIN_FILENO);
  dup2(null_device, STDOUT_FILENO);
  dup2(null_device, STDERR_FILENO);
  if (write_end != 3) {
    dup2(write_end, 3);
    close(write_end);
  } else {
    fcntl(3, F_SETFD, 0);
  }
  setpgid(0, 0);
  // Without -noreset the server starts anew whenever its last client leaves, and turns away who comes meanwhile.
  execlp("Xvfb", "Xvfb", "-displayfd", "3", "-screen", "0", "1280x1024x24", "-nolisten", "tcp", "-noreset",
         "+extension", "GLX", static_cast<char*>(nullptr));
  _exit(127);
}

/// Servers that start at the same moment may choose the same number, and one of them goes down again with whoever is
/// connected to it: the tools of one user start theirs one after the other.
class StartLock {
public:
  StartLock() {
    const std::string path = "/tmp/.pcl_symmetry_display_" + std::to_string(getuid());
    descriptor_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
    if (descriptor_ >= 0) flock(descriptor_, LOCK_EX);
  }
  ~StartLock() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  StartLock(const StartLock&) = delete;
  StartLock& operator=(const StartLock&) = delete;

private:
  int descriptor_ = -1;
};

}  // namespace

bool hasDisplay() {
  return canDraw(std::getenv("DISPLAY"));
}

PrivateDisplay::PrivateDisplay() {
  const char* display = std::getenv("DISPLAY");
  if (canDraw(display)) return;
  had_display_ = display != nullptr;
  if (display) old_display_ = display;

  const StartLock lock;
  // A server that somebody else starts may still take the number. chosen: twice only delays the error message.
  constexpr int kNumAttempts = 4;
  for (int attempt = 0; attempt < kNumAttempts; ++attempt) {
    if (start()) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(50 << attempt));
  }
  throw InputError(
      "cannot draw: there is no display, and Xvfb is missing or does not start (Debian package xvfb); try xvfb-run");
}

bool PrivateDisplay::start() {
  int channel[2];
  if (pipe2(channel, O_CLOEXEC) != 0) return false;
  const pid_t parent = getpid();
  server_ = fork();
  if (server_ == 0) becomeServer(parent, channel[0], channel[1]);
  close(channel[1]);
  const std::string number = server_ > 0 ? readLine(channel[0], Clock::now() + kPatience) : "";
  close(channel[0]);
  const std::string name = ":" + number;
  if (number.empty() || !canDraw(name.c_str())) {
    stop();
    return false;
  }
  setenv("DISPLAY", name.c_str(), 1);
  return true;
}

PrivateDisplay::~PrivateDisplay() {
  if (!started()) return;
  stop();
  if (had_display_) {
    setenv("DISPLAY", old_display_.c_str(), 1);
  } else {
    unsetenv("DISPLAY");
  }
}

void PrivateDisplay::stop() {
  if (server_ <= 0) return;
  kill(server_, SIGTERM);
  const Clock::time_point deadline = Clock::now() + std::chrono::seconds(2);
  while (waitpid(server_, nullptr, WNOHANG) == 0) {
    if (Clock::now() > deadline) {
      kill(server_, SIGKILL);
      waitpid(server_, nullptr, 0);
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  server_ = -1;
}

}  // namespace pcl_symmetry::apps
