/// Motions as (4, 4) arrays of NumPy.
#pragma once

#include <pybind11/numpy.h>

#include <Eigen/Geometry>
#include <stdexcept>
#include <string>
#include <vector>

namespace pcl_symmetry::python {

using RowMajor4 = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

/// The motions as one (K, 4, 4) array.
inline pybind11::array_t<double> stacked(const std::vector<Eigen::Isometry3d>& motions) {
  pybind11::array_t<double> result(
      {static_cast<pybind11::ssize_t>(motions.size()), pybind11::ssize_t{4}, pybind11::ssize_t{4}});
  for (std::size_t i = 0; i < motions.size(); ++i)
    Eigen::Map<RowMajor4>(result.mutable_data() + 16 * i) = motions[i].matrix();
  return result;
}

/// \param name name of the parameter, for messages.
/// \throws std::invalid_argument if the matrix is not a rigid motion.
inline Eigen::Isometry3d motionOf(const std::string& name, const RowMajor4& matrix) {
  Eigen::Isometry3d motion;
  motion.matrix() = matrix;
  // Poses of float32 pass; shears and reflections do not.
  if (!motion.linear().isUnitary(1e-6) || motion.linear().determinant() < 0.0 ||
      !matrix.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1)))
    throw std::invalid_argument(name + " = another matrix, must be a rotation and a translation, (4, 4)");
  return motion;
}

}  // namespace pcl_symmetry::python
