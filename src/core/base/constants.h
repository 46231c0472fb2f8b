#pragma once

namespace pcl_symmetry {

constexpr double kPi = 3.14159265358979323846;  ///< pi, rounded to double
constexpr double kDegree = kPi / 180.0;         ///< radians; one degree

}  // namespace pcl_symmetry
