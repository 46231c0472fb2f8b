/// Readers of shape files, a function for each format: the whole file as text becomes a shape.
///
/// PCD and PLY are not read by PCL: its library takes longer to load (30 ms) than a tool takes to find planes, and its
/// readers crash on files that promise what they do not hold; that of PLY knows few types of lists and mixes up colors
/// that stand before the coordinates.
#pragma once

#include <string>
#include <string_view>

#include "io/cloud_file.h"
#include "io/exact_coordinates.h"

namespace pcl_symmetry::apps {

// All take the path for their errors and the whole file, and throw InputError naming the position in the file, what
// stands there, and the rule.

/// A PCD file with fields x, y and z: ascii, binary or binary_compressed.
CloudFile readPCD(const std::string& path, std::string_view text);

/// Vertices of a PLY file with properties of any type and order, faces, strips of triangles, and the camera as PCL
/// writes it; ascii or binary of either byte order. Properties have the names of PCL: normal_x for nx, rgb for red,
/// green and blue.
CloudFile readPLY(const std::string& path, std::string_view text);

/// The Object File Format of Geomview as text. Headers OFF, COFF, NOFF, CNOFF, STOFF and so on are understood, also
/// with the counts on the same line or without any keyword; normals, colors and texture coordinates are read over.
/// Faces of fewer than three corners are left out.
ExactShape readOFF(const std::string& path, std::string_view text);

/// Vertices and faces of a Wavefront .obj file; normals and texture coordinates are read over, also where a face names
/// some that are not there. Vertices of a file without faces are points; in a mesh those of equal coordinates are one.
ExactShape readOBJ(const std::string& path, std::string_view text);

/// Text with a point on each line: .xyz, .txt, .csv, .pts and .asc files. Columns stand between blanks, commas or
/// semicolons; between semicolons a comma is the decimal sign. Where a line before the first point names columns x, y
/// and z, these are read, otherwise the first three that hold numbers. A single number before the points is how many
/// there are. Lines that begin with # or // are comments.
ExactShape readColumns(const std::string& path, std::string_view text);

/// The triangles of an STL file, binary or text; corners of equal coordinates are one. Where the count of a binary file
/// is not that of its size, as of programs that write it too early, the size counts.
ExactShape readSTL(const std::string& path, std::string_view content);

/// \return whether the content is a binary STL file whose count is that of its size.
bool isBinarySTL(std::string_view content);

/// The triangles of the scene of a .glb file in its frame, by Assimp, or the vertices of a scene without triangles;
/// those of equal coordinates are one. In the module pcl_symmetry_mesh_files.
extern "C" void readGLB(const std::string& path, const std::string& content, ExactShape& shape);

}  // namespace pcl_symmetry::apps
