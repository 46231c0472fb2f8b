/// A tool run as its users run it.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "tools/temporary_folder.h"

/// \return the path of a tool.
/// \param name without the common beginning, e.g. "planes".
inline std::string toolPath(const std::string& name) {
  return std::string(TOOLS_FOLDER) + "/pcl_symmetry_" + name;
}

class ToolTest : public testing::Test {
protected:
  explicit ToolTest(std::string tool) : tool_(std::move(tool)) {}

  /// \return the exit code; what the tool printed is in output_ and error_ then.
  int run(const std::string& arguments) {
    const std::string command = tool_ + " " + arguments + " >" + (folder_ / "stdout") + " 2>" + (folder_ / "stderr");
    const int status = std::system(command.c_str());
    output_ = contentOf(folder_ / "stdout");
    error_ = contentOf(folder_ / "stderr");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  const TemporaryFolder folder_;
  std::string output_, error_;

private:
  std::string tool_;
};
