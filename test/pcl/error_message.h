/// What the PCL classes say about wrong parameters.
#pragma once

#include <pcl/exceptions.h>

#include "shapes/complaint.h"

namespace pcl_symmetry::test {

template <typename Body>
std::string messageOf(const Body& body) {
  return complaintOf<pcl::BadArgumentException>(body);
}

}  // namespace pcl_symmetry::test
