/// Vectors, motions and times as the tools write them in JSON.
#pragma once

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace pcl_symmetry::apps {

/// JSON as text. Names of files are bytes: what is no UTF-8 is replaced, where nlohmann's default would throw.
/// \param indent blanks a level; -1: one line
template <typename Json>
std::string jsonText(const Json& json, int indent = 2) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

inline std::vector<double> numbersOf(const Eigen::VectorXd& v) {
  return {v.data(), v.data() + v.size()};
}

/// \return 16 numbers, row by row
inline std::vector<double> rowMajor(const Eigen::Matrix4d& matrix) {
  std::vector<double> numbers;
  for (int i = 0; i < 16; ++i) numbers.push_back(matrix(i / 4, i % 4));
  return numbers;
}

inline std::vector<double> rowMajor(const Eigen::Isometry3d& transform) {
  return rowMajor(transform.matrix());
}

inline nlohmann::json timingJson(const std::vector<std::pair<std::string, double>>& timing_ms) {
  nlohmann::json json = nlohmann::json::object();
  for (const auto& [stage, ms] : timing_ms) json[stage] = ms;
  return json;
}

}  // namespace pcl_symmetry::apps
