/// Open ground, open sheets and frames of a table: what ends everywhere, and what the picture cut off, is no object.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/detect_planes.h"
#include "shapes/scans.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

bool hasSymmetry(const Detection& detection) {
  return !detection.axes.empty() || !detection.centers.empty() ||
         std::any_of(detection.planes.begin(), detection.planes.end(),
                     [](const SymmetryPlane& plane) { return plane.kind == PlaneKind::Symmetry; });
}

/// Ground 2 x 1.4 with waves of random directions, the longer the higher.
Points ground(std::uint64_t seed) {
  RandomStream random(seed);
  Eigen::Matrix<double, 4, 12> waves;  // direction, phase, height
  for (Eigen::Index k = 0; k < waves.cols(); ++k) {
    const double angle = 2.0 * kPi * random.uniform(), length = 0.3 + 1.7 * random.uniform();
    waves.col(k) << std::cos(angle) / length, std::sin(angle) / length, random.uniform(), 0.04 * length;
  }
  Points points(3, 6000);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const double x = symmetric(random), y = 0.7 * symmetric(random);
    double height = 0.0;
    for (const auto& wave : waves.colwise())
      height += wave[3] * std::sin(2.0 * kPi * (wave[0] * x + wave[1] * y + wave[2]));
    points.col(i) << static_cast<float>(x), static_cast<float>(y), static_cast<float>(height);
  }
  return points;
}

TEST(OpenSurfaces, GroundHasNoSymmetry) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) EXPECT_FALSE(hasSymmetry(detectPlanes(ground(seed)))) << seed;
}

TEST(OpenSurfaces, SheetThatIsAlikeOnBothSidesKeepsItsPlane) {
  Points points = ground(1);
  for (Eigen::Index i = 0; i < points.cols() / 2; ++i) {
    points.col(2 * i + 1) = points.col(2 * i);
    points(0, 2 * i + 1) *= -1.0f;
  }
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    points(2, i) = 0.3f * std::cos(3.0f * points(0, i)) + 0.2f * std::sin(4.0f * points(1, i));
  const Detection detection = detectPlanes(points);
  ASSERT_TRUE(hasSymmetry(detection));
  EXPECT_GT(std::abs(detection.planes.front().normal().x()), std::cos(1.0 * kDegree));
}

/// Two boxes on a table, of which the picture shows a disc of 80 pixels.
Scan tableInDisc() {
  const BlockObject table{{{{0.0, 0.0, -0.05}, {3.0, 3.0, 0.05}},
                           {{-0.5, 0.0, 0.2}, {0.25, 0.15, 0.2}},
                           {{0.5, 0.0, 0.2}, {0.25, 0.15, 0.2}}},
                          {}};
  Scan view = scan(table, {0.0, -5.0, 4.0});
  for (int v = 0; v < view.height; ++v)
    for (int u = 0; u < view.width; ++u)
      if (std::hypot(u - 0.5 * (view.width - 1), v - 0.5 * (view.height - 1)) > 40.0)
        view.pixels.col(v * view.width + u).setConstant(std::numeric_limits<float>::quiet_NaN());
  return view;
}

/// \param outside depth of the pixels without a point.
Visibility seenWith(const Scan& view, float outside) {
  const Visibility seen = view.visibility();
  std::vector<float> depths;
  for (int v = 0; v < view.height; ++v)
    for (int u = 0; u < view.width; ++u) depths.push_back(std::isfinite(seen.depth(u, v)) ? seen.depth(u, v) : outside);
  Eigen::Matrix3d camera;
  camera << view.focal, 0.0, 0.5 * (view.width - 1), 0.0, view.focal, 0.5 * (view.height - 1), 0.0, 0.0, 1.0;
  const Visibility::Projection projection = camera * view.T_camera_object.matrix().topRows<3>();
  return Visibility(projection, view.width, view.height, std::move(depths)).withDepthErrors(1e-6);
}

TEST(OpenSurfaces, TableThatThePictureCutsOffIsPossibleAtMost) {
  const Scan view = tableInDisc();
  const Points cloud = view.cloud();
  const Visibility whole = seenWith(view, Visibility::kBackground), cut = seenWith(view, Visibility::kNoRay);
  EXPECT_TRUE(hasSymmetry(detectPlanes({cloud, &whole}))) << "a round table";
  EXPECT_FALSE(hasSymmetry(detectPlanes({cloud, &cut})));
}

}  // namespace
