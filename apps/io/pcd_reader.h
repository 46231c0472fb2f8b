/// Reads PCD files.
///
/// Not by pcl::PCDReader: its library takes longer to load (30 ms) than a tool takes to find planes, and it crashes on
/// files that promise what they do not hold.
#pragma once

#include "io/cloud_file.h"

namespace pcl_symmetry::apps {

/// Reads a PCD file with fields x, y and z: ascii, binary or binary_compressed.
/// \param path in errors.
/// \param text the whole file.
/// \throws InputError naming the field, its value and the rule, where sizes and counts do not agree with each other and
/// with the file, or where text holds what is no number.
CloudFile readPCD(const std::string& path, std::string_view text);

}  // namespace pcl_symmetry::apps
