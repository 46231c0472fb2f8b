/// The errors that stop a tool, their exit codes, and the function that maps one to the other.
#pragma once

#include <pcl/exceptions.h>

#include <exception>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>

namespace pcl_symmetry::apps {

/// A file or its content that a tool cannot work with, or a result that cannot be written: exit code 1. The message is
/// one line and names the file, the field, the value and the rule.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A command line that does not make sense: exit code 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// \return the message of an exception of PCL without the names of function and source file that PCL puts before it
inline std::string plainMessage(const pcl::PCLException& error) {
  const std::string text = error.what();
  // As PCLException::createDetailedMessage() composes it: "FUNCTION in FILE @ LINE : MESSAGE".
  return error.getFileName() ? text.substr(text.find(": ") + 2) : text;
}

/// Calls the body.
/// \param before begin of what is wrong, for what the library throws
/// \return what it returns
/// \throws InputError `path: what is wrong` for what the library throws; never the name of a function or source file
template <typename Body>
auto namingFile(const std::string& path, const Body& body, const std::string& before = "") -> decltype(body()) {
  try {
    return body();
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw InputError(path + ": is too large for the memory of this machine");
  } catch (const pcl::PCLException& error) {
    throw InputError(path + ": " + before + plainMessage(error));
  } catch (const std::exception& error) {
    throw InputError(path + ": " + before + error.what());
  }
}

/// VTK draws through an X server. If there is none, a tool that is to write a picture starts one, which ends with the
/// tool, however that ends. If Xvfb is missing, the tool continues, and drawing reports the error. To be called before
/// there are threads: the server ends with the thread that starts it.
void findDisplay();

/// Runs the body of a tool and reports exceptions in one line on standard error and by an exit code: 0 done (or the
/// result of the body), 1 could not be done, 2 wrong usage.
int runTool(int argc, char** argv, const std::function<int(int argc, char** argv)>& body);

}  // namespace pcl_symmetry::apps
