/// Readers of shape files, a function for each format, which converts the text of a whole file to a shape.
///
/// PCD and PLY files are not read by PCL: its library takes longer to load (30 ms) than a tool takes to find planes,
/// and its readers crash on files that hold less than their headers announce; the reader of PLY knows few types of
/// lists and mixes up colors that precede the coordinates.
#pragma once

#include <string>
#include <string_view>

#include "io/cloud_file.h"
#include "io/exact_coordinates.h"

namespace pcl_symmetry::apps {

// All receive the path for their messages and the whole file, and throw InputError naming the position in the file,
// what is there, and the rule.

/// A PCD file with fields x, y and z: ascii, binary or binary_compressed.
CloudFile readPCD(const std::string& path, std::string_view text);

/// Vertices of a PLY file with properties of any type and order, faces, strips of triangles, and the camera as PCL
/// writes it; ascii or binary of either byte order. Properties have the names of PCL: normal_x for nx, rgb for red,
/// green and blue.
CloudFile readPLY(const std::string& path, std::string_view text);

/// The Object File Format of Geomview as text. Headers OFF, COFF, NOFF, CNOFF, STOFF and so on are accepted, also with
/// the counts on the same line or without any keyword; normals, colors and texture coordinates are skipped. Faces of
/// fewer than three corners are left out.
ExactShape readOFF(const std::string& path, std::string_view text);

/// Vertices and faces of a Wavefront .obj file; normals and texture coordinates are skipped, even if a face names some
/// that do not exist. Vertices of a file without faces are points; in a mesh, vertices of equal coordinates are merged.
ExactShape readOBJ(const std::string& path, std::string_view text);

/// Text with a point on each line: .xyz, .txt, .csv, .pts and .asc files. Columns are separated by blanks, commas or
/// semicolons; with semicolons, a comma is the decimal sign. If a line before the first point names columns x, y and z,
/// these are read, otherwise the first three that hold numbers. A single number before the points is their number.
/// Lines that begin with # or // are comments.
ExactShape readColumns(const std::string& path, std::string_view text);

/// The triangles of an STL file, binary or text; corners of equal coordinates are merged. If the count of a binary file
/// does not match its size, as with programs that write it too early, the size is used.
ExactShape readSTL(const std::string& path, std::string_view content);

/// \return whether the content is a binary STL file whose count matches its size.
bool isBinarySTL(std::string_view content);

/// The triangles of the scene of a .glb file in its frame, by Assimp, or the vertices of a scene without triangles;
/// vertices of equal coordinates are merged. In the module pcl_symmetry_mesh_files.
extern "C" void readGLB(const std::string& path, const std::string& content, ExactShape& shape);

}  // namespace pcl_symmetry::apps
