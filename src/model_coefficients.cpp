#include "pcl_symmetry/model_coefficients.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "pcl_symmetry/impl/cloud_conversion.hpp"

namespace pcl_symmetry {

namespace {

void checkCoefficients(const pcl::ModelCoefficients& coefficients, std::size_t size, std::size_t first_of_direction) {
  const std::vector<float>& values = coefficients.values;
  if (values.size() != size)
    detail::throwBadArgument("number of coefficients = " + std::to_string(values.size()) + ", must be " +
                             std::to_string(size));
  if (!std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); }))
    detail::throwBadArgument("coefficients: a value is not finite, all must be");
  if (Eigen::Map<const Eigen::Vector3f>(values.data() + first_of_direction).isZero(0.0f))
    detail::throwBadArgument("direction of the coefficients = 0 0 0, must not be zero");
}

}  // namespace

pcl::ModelCoefficients toModelCoefficients(const ReflectionPlane& plane) {
  const Eigen::Vector4f values = plane.coefficients().cast<float>();
  pcl::ModelCoefficients coefficients;
  coefficients.values.assign(values.data(), values.data() + values.size());
  return coefficients;
}

pcl::ModelCoefficients toModelCoefficients(const SymmetryAxis& axis) {
  Eigen::Matrix<float, 6, 1> values;
  values << axis.point.cast<float>(), axis.direction.cast<float>();
  pcl::ModelCoefficients coefficients;
  coefficients.values.assign(values.data(), values.data() + values.size());
  return coefficients;
}

ReflectionPlane planeFromModelCoefficients(const pcl::ModelCoefficients& coefficients) {
  checkCoefficients(coefficients, 4, 0);
  return ReflectionPlane::fromCoefficients(
      Eigen::Map<const Eigen::Vector4f>(coefficients.values.data()).cast<double>());
}

SymmetryAxis axisFromModelCoefficients(const pcl::ModelCoefficients& coefficients) {
  checkCoefficients(coefficients, 6, 3);
  SymmetryAxis axis;
  axis.point = Eigen::Map<const Eigen::Vector3f>(coefficients.values.data()).cast<double>();
  axis.direction = Eigen::Map<const Eigen::Vector3f>(coefficients.values.data() + 3).cast<double>().normalized();
  return axis;
}

}  // namespace pcl_symmetry
