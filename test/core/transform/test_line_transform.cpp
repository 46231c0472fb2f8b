#include "pcl_symmetry/core/line_transform.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "shapes/contours.h"
#include "shapes/shapes.h"
#include "shapes/threads.h"

namespace pcl_symmetry {
namespace {

using namespace test;

/// One disk for all shapes of the unit circle, so that their functions f can be compared cell by cell.
GaussianEdt2D edtOf(const Points2D& points, double radius = 1.2) {
  GaussianEdt2DOptions options;
  options.radius = radius;
  return GaussianEdt2D(points, options);
}

LineMap mapOf(const GaussianEdt2D& edt, int bins = 96) {
  return lineTransform(edt, LineGrid(bins, bins, edt.center(), edt.radius()), Eigen::Vector2d::Zero());
}

std::vector<LineMaximum> linesOf(const Points2D& points) {
  const GaussianEdt2D edt = edtOf(points);
  return findLineMaxima(edt, mapOf(edt, 128));
}

double largestDifference(const LineMap& a, const LineMap& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.values.size(); ++i)
    largest = std::max(largest, std::abs(static_cast<double>(a[i]) - b[i]));
  return largest;
}

/// || f / |f| - g / |g| ||.
double distance(const GaussianEdt2D& f, const GaussianEdt2D& g) {
  double sq_sum = 0.0;
  for (std::size_t i = 0; i < f.values().size(); ++i)
    sq_sum += std::pow(f.values()[i] / std::sqrt(f.sqNorm()) - g.values()[i] / std::sqrt(g.sqNorm()), 2);
  return std::sqrt(sq_sum);
}

TEST(LineTransform, AgreesWithTheSumOverExactDistances) {
  const Points2D contour = starfish(0.02, 3, 240);
  const GaussianEdt2D edt = edtOf(contour);
  const auto f = [&](const Eigen::Vector2d& x) {
    const double sq_distance = (contour.cast<double>().colwise() - x).colwise().squaredNorm().minCoeff();
    return std::exp(-sq_distance / (edt.sigma() * edt.sigma()));
  };
  const LineMap map = mapOf(edt, 24);
  const int n = edt.numCells();
  for (std::size_t i = 0; i < map.values.size(); i += 29) {
    const ReflectionLine line = map.grid.line(map.grid.bin(i));
    double sum = 0.0;
    for (int cell = 0; cell < n * n; ++cell) {
      const double here = edt.values()[cell];
      if (here == 0.0) continue;
      const Eigen::Vector2d x = edt.origin() + edt.cellSize() * Eigen::Vector2d(cell % n, cell / n);
      sum += here * f(line.reflect(x));
    }
    // f is not smooth where two points of the contour are equally near.
    EXPECT_NEAR(map[i], sum / edt.sqNorm(), 2e-3);
  }
}

TEST(LineTransform, EqualBitsForAnyNumberOfThreads) {
  const GaussianEdt2D edt = edtOf(starfish(0.0, 1));
  const LineGrid grid(40, 40, edt.center(), edt.radius());
  compareThreads([&](int num_threads) { return lineTransform(edt, grid, {0, 0}, num_threads).values; });
}

class RegularPolygon : public testing::TestWithParam<int> {};

TEST_P(RegularPolygon, HasOneLineForEachCorner) {
  const int n = GetParam();
  const std::vector<LineMaximum> lines = linesOf(regularPolygon(n));
  // The others are symmetries of parts. 0.97: what the cells leave of 1 at lines between them.
  ASSERT_GE(static_cast<int>(lines.size()), n);
  for (int i = 0; i < n; ++i) EXPECT_GT(lines[i].value, 0.97);
  if (static_cast<int>(lines.size()) > n) {
    EXPECT_LT(lines[n].value, 0.9);
  }
  for (int k = 0; k < n; ++k) {
    const ReflectionLine expected(kPi * k / n, 0.0);
    const auto best = std::min_element(lines.begin(), lines.begin() + n, [&](const auto& a, const auto& b) {
      return a.line.angleTo(expected) < b.line.angleTo(expected);
    });
    EXPECT_LT(best->line.angleTo(expected), 0.2 * kDegree) << k;
    EXPECT_LT(std::abs(best->line.signedDistance(Eigen::Vector2d::Zero())), 0.004) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(TriangleToOctagon, RegularPolygon, testing::Values(3, 4, 5, 6, 8));

TEST(LineTransform, LinesMoveTurnAndScaleWithTheContour) {
  const Eigen::Rotation2Df rotation(0.7f);
  const Eigen::Vector2f shift(40.0f, -7.0f);
  const Points2D original = starfish(0.0, 1);
  const Points2D moved = ((rotation.toRotationMatrix() * (250.0f * original)).colwise() + shift);
  const GaussianEdt2D edt(moved);
  const LineMap map = lineTransform(edt, LineGrid(128, 128, edt.center(), edt.radius()), edt.center());
  const std::vector<LineMaximum> lines = findLineMaxima(edt, map);
  ASSERT_GE(lines.size(), 5u);
  for (int k = 0; k < 5; ++k) {
    EXPECT_GT(lines[k].value, 0.97);
    EXPECT_LT(std::abs(lines[k].line.signedDistance(shift.cast<double>())), 1.0) << "0.4 % of the radius";
    double nearest = kPi;
    for (int j = 0; j < 5; ++j)
      nearest = std::min(nearest, lines[k].line.angleTo(ReflectionLine(0.7 + kPi * j / 5, 0)));
    EXPECT_LT(nearest, 0.2 * kDegree);
  }
}

// Section 3, "it is not sensitive to noise and varies continuously with deformations". With f and g normalized,
// |f.Rf - g.Rg| = |(f - g).Rf + g.R(f - g)| <= 2 |f - g|, for every line at once. 0.01 is left for the cells.
double boundOf(const GaussianEdt2D& f, const GaussianEdt2D& g) {
  return 2.0 * distance(f, g) + 0.01;
}

TEST(Stability, MapMovesByAtMostTwiceTheChangeOfTheFunction) {
  const GaussianEdt2D star = edtOf(starfish(0.0, 1));
  const LineMap star_map = mapOf(star);
  for (const double noise : {0.005, 0.01, 0.02, 0.04}) {
    const GaussianEdt2D noisy = edtOf(starfish(noise, 7));
    EXPECT_LE(largestDifference(star_map, mapOf(noisy)), boundOf(star, noisy)) << noise;
  }
}

TEST(PointSymmetry2D, TheCenterOfACircleIsTheDarkestPoint) {
  const GaussianEdt2D edt(regularPolygon(2400));
  const LineMap map = lineTransform(edt, LineGrid(96, 96, edt.center(), edt.radius()), edt.center());
  Points2D probes(2, 2);
  probes << 0.0f, 0.5f, 0.0f, 0.6f;
  const std::vector<float> values = pointSymmetry(map, probes);
  // Every point lies on a line through the center, and all of these are symmetries.
  EXPECT_GT(values[0], 0.95f);
  EXPECT_GT(values[1], 0.9f);

  const GaussianEdt2D rectangle_edt(rectangle(1.6, 0.9));
  const LineMap rectangle_map = lineTransform(
      rectangle_edt, LineGrid(96, 96, rectangle_edt.center(), rectangle_edt.radius()), rectangle_edt.center());
  const std::vector<float> of_rectangle = pointSymmetry(rectangle_map, probes);
  // Its two lines lie half a bin from the directions of the map.
  EXPECT_GT(of_rectangle[0], 0.85f);
  EXPECT_LT(of_rectangle[1], 0.6f);
}

TEST(LineGrid, SeamLeadsToTheSameLinesTurned) {
  const LineGrid grid(12, 10, {0.0, 0.0}, 1.5);
  const auto to = grid.step({0, 3}, -1, 0);
  ASSERT_TRUE(to);
  EXPECT_EQ(to->theta, 11);
  EXPECT_EQ(to->radius, 6);
  EXPECT_NEAR(grid.line({0, 3}).angleTo(grid.line(*to)), grid.thetaStep(), 1e-12);
  EXPECT_FALSE(grid.step({4, 9}, 0, 1));
}

TEST(LineGrid, RefusesBadParameters) {
  EXPECT_THROW(LineGrid(0, 10, {0.0, 0.0}, 1.0), std::invalid_argument);
  EXPECT_THROW(LineGrid(10, 4097, {0.0, 0.0}, 1.0), std::invalid_argument);
  EXPECT_THROW(LineGrid(10, 10, {0.0, std::nan("")}, 1.0), std::invalid_argument);
  EXPECT_THROW(LineGrid(10, 10, {0.0, 0.0}, 0.0), std::invalid_argument);
}

TEST(LineMap, StrongestIsTheFirstOfTheGreatest) {
  LineMap map;
  EXPECT_TRUE(map.empty());
  EXPECT_EQ(map.strongest(), 0u);
  map.values = {0.2f, 0.9f, 0.9f};
  EXPECT_EQ(map.strongest(), 1u);
  EXPECT_EQ(map[0], 0.2f);
}

TEST(ReflectionLine, ReflectingTwiceIsTheIdentity) {
  RandomStream random(5);
  for (int i = 0; i < 100; ++i) {
    const ReflectionLine line(10.0 * symmetric(random), symmetric(random));
    const Eigen::Vector2d x(symmetric(random), symmetric(random));
    EXPECT_LT((line.reflect(line.reflect(x)) - x).norm(), 1e-14);
    EXPECT_NEAR(line.signedDistance(line.reflect(x)), -line.signedDistance(x), 1e-14);
    const ReflectionLine canonical = line.canonical();
    EXPECT_GE(canonical.theta(), 0.0);
    EXPECT_LT(canonical.theta(), kPi);
    EXPECT_LT((canonical.reflect(x) - line.reflect(x)).norm(), 1e-14);
  }
  EXPECT_LT(ReflectionLine(-1e-17, 1.0).canonical().theta(), kPi);
}

TEST(ReflectionLine, ReflectsAsWritten) {
  // x - 2 (n.x - r) n for n = (1, 0), r = 2 turns (5, 3) into (-1, 3).
  EXPECT_EQ(ReflectionLine(0.0, 2.0).reflect({5.0, 3.0}), Eigen::Vector2d(-1.0, 3.0));
  EXPECT_EQ(ReflectionLine().reflect({5.0, 3.0}), Eigen::Vector2d(-5.0, 3.0));
}

TEST(ReflectionLine, AngleIsThatOfLines) {
  const ReflectionLine line(0.4, 1.0);
  for (const double angle : {0.0, 1e-6, 0.3, 0.5 * kPi}) {
    EXPECT_NEAR(line.angleTo(ReflectionLine(0.4 + angle, -3.0)), angle, 1e-15);
    EXPECT_NEAR(line.angleTo(ReflectionLine(0.4 - angle + kPi, 2.0)), angle, 1e-15);
  }
}

TEST(ReflectionLine, RefusesWhatIsNotFinite) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(ReflectionLine(std::numeric_limits<double>::quiet_NaN(), 0.0), std::invalid_argument);
  EXPECT_THROW(ReflectionLine(kInfinity, 0.0), std::invalid_argument);
  EXPECT_THROW(ReflectionLine(0.0, kInfinity), std::invalid_argument);
}

}  // namespace
}  // namespace pcl_symmetry
