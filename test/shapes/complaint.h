/// What errors say.
#pragma once

#include <string>

namespace pcl_symmetry::test {

/// \return the message of the error that \p body throws.
template <typename Error, typename Body>
std::string complaintOf(const Body& body) {
  try {
    body();
  } catch (const Error& error) {
    return error.what();
  }
  return "no exception";
}

}  // namespace pcl_symmetry::test
