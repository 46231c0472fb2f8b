/// Comparisons of planes that were found.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "pcl_symmetry/core/plane_types.h"
#include "shapes/shapes.h"
#include "shapes/threads.h"

namespace pcl_symmetry::test {

/// \return whether one of the planes is that of the shape, to an angle and to an offset from a point.
inline bool isAmong(const std::vector<SymmetryPlane>& found, const ReflectionPlane& plane, double angle, double offset,
                    const Eigen::Vector3d& about) {
  return std::any_of(found.begin(), found.end(), [&](const SymmetryPlane& candidate) {
    const PlaneError error = planeError(plane, candidate, about);
    return error.angle <= angle && error.offset <= offset;
  });
}

/// \return the number of planes of the shape that are among those found.
inline int numFound(const Shape& shape, const std::vector<SymmetryPlane>& found, double angle, double offset) {
  const Eigen::Vector3d middle = shape.points.rowwise().mean();
  return static_cast<int>(std::count_if(shape.planes.begin(), shape.planes.end(), [&](const ReflectionPlane& plane) {
    return isAmong(found, plane, angle, offset, middle);
  }));
}

inline void expectSamePlanes(const std::vector<SymmetryPlane>& a, const std::vector<SymmetryPlane>& b) {
  const auto is_same = [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  const auto values = [](const std::vector<SymmetryPlane>& planes) {
    return valuesOf(planes, &SymmetryPlane::coefficients, &SymmetryPlane::confidence, &SymmetryPlane::score,
                    &SymmetryPlane::support, &SymmetryPlane::seen, &SymmetryPlane::residual,
                    &SymmetryPlane::iterations);
  };
  ASSERT_EQ(values(a), values(b));
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_TRUE(std::equal(a[i].point_support.begin(), a[i].point_support.end(), b[i].point_support.begin(),
                           b[i].point_support.end(), is_same));
}

}  // namespace pcl_symmetry::test
