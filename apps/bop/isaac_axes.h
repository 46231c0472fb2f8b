/// Symmetries as Isaac ROS takes them for FoundationPose: strings such as "z_180" and "x_full".
#pragma once

#include <map>
#include <string>
#include <vector>

#include "bop/models_info.h"

namespace pcl_symmetry::apps {

/// The parameter symmetry_axes: turns about x, y and z by an angle in degrees, or by any angle ("full"). Isaac composes
/// one turn about each axis, and turns about the origin of the mesh.
struct IsaacAxes {
  std::vector<std::string> axes;
  bool is_complete = true;  ///< false where the group has rotations that turns about x, y and z do not compose
};

/// \param symmetries axes up to 5 degrees off a coordinate axis count as this one.
IsaacAxes isaacAxes(const ObjectSymmetries& symmetries);

/// \return turns about the origin.
/// \throws InputError naming the string and the rule.
ListedSymmetries symmetriesFromIsaac(const std::vector<std::string>& axes, const std::string& where);

/// A YAML line `name: ["z_90", "z_180", "z_270"]`.
std::string isaacLine(const std::string& name, const std::vector<std::string>& axes);

/// Reads lines such as isaacLine() writes, one for each model, or the parameter `symmetry_axes: [...]` of a ROS file.
/// \return symmetries by the number of the model; those of symmetry_axes by an empty name.
/// \throws InputError naming the file and the rule.
std::map<std::string, ListedSymmetries> readIsaacAxes(const std::string& path);

}  // namespace pcl_symmetry::apps
