/// The kinds of files that hold shapes.
#pragma once

namespace pcl_symmetry::apps {

/// The endings of files that loadShape() reads, for help and messages.
inline const char* const kShapeFiles = ".pcd, .ply, .obj, .stl, .off, .xyz or .glb";

}  // namespace pcl_symmetry::apps
