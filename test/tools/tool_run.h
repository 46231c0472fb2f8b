/// A tool run as its users run it.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "shapes/temporary_folder.h"

/// \return the path of a tool.
/// \param name without the common beginning, e.g. "planes".
inline std::string toolPath(const std::string& name) {
  return std::string(TOOLS_FOLDER) + "/pcl_symmetry_" + name;
}

/// \return the lines of a text, each of which is JSON.
inline std::vector<nlohmann::json> jsonLines(const std::string& text) {
  std::vector<nlohmann::json> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(nlohmann::json::parse(line));
  return lines;
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

  /// Runs a tool that must not fail. \return what it reports.
  nlohmann::json reportOf(const std::string& arguments) {
    EXPECT_EQ(run(arguments + " -json " + (folder_ / "report.json")), 0) << error_;
    return nlohmann::json::parse(contentOf(folder_ / "report.json"));
  }

  /// \return whether the tool ends with this exit code and these words among its errors.
  testing::AssertionResult fails(const std::string& arguments, int code, const std::string& words) {
    const int ended = run(arguments);
    if (ended == code && error_.find(words) != std::string::npos) return testing::AssertionSuccess();
    return testing::AssertionFailure() << arguments << ": exit code " << ended << ", " << error_;
  }

  const TemporaryFolder folder_;
  std::string output_, error_;

private:
  std::string tool_;
};
