/// Reads the Object File Format of Geomview, text flavour, strictly.
#pragma once

#include <string>
#include <string_view>

#include "io/exact_coordinates.h"

namespace pcl_symmetry::apps {

/// Headers OFF, COFF, NOFF, CNOFF, STOFF and so on are understood, also with the counts on the same line or without any
/// keyword; normals, colours and texture coordinates are read over. Faces of fewer than three corners are left out.
/// \throws InputError naming the first value that is missing or wrong.
ExactShape readOFF(const std::string& path, std::string_view text);

}  // namespace pcl_symmetry::apps
