/// Reads PLY files.
///
/// Not by pcl::PLYReader: it knows few types of lists, mixes up colors that stand before the coordinates, and ends the
/// program on files that promise what they do not hold.
#pragma once

#include "io/cloud_file.h"

namespace pcl_symmetry::apps {

/// Reads vertices with properties of any type and order, faces, strips of triangles, and the camera as PCL writes it.
/// Properties have the names of PCL: normal_x for nx, rgb for red, green and blue.
/// \param path in errors.
/// \param text the whole file, ascii or binary of either byte order.
/// \throws InputError naming the element, the property and the rule.
CloudFile readPLY(const std::string& path, std::string_view text);

}  // namespace pcl_symmetry::apps
