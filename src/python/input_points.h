/// Arrays of NumPy as points of the core.
#pragma once

#include <pybind11/numpy.h>

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <vector>

#include "core/base/options.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry::python {

/// What numpy.asarray() accepts: arrays, which are not copied, lists, and objects of other libraries that hold numbers.
struct AnyArray {
  pybind11::array array;
  operator const pybind11::array&() const { return array; }
};

/// \throws std::invalid_argument naming the parameter if the object is not like an array.
pybind11::array arrayOf(const char* name, const pybind11::object& object);

/// \param faces indices into the vertices: (F, 3) or more, or lists, which may be of different lengths.
/// \throws std::invalid_argument for another shape, and for invalid indices.
std::vector<std::vector<int>> polygonsOf(const pybind11::object& faces);

/// The points of an array that an analysis uses.
///
/// Rows of float32 are used in place, without a copy, if all of them are used. Other rows are copied: rows of other
/// types, all rows of an array in which some are not finite, and one of each of max_points equal runs of a larger
/// array.
class InputPoints {
public:
  /// \param name name of the parameter, for messages.
  /// \param array (N, 3), rows in input units.
  /// \param max_points greatest number of points; 0 = all.
  /// \throws std::invalid_argument for another shape, and for numbers that float32 would round by more than 1e-4 of the
  /// extent of the points.
  InputPoints(const char* name, const pybind11::array& array, std::size_t max_points, std::uint64_t seed);

  /// \return 3 x M points, valid as long as this object lives.
  PointsRef points() const;
  /// \return number of rows of the array.
  std::size_t numRows() const { return num_rows_; }
  /// \return whether all rows are finite and used.
  bool usesAllRows() const { return static_cast<std::size_t>(points().cols()) == num_rows_; }
  /// \return the row of each point; empty if all rows are used, or none.
  const std::vector<std::size_t>& rows() const { return rows_; }

  /// \param normals (N, 3).
  /// \return the normals of the points, 3 x M.
  Points atPoints(const char* name, const pybind11::array& normals) const;

private:
  pybind11::array_t<float, pybind11::array::forcecast> array_;  // keeps the memory alive
  std::size_t num_rows_ = 0;
  std::vector<std::size_t> rows_;
  Points copied_ = Points(3, 0);
};

/// Tells which points hold no answer, and why. The package warns of it where the C++ classes have a reason.
struct NoAnswer : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// To be called once all parameters were checked: a bad parameter is refused whatever the points are.
/// \throws NoAnswer if whyUnanswerable() has a reason.
void checkAnswerable(const char* name, const PointsRef& points);

/// Viewpoint stored in a file: it counts if the points can have been seen from there.
struct StoredViewpoint {
  Eigen::Vector3d position;
};

/// \param viewpoint where the scanner stood: "auto" (the points decide), a StoredViewpoint, or x, y, z.
/// \return the position; nothing for the first two.
/// \throws std::invalid_argument for another value.
std::optional<Eigen::Vector3d> positionOf(const pybind11::object& viewpoint);

/// \param viewpoint as in positionOf(), None, or the Visibility of an organized array.
/// \return what the scanner saw; nothing without a viewpoint.
/// \throws std::invalid_argument for another value, and if the points surround the viewpoint.
std::optional<Visibility> seenFrom(const PointsRef& points, const pybind11::object& viewpoint);

/// Points as rows.
pybind11::array_t<float> toRows(const PointsRef& points);

template <typename Value>
pybind11::array_t<Value> toArray(const std::vector<Value>& values) {
  return pybind11::array_t<Value>(static_cast<pybind11::ssize_t>(values.size()), values.data());
}

}  // namespace pcl_symmetry::python

template <>
struct pybind11::detail::type_caster<pcl_symmetry::python::AnyArray> {
  PYBIND11_TYPE_CASTER(pcl_symmetry::python::AnyArray, const_name("ArrayLike"));

  bool load(handle source, bool) {
    if (!source || source.is_none()) return false;
    value.array = array::ensure(source);
    return static_cast<bool>(value.array);
  }
};
