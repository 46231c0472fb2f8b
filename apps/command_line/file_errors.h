/// Errors of the library become errors that name the file at fault.
#pragma once

#include <pcl/exceptions.h>

#include <exception>
#include <new>
#include <string>

#include "command_line/tool_errors.h"

namespace pcl_symmetry::apps {

/// \return the message of an exception of PCL without the names of function and source file that PCL puts before it
std::string plainMessage(const pcl::PCLException& error);

/// Calls the body.
/// \return what it returns
/// \throws InputError `path: what is wrong` for what the library throws; never the name of a function or source file
template <typename Body>
auto namingFile(const std::string& path, const Body& body) -> decltype(body()) {
  try {
    return body();
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw InputError(path + ": is too large for the memory of this machine");
  } catch (const pcl::PCLException& error) {
    throw InputError(path + ": " + plainMessage(error));
  } catch (const std::exception& error) {
    throw InputError(path + ": " + error.what());
  }
}

}  // namespace pcl_symmetry::apps
