/// Reads text with a point on each line: .xyz, .txt, .csv, .pts and .asc files.
#pragma once

#include <string>
#include <string_view>

#include "io/exact_coordinates.h"

namespace pcl_symmetry::apps {

/// Columns stand between blanks, commas or semicolons; between semicolons a comma is the decimal sign. Where a line
/// before the first point names columns x, y and z, these are read, otherwise the first three that hold numbers. A
/// single number before the points is how many there are. Lines that begin with # or // are comments.
/// \param path in errors.
/// \param text the whole file.
/// \throws InputError naming the line and what is wrong with it
ExactShape readColumns(const std::string& path, std::string_view text);

}  // namespace pcl_symmetry::apps
