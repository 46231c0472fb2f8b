/// Open borders of sampled surfaces.
#include "core/geometry/open_borders.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/geometry/point_samples.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

/// Points with and without borders: whole, without a side, noisy, and fewer than are asked for.
std::vector<std::pair<std::string, Points>> surfaces() {
  const Points whole = box(3000, Sampling::Random, 3).cloud(), mirrored = box(2000, Sampling::Mirrored, 3).cloud();
  std::vector<int> below;
  const float middle = whole.row(2).mean();
  for (Eigen::Index i = 0; i < whole.cols(); ++i)
    if (whole(2, i) < middle) below.push_back(static_cast<int>(i));
  Points noisy = whole;
  RandomStream random(2);
  for (Eigen::Index i = 0; i < noisy.cols(); ++i) noisy.col(i) += 0.05f * randomDirection(random).cast<float>();
  return {{"whole", whole},
          {"mirrored", mirrored},
          {"half", pointsAt(whole, below)},
          {"noisy", noisy},
          {"few", Points(whole.leftCols(12))},
          {"fewer", Points(whole.leftCols(5))}};
}

TEST(OpenBorders, AreTheSameWithKnownNeighbours) {
  for (const auto& [name, points] : surfaces()) {
    const ClosestPointSearch::Ptr search = makeFlannSearch(points);
    FoundNeighbours known;
    const LocalGeometry geometry = localGeometry(points, *search, kNumSupportNeighbours, 1, &known);
    const std::vector<char> directly = openBorders(points, *search, geometry.normals, 1);
    EXPECT_EQ(openBorders(points, *search, geometry.normals, 1, &known), directly) << name;
    const auto num_at_border = std::count(directly.begin(), directly.end(), 1);
    EXPECT_GT(num_at_border, name == "half" ? 20 : -1);
  }
}

}  // namespace
