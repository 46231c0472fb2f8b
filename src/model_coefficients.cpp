#include "pcl_symmetry/model_coefficients.h"

namespace pcl_symmetry {

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

}  // namespace pcl_symmetry
