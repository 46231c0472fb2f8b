/// What the PCL classes say about wrong parameters.
#pragma once

#include <pcl/exceptions.h>

#include <string>

namespace pcl_symmetry::test {

/// The message of the pcl::BadArgumentException that \p body throws.
template <typename Body>
std::string messageOf(const Body& body) {
  try {
    body();
  } catch (const pcl::BadArgumentException& error) {
    return error.what();
  }
  return "no exception";
}

}  // namespace pcl_symmetry::test
