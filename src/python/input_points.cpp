#include "python/input_points.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/base/check.h"
#include "core/geometry/point_samples.h"
#include "core/scan/viewpoint_inference.h"
#include "python/computing.h"

namespace py = pybind11;

namespace pcl_symmetry::python {

namespace {

/// Greatest rounding of coordinates, as a share of the extent: a hundredth of the default tolerance of 1 %, which
/// changes no decision. Ten times as much costs results a digit; a tenth refuses clouds far from the origin that give
/// the same planes.
constexpr double kMostRounding = 1e-4;

using Rows = py::array_t<float, py::array::forcecast>;

std::string shapeOf(const py::array& array) {
  std::string shape = "(";
  for (py::ssize_t i = 0; i < array.ndim(); ++i) shape += (i ? ", " : "") + std::to_string(array.shape(i));
  return shape + (array.ndim() == 1 ? ",)" : ")");
}

void checkShape(const char* name, const py::array& array) {
  if (array.ndim() != 2 || array.shape(1) != 3)
    throw std::invalid_argument(std::string(name) + " = array of shape " + shapeOf(array) + ", must be (N, 3)");
  const char kind = array.dtype().kind();
  if (kind != 'f' && kind != 'i' && kind != 'u')
    throw std::invalid_argument(std::string(name) + " = array of type " + py::str(array.dtype()).cast<std::string>() +
                                ", must hold real numbers");
}

/// \throws std::invalid_argument if float32 rounds coordinates by more than kMostRounding.
void checkRounding(const char* name, const py::array& array) {
  if (array.dtype().kind() == 'f' && array.itemsize() <= 4) return;
  const auto exact = py::array_t<double, py::array::forcecast>(array);
  const auto value = exact.unchecked<2>();
  Eigen::AlignedBox3d box;
  for (py::ssize_t i = 0; i < value.shape(0); ++i) {
    const Eigen::Vector3d row(value(i, 0), value(i, 1), value(i, 2));
    if (row.allFinite()) box.extend(row);
  }
  if (box.isEmpty()) return;
  const double greatest = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  if (greatest > std::numeric_limits<float>::max() || (greatest > 0.0 && greatest < std::numeric_limits<float>::min()))
    throw std::invalid_argument(std::string(name) + " = coordinates that float32 cannot hold, must have another unit");
  if (greatest * std::numeric_limits<float>::epsilon() > kMostRounding * box.diagonal().norm())
    throw std::invalid_argument(std::string(name) +
                                " = coordinates too large for the extent of the points, must be moved near the origin");
}

bool isInPlace(const Rows& array) {
  return array.strides(1) == static_cast<py::ssize_t>(sizeof(float)) && array.strides(0) > 0 &&
         array.strides(0) % static_cast<py::ssize_t>(sizeof(float)) == 0;
}

}  // namespace

InputPoints::InputPoints(const char* name, const py::array& array, std::size_t max_points, std::uint64_t seed) {
  checkShape(name, array);
  checkRounding(name, array);
  array_ = Rows(array);
  num_rows_ = static_cast<std::size_t>(array.shape(0));
  const auto value = array_.unchecked<2>();
  const auto isFinite = [&](std::size_t row) {
    const auto i = static_cast<py::ssize_t>(row);
    return std::isfinite(value(i, 0)) && std::isfinite(value(i, 1)) && std::isfinite(value(i, 2));
  };
  std::size_t num_finite = 0;
  for (std::size_t row = 0; row < num_rows_; ++row) num_finite += isFinite(row) ? 1 : 0;
  if (max_points == 0) max_points = num_finite;
  if (num_finite == num_rows_ && num_finite <= max_points && isInPlace(array_)) return;

  std::vector<std::size_t> drawn;
  if (num_finite > max_points) drawn = oneOfEachRun(num_finite, max_points, seed);
  const std::size_t size = std::min(num_finite, max_points);
  rows_.reserve(size);
  for (std::size_t row = 0, position = 0; row < num_rows_ && rows_.size() < size; ++row) {
    if (!isFinite(row)) continue;
    if (drawn.empty() || position == drawn[rows_.size()]) rows_.push_back(row);
    ++position;
  }
  copied_.resize(3, rows_.size());
  for (std::size_t i = 0; i < rows_.size(); ++i)
    for (int k = 0; k < 3; ++k) copied_(k, static_cast<Eigen::Index>(i)) = value(static_cast<py::ssize_t>(rows_[i]), k);
  if (rows_.size() == num_rows_) rows_.clear();
  array_ = Rows();
}

py::array arrayOf(const char* name, const py::object& object) {
  py::array array = py::array::ensure(object);
  if (!array) throw std::invalid_argument(std::string(name) + " = no array, must be one");
  return array;
}

std::vector<std::vector<int>> polygonsOf(const py::object& all) {
  const py::array faces = py::array::ensure(all);
  if (!faces && py::detail::make_caster<std::vector<std::vector<int>>>().load(all, true))
    return all.cast<std::vector<std::vector<int>>>();
  const char kind = faces ? faces.dtype().kind() : 'O';
  if (kind != 'i' && kind != 'u' && kind != 'f')
    throw std::invalid_argument("faces = no numbers, must be (F, 3), indices into the vertices");
  if (faces.ndim() != 2 || faces.shape(1) < 3)
    throw std::invalid_argument("faces = array of shape " + shapeOf(faces) +
                                ", must be (F, 3), indices into the vertices");
  const py::array_t<double, py::array::forcecast> rows(faces);
  const auto index = rows.unchecked<2>();
  std::vector<std::vector<int>> polygons(faces.shape(0));
  for (py::ssize_t i = 0; i < faces.shape(0); ++i)
    for (py::ssize_t k = 0; k < faces.shape(1); ++k) {
      const double corner = index(i, k);
      if (!(corner >= 0.0 && corner <= std::numeric_limits<int>::max() && corner == std::floor(corner)))
        throw std::invalid_argument("faces: " + py::str(py::float_(corner)).cast<std::string>() +
                                    ", must be an index of a vertex");
      polygons[i].push_back(static_cast<int>(corner));
    }
  return polygons;
}

PointsRef InputPoints::points() const {
  if (array_.ndim() != 2) return copied_;
  const Eigen::OuterStride<> stride(array_.strides(0) / static_cast<py::ssize_t>(sizeof(float)));
  return Eigen::Map<const Points, 0, Eigen::OuterStride<>>(array_.data(), 3, array_.shape(0), stride);
}

Points InputPoints::atPoints(const char* name, const py::array& normals) const {
  checkShape(name, normals);
  if (static_cast<std::size_t>(normals.shape(0)) != num_rows_)
    throw std::invalid_argument(std::string(name) + " = array of shape " + shapeOf(normals) + ", must be (" +
                                std::to_string(num_rows_) + ", 3), one for each point");
  const Rows rows(normals);
  const auto value = rows.unchecked<2>();
  const auto size = static_cast<std::size_t>(points().cols());
  Points result(3, size);
  for (std::size_t i = 0; i < size; ++i)
    for (int k = 0; k < 3; ++k)
      result(k, static_cast<Eigen::Index>(i)) = value(static_cast<py::ssize_t>(rows_.empty() ? i : rows_[i]), k);
  return result;
}

void checkAnswerable(const char* name, const PointsRef& points) {
  if (const std::string reason = whyUnanswerable(points); !reason.empty())
    throw NoAnswer(std::string(name) + ": " + reason);
}

std::optional<Eigen::Vector3d> positionOf(const py::object& viewpoint) {
  if (py::isinstance<StoredViewpoint>(viewpoint)) return std::nullopt;
  if (!py::isinstance<py::str>(viewpoint)) {
    try {
      const auto position = viewpoint.cast<Eigen::Vector3d>();
      check(position.allFinite(), "viewpoint", position.transpose(), "finite");
      return position;
    } catch (const py::cast_error&) {
    }
  } else if (viewpoint.cast<std::string>() == "auto") {
    return std::nullopt;
  }
  throw std::invalid_argument("viewpoint = " + py::str(viewpoint).cast<std::string>() +
                              ", must be \"auto\", None or (x, y, z)");
}

std::optional<Visibility> seenFrom(const PointsRef& all, const py::object& viewpoint) {
  if (viewpoint.is_none()) return std::nullopt;
  if (py::isinstance<Visibility>(viewpoint)) return viewpoint.cast<Visibility>();
  const std::optional<Eigen::Vector3d> position = positionOf(viewpoint);
  if (all.cols() == 0) return std::nullopt;
  const Points points = withoutStrayPoints(all);
  if (!position) {
    const bool is_stored = py::isinstance<StoredViewpoint>(viewpoint);
    const Eigen::Vector3d stored = is_stored ? viewpoint.cast<StoredViewpoint>().position : Eigen::Vector3d::Zero();
    const Computing computing;
    std::optional<InferredView> view = inferView(points, stored, !is_stored);
    return view ? std::optional<Visibility>(std::move(view->seen)) : std::nullopt;
  }
  const Computing computing;
  std::optional<Visibility> seen = Visibility::fromPoints(points, *position);
  if (!seen)
    throw std::invalid_argument("viewpoint: among the points, must see them within 75 degrees of one direction");
  return seen;
}

py::array_t<float> toRows(const PointsRef& points) {
  py::array_t<float> result({static_cast<py::ssize_t>(points.cols()), py::ssize_t{3}});
  Eigen::Map<Points>(result.mutable_data(), 3, points.cols()) = points;
  return result;
}

}  // namespace pcl_symmetry::python
