/// Reads plain columns: a point on each line.
#pragma once

#include <string>

#include "io/exact_coordinates.h"

namespace pcl_symmetry::apps {

/// Lines of three numbers x y z or more, of which only the first three are read; `#` begins a comment.
/// \throws InputError naming the first value that is missing or wrong
ExactShape readXYZ(const std::string& path);

}  // namespace pcl_symmetry::apps
