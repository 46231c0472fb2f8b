/// Reads binary glTF.
///
/// Not by Assimp: it takes the memory that a header asks for, whatever the file holds, and follows nodes in a circle.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace pcl_symmetry::apps {

struct GLBShape {
  std::vector<Eigen::Vector3d> vertices;  ///< in the frame of the scene; those of exactly equal coordinates are one
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of the vertices
};

/// The triangles of the scene of a .glb file, also of strips and fans; the vertices of a scene without triangles.
/// \param path glTF 2.0 whose values stand in the file itself, not compressed.
/// \throws InputError naming the field and the rule, where counts do not agree with the file.
GLBShape readGLB(const std::string& path);

}  // namespace pcl_symmetry::apps
