/// Files of symmetries: models_info.json of the BOP benchmark, model_info.json of DOPE's data generation, and the
/// strings such as "z_180" and "x_full" that Isaac ROS takes for FoundationPose.
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "command_line/tool_errors.h"
#include "pcl_symmetry/core/rotation_group.h"
#include "pcl_symmetry/core/rotational_symmetry.h"

namespace pcl_symmetry::apps {

/// Symmetries as a file lists them: they form a group only if its author ensured it.
struct ListedSymmetries {
  std::vector<Eigen::Isometry3d> discrete;     ///< unit and frame of the model, with or without the identity
  std::vector<ContinuousSymmetry> continuous;  ///< unit axes
  bool is_composed = false;                    ///< whether readers of the file compose all that it lists
};

/// Symmetries as BOP's files list them. A sphere becomes one axis and enough tilts of it to reach any rotation.
/// \param sphere_angle radians, in (0, pi]: every rotation is within it of a composition of a rotation about the axis
/// and a tilt.
ListedSymmetries bopSymmetries(const ObjectSymmetries& symmetries, double sphere_angle);

/// \return the axes of the rotations of a group, without the identity.
std::vector<RotationAxis> axesOf(const std::vector<Eigen::Isometry3d>& motions);

/// The fields symmetries_discrete (4 x 4 row by row) and symmetries_continuous (axis and offset); empty ones are left
/// out.
nlohmann::ordered_json symmetriesJson(const ListedSymmetries& listed);

/// An entry for DOPE: the same fields, and align_axes, by which it selects one of the poses that look the same: the
/// main axis of the object upright in the image, a line perpendicular to it toward the camera.
nlohmann::ordered_json dopeJson(const ObjectSymmetries& symmetries, double sphere_angle);

/// Reads models_info.json, or a file of one model.
/// \return symmetries by the number of the model; for a file of one model, under an empty name.
/// \throws InputError naming the file, the entry, field, value and rule.
std::map<std::string, ListedSymmetries> readModelsInfo(const std::string& path);

/// The parameter symmetry_axes: rotations about x, y and z by an angle in degrees, or by any angle ("full"). Isaac
/// composes one rotation about each axis, and rotates about the origin of the mesh.
struct IsaacAxes {
  std::vector<std::string> axes;
  bool is_complete = true;  ///< false if the group has rotations that are not composed of rotations about x, y and z
};

/// \param symmetries axes up to 5 degrees off a coordinate axis count as that one.
IsaacAxes isaacAxes(const ObjectSymmetries& symmetries);

/// A YAML line `name: ["z_90", "z_180", "z_270"]`.
std::string isaacLine(const std::string& name, const std::vector<std::string>& axes);

/// Reads lines such as isaacLine() writes, one for each model, or the parameter `symmetry_axes: [...]` of a ROS file.
/// \return symmetries by the number of the model; symmetry_axes are under an empty name.
/// \throws InputError naming the file and the rule.
std::map<std::string, ListedSymmetries> readIsaacAxes(const std::string& path);

}  // namespace pcl_symmetry::apps
