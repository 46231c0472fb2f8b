#include "command_line/tool_errors.h"

#include <pcl/console/print.h>
#include <pcl/exceptions.h>
#include <unistd.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem/path.hpp>
#include <cstdlib>
#include <iostream>
#include <new>
#include <sstream>
#include <vector>

namespace pcl_symmetry::apps {

namespace {

std::string oneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  boost::algorithm::trim(text);
  return text;
}

/// VTK draws through an X server. Where there is none, a tool that is to write a picture starts again within xvfb-run,
/// which starts one; without xvfb-run it goes on, and what draws says what is missing.
void findDisplay(int argc, char** argv) {
  const auto isPicture = [](const char* argument) { return boost::algorithm::iends_with(argument, ".png"); };
  if (std::getenv("DISPLAY") || std::none_of(argv + 1, argv + argc, isPicture)) return;
  std::vector<char*> command;
  static char program[] = "xvfb-run", any_number[] = "-a";
  command.insert(command.end(), {program, any_number});
  command.insert(command.end(), argv, argv + argc);
  command.push_back(nullptr);
  ::execvp(program, command.data());
}

}  // namespace

std::string plainMessage(const pcl::PCLException& error) {
  const std::string text = error.what();
  // As PCLException::createDetailedMessage() puts it together.
  std::ostringstream prefix;
  if (error.getFunctionName()) prefix << error.getFunctionName() << " ";
  if (error.getFileName()) {
    prefix << "in " << error.getFileName() << " ";
    if (error.getLineNumber() != 0) prefix << "@ " << error.getLineNumber() << " ";
  }
  prefix << ": ";
  return boost::algorithm::starts_with(text, prefix.str()) ? text.substr(prefix.str().size()) : text;
}

int runTool(int argc, char** argv, const std::function<int(int, char**)>& body) {
  if (argc > 1) findDisplay(argc, argv);
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
