/// Comparisons of planes that were found.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "pcl_symmetry/core/detect_planes.h"
#include "shapes/shapes.h"

namespace pcl_symmetry::test {

/// Number of the shape's planes that are among those found within an angle and an offset.
inline int numFound(const Shape& shape, const std::vector<SymmetryPlane>& found, double angle, double offset) {
  int count = 0;
  const Eigen::Vector3d middle = shape.points.rowwise().mean();
  for (const ReflectionPlane& plane : shape.planes) {
    count += std::any_of(found.begin(), found.end(), [&](const SymmetryPlane& candidate) {
      const auto error = planeError(plane, candidate, middle);
      return error.angle <= angle && error.offset <= offset;
    });
  }
  return count;
}

inline void expectSamePlanes(const std::vector<SymmetryPlane>& a, const std::vector<SymmetryPlane>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].coefficients(), b[i].coefficients());
    EXPECT_EQ(a[i].support, b[i].support);
    EXPECT_EQ(a[i].point_support, b[i].point_support);
  }
}

}  // namespace pcl_symmetry::test
