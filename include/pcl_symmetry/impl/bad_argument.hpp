#pragma once

#include <pcl/exceptions.h>

#include <stdexcept>

namespace pcl_symmetry {

/// Calls \p body; what the core refuses with std::invalid_argument reaches PCL users as pcl::BadArgumentException.
template <typename Body>
auto withBadArguments(const Body& body) {
  try {
    return body();
  } catch (const std::invalid_argument& error) {
    PCL_THROW_EXCEPTION(pcl::BadArgumentException, error.what());
  }
}

}  // namespace pcl_symmetry
