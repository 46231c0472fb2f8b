#include "io/answers.h"

namespace pcl_symmetry::apps {

nlohmann::json rotationsJson(const std::vector<SymmetryRotation>& rotations, const Eigen::Vector3d& shift) {
  nlohmann::json json = nlohmann::json::array();
  for (const SymmetryRotation& rotation : rotations) {
    json.push_back(axisJson(rotation, shift));
    json.back().update({{"fold", rotation.fold},
                        {"support", rotation.support},
                        {"off", rotation.off},
                        {"far", rotation.far},
                        {"halfway", rotation.halfway}});
  }
  return json;
}

nlohmann::json frameJson(const SymmetryFrame& frame, const Eigen::Vector3d& shift) {
  nlohmann::json json{{"center", numbersOf(shiftedBack(frame.center, shift))},
                      {"axes", nlohmann::json::array()},
                      {"scores", numbersOf(frame.scores)},
                      {"revolution_axis", frame.revolution_axis},
                      {"transform", rowMajor(shiftedBack(frame.T_canonical_input, shift, Eigen::Vector3d::Zero()))}};
  for (int k = 0; k < 3; ++k) json["axes"].push_back(numbersOf(frame.axes.col(k)));
  return json;
}

std::string matrixLines(const Eigen::Isometry3d& motion, int digits) {
  std::string lines;
  for (int row = 0; row < 4; ++row)
    lines += formatted("%12.6f %12.6f %12.6f %12.*g\n", motion(row, 0), motion(row, 1), motion(row, 2), digits,
                       motion(row, 3));
  return lines;
}

}  // namespace pcl_symmetry::apps
