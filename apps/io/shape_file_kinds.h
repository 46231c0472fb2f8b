/// The kinds of files that hold shapes.
#pragma once

#include <string>

namespace pcl_symmetry::apps {

/// The endings of files that loadShape() reads, for help and messages.
inline const char* const kShapeFiles = ".pcd, .ply, .obj, .stl, .off, .glb, .xyz, .pts, .asc, .txt or .csv";

/// Those that are taken from folders, where .txt and .csv hold many other things.
inline const char* const kShapeFilesOfFolders = ".pcd, .ply, .obj, .stl, .off, .glb, .xyz, .pts or .asc";

/// \return whether files of this ending hold a point on each line.
inline bool isColumnFile(const std::string& extension) {
  return extension == ".xyz" || extension == ".pts" || extension == ".asc" || extension == ".txt" ||
         extension == ".csv";
}

}  // namespace pcl_symmetry::apps
