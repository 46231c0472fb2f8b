/// Looks through PLY files before PCL's reader does: that crashes on files that promise what they do not hold.
#pragma once

#include <Eigen/Geometry>
#include <string>

namespace pcl_symmetry::apps {

/// What PCL's reader does not tell about a PLY file: whether it is a mesh, and the camera, which PCL writes but loses.
struct PLYSummary {
  bool has_faces = false;
  Eigen::Vector4f sensor_origin = Eigen::Vector4f::Zero();
  Eigen::Quaternionf sensor_orientation = Eigen::Quaternionf::Identity();
};

/// Checks that x, y and z are there, that sizes and counts agree with each other and with the file, and, for text, that
/// every value is a number; the lengths of all lists are followed to the end of the file.
/// \throws InputError naming the field, its value and the rule.
PLYSummary checkPLY(const std::string& path);

/// \return whether a file that was just written holds all that its header promises.
bool isWholePLY(const std::string& path);

}  // namespace pcl_symmetry::apps
