#pragma once

#include <pcl/ModelCoefficients.h>

#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/exports.h"

/// Planes and axes of symmetry as models of PCL's segmentation. The header of the coefficients is left empty.
namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// \return [a, b, c, d] of a x + b y + c z + d = 0 with a unit normal (pcl::SACMODEL_PLANE), in float.
inline pcl::ModelCoefficients toModelCoefficients(const ReflectionPlane& plane) {
  const Eigen::Vector4f values = plane.coefficients().cast<float>();
  pcl::ModelCoefficients coefficients;
  coefficients.values.assign(values.data(), values.data() + values.size());
  return coefficients;
}

/// \return [point, direction], six values (pcl::SACMODEL_LINE), in float.
inline pcl::ModelCoefficients toModelCoefficients(const SymmetryAxis& axis) {
  Eigen::Matrix<float, 6, 1> values;
  values << axis.point.cast<float>(), axis.direction.cast<float>();
  pcl::ModelCoefficients coefficients;
  coefficients.values.assign(values.data(), values.data() + values.size());
  return coefficients;
}

}  // namespace pcl_symmetry
