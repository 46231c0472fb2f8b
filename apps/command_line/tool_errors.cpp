#include "command_line/tool_errors.h"

#include <fcntl.h>
#include <pcl/console/print.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem/path.hpp>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <vector>

namespace pcl_symmetry::apps {

namespace {

std::string oneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  boost::algorithm::trim(text);
  return text;
}

/// A random password that clients of an X server need, in the form of a file without a name.
/// \return its descriptor, from which the server and the clients read.
int secretOfServer() {
  unsigned char cookie[16];
  if (::getentropy(cookie, sizeof(cookie)) != 0) return -1;
  const int file = ::memfd_create("Xauthority", 0);
  const std::string name = "MIT-MAGIC-COOKIE-1";
  // Valid for any host (0xffff) and any display (an empty number).
  std::string entry("\xff\xff\0\0\0\0\0\x12", 8);
  entry += name + std::string("\0\x10", 2) + std::string(cookie, cookie + sizeof(cookie));
  return ::write(file, entry.data(), entry.size()) == static_cast<ssize_t>(entry.size()) ? file : -1;
}

}  // namespace

void findDisplay() {
  if (std::getenv("DISPLAY")) return;
  int number[2];
  const int secret = secretOfServer();
  if (secret < 0 || ::pipe(number) != 0) return;
  const std::string authority = "/proc/self/fd/" + std::to_string(secret), to = std::to_string(number[1]);
  const pid_t tool = ::getpid(), server = ::fork();
  if (server == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != tool) ::_exit(0);
    const int nowhere = ::open("/dev/null", O_RDWR);
    for (const int stream : {0, 1, 2}) ::dup2(nowhere, stream);
    ::execlp("Xvfb", "Xvfb", "-displayfd", to.c_str(), "-screen", "0", "1280x1024x24", "-nolisten", "tcp", "-auth",
             authority.c_str(), nullptr);
    ::_exit(1);
  }
  ::close(number[1]);
  std::string display;
  for (char digit; ::read(number[0], &digit, 1) == 1 && digit != '\n';) display += digit;
  ::close(number[0]);
  if (display.empty()) return;
  ::setenv("DISPLAY", (":" + display).c_str(), 1);
  ::setenv("XAUTHORITY", authority.c_str(), 1);
}

int runTool(int argc, char** argv, const std::function<int(int, char**)>& body) {
  const std::string tool = argc > 0 ? boost::filesystem::path(argv[0]).filename().string() : "pcl_symmetry";
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  const auto fail = [&tool](const std::string& message, int code) {
    std::cerr << tool << ": " << oneLine(message) << std::endl;
    return code;
  };
  try {
    return body(argc, argv);
  } catch (const UsageError& error) {
    return fail(std::string(error.what()) + " (see " + tool + " -h)", 2);
  } catch (const std::bad_alloc&) {
    return fail("not enough memory", 1);
  } catch (const pcl::PCLException& error) {
    return fail(plainMessage(error), 1);
  } catch (const std::exception& error) {
    return fail(error.what(), 1);
  } catch (...) {
    return fail("stopped by an error of unknown type", 1);
  }
}

}  // namespace pcl_symmetry::apps
