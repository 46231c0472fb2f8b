/// Shapes as a scanner sees them from one side.
#pragma once

#include <gtest/gtest.h>

#include <optional>

#include "pcl_symmetry/core/visibility.h"
#include "shapes/turning_shapes.h"

namespace pcl_symmetry::test {

struct SeenFromOneSide {
  Points points;
  std::optional<Visibility> seen;
};

/// The points of a shape that no other hides, as seen from a place.
inline SeenFromOneSide seenFrom(const TurningShape& shape, const Eigen::Vector3d& viewpoint, std::uint64_t seed = 1) {
  const Points all = shape.sampled(14000, seed).cloud();
  const std::optional<Visibility> whole = Visibility::fromPoints(all, viewpoint);
  EXPECT_TRUE(whole.has_value());
  Points kept(3, all.cols());
  Eigen::Index size = 0;
  for (Eigen::Index i = 0; i < all.cols(); ++i)
    // radii of the shapes; chosen: above the depth of a slanted pixel, below the thickness of the shapes
    if (whole->depthBehind(all.col(i).cast<double>()) < 0.08) kept.col(size++) = all.col(i);
  kept.conservativeResize(3, size);
  return {kept, Visibility::fromPoints(kept, viewpoint)};
}

}  // namespace pcl_symmetry::test
