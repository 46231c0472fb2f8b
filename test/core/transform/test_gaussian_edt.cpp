#include "pcl_symmetry/core/gaussian_edt.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "core/geometry/closest_points.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr double kReach = 2.6;      // sigmas, within which the distances are promised to be exact
constexpr double kLeast = 1.16e-3;  // exp(-kReach^2)

GaussianEdtOptions cells(int num_cells) {
  GaussianEdtOptions options;
  options.num_cells = num_cells;
  return options;
}

double definition(const Points& points, const Eigen::Vector3d& x, double sigma) {
  return std::exp(-(points.cast<double>().colwise() - x).colwise().squaredNorm().minCoeff() / (sigma * sigma));
}

/// Every cell against brute force. Coordinates are floats in cells: they are rounded at 2^-24 of numCells(), which
/// moves a distance d of up to 2.6 sigma, f by at most 0.86 / sigma of that.
void expectExact(const Points& points, const GaussianEdt& edt) {
  const double rounding = edt.numCells() * 0x1p-24 * 2.0 + 4e-7 * kReach * edt.sigma() / edt.cellSize();
  const double tolerance = 0.86 * rounding / (edt.sigma() / edt.cellSize()) + 2e-7;
  std::size_t num_within = 0;
  for (std::size_t i = 0; i < edt.values().size(); ++i) {
    const double expected = definition(points, edt.cellCenter(i), edt.sigma());
    if (expected > kLeast * 1.001) {
      ++num_within;
      ASSERT_NEAR(edt.values()[i], expected, tolerance) << "cell " << i;
    } else if (expected < kLeast * 0.999) {
      ASSERT_EQ(edt.values()[i], 0.0f) << "cell " << i;
    }
  }
  EXPECT_GT(num_within, 100u);
}

TEST(GaussianEdt, DistancesAreThoseOfBruteForce) {
  expectExact(box(500, Sampling::Random, 1).cloud(), GaussianEdt(box(500, Sampling::Random, 1).cloud(), cells(24)));
  const Points blob = moved(asymmetricBlob(300, 2), randomPose(1)).cloud();
  expectExact(blob, GaussianEdt(blob, cells(27)));
}

TEST(GaussianEdt, SparseCloudsHaveExactDistancesToo) {
  const Points sparse = scaleneTetrahedron(12, 1).cloud();
  const GaussianEdt edt(sparse, cells(48));
  EXPECT_GT(edt.sigma(), 2.001 * edt.cellSize());  // the spacing of twelve points is wider than two cells
  expectExact(sparse, edt);
  const Points pair = (Points(3, 2) << 0, 1, 0, 0, 0, 0).finished();
  expectExact(pair, GaussianEdt(pair, cells(16)));
}

TEST(GaussianEdt, OnePointIsAGaussianOfKnownSums) {
  // The point lies on the corner of eight cells. The integral of f^2 = exp(-2 |x|^2 / s^2) is (sqrt(pi / 2) s)^3, which
  // its sum over a lattice equals to 1e-4 with s = 2 cells, the cut at 2.6 s included.
  GaussianEdtOptions options = cells(32);
  options.radius = 1.0;
  const GaussianEdt edt(Points::Zero(3, 1), options);
  const double s = edt.sigma() / edt.cellSize();
  double sum = 0.0;
  for (int i = 0; i < 32 * 32 * 32; ++i) {
    const double sq_distance = (Eigen::Vector3d(i % 32, i / 32 % 32, i / 1024).array() - 15.5).matrix().squaredNorm();
    if (sq_distance < kReach * kReach * s * s) sum += std::exp(-sq_distance / (s * s));
  }
  EXPECT_NEAR(edt.sum(), sum, 1e-5 * sum);
  EXPECT_NEAR(edt.sqNorm() / std::pow(std::sqrt(0.5 * kPi) * s, 3), 1.0, 1e-4);
}

TEST(GaussianEdt, DefaultsCoverThePointsWithTwoCellsOfSigma) {
  const Points points = moved(box(3000, Sampling::Random, 3), randomPose(3)).cloud();
  for (const int n : {16, 64}) {
    const GaussianEdt edt(points, cells(n));
    EXPECT_EQ(edt.numCells(), n);
    EXPECT_NEAR(edt.sigma(), 2.0 * edt.cellSize(), 1e-12);
    EXPECT_NEAR(edt.radius() + 2.0 * edt.sigma(), 0.5 * n * edt.cellSize(), 1e-9);
    EXPECT_EQ(edt.cellCenter(0), edt.origin());
    const Eigen::Vector3d middle = 0.5 * (edt.cellCenter(0) + edt.cellCenter(edt.values().size() - 1));
    EXPECT_LT((middle - edt.center()).norm(), 1e-12);
    EXPECT_LE((points.cast<double>().colwise() - edt.center()).colwise().norm().maxCoeff(),
              edt.radius() * (1.0 + 1e-6));
  }
}

TEST(GaussianEdt, SigmaRadiusAndCenterAreTaken) {
  const Points points = box(400, Sampling::Random, 4).cloud();
  GaussianEdtOptions options = cells(20);
  options.sigma = 0.4;
  options.radius = 1.5;
  options.center = {0.1, -0.2, 0.3};
  const GaussianEdt edt(points, options);
  EXPECT_EQ(edt.sigma(), 0.4);
  EXPECT_EQ(edt.radius(), 1.5);
  EXPECT_EQ(edt.center(), options.center);
  EXPECT_NEAR(edt.cellSize(), (1.5 + 2.0 * 0.4) / 10.0, 1e-15);
  expectExact(points, edt);
}

TEST(GaussianEdt, ACenterWithoutRadiusIsNotUsed) {
  const Points points = box(400, Sampling::Random, 4).cloud();
  GaussianEdtOptions options = cells(20);
  const GaussianEdt edt(points, options);
  options.center = {5.0, 5.0, 5.0};
  EXPECT_EQ(GaussianEdt(points, options).values(), edt.values());
}

TEST(GaussianEdt, PointsOutsideTheBallAreNoHarm) {
  Points points = box(400, Sampling::Random, 5).cloud();
  GaussianEdtOptions options = cells(16);
  options.radius = 0.5;
  expectExact(points, GaussianEdt(points, options));
  points.rowwise() += Eigen::RowVectorXf::Constant(400, 100.0f);
  EXPECT_THROW(GaussianEdt(points, options), std::invalid_argument);  // none left near the ball
}

TEST(GaussianEdt, PointsFarOutsideTheBallAreNoHarm) {
  // Their coordinates in cells exceed every integer.
  Points points(3, 4);
  points << 0.1f, 0.1f, 3e12f, -1e30f, 0.2f, -3e12f, 0.2f, 0.0f, 0.3f, 0.3f, 0.3f, 1e30f;
  GaussianEdtOptions options = cells(16);
  options.radius = 0.5;
  options.sigma = 0.1;
  EXPECT_EQ(GaussianEdt(points, options).values(), GaussianEdt(points.leftCols(1), options).values());
}

TEST(GaussianEdt, ScalesWithThePoints) {
  // Powers of two are scaled without rounding: the same bytes.
  const Points points = asymmetricBlob(400, 6).cloud();
  const GaussianEdt edt(points, cells(20));
  for (const int power : {-40, -30, -3, 1, 30, 40}) {
    const double scale = std::ldexp(1.0, power);
    const GaussianEdt other(points * static_cast<float>(scale), cells(20));
    EXPECT_EQ(other.sigma(), scale * edt.sigma());
    EXPECT_EQ(other.values(), edt.values()) << "2^" << power;
  }
}

TEST(GaussianEdt, DenseCloudsAreThinned) {
  // More than 64 points to a cell of the surface are thinned to one in each slot of 1/4 cell, whose diagonal of
  // sqrt(3) / 4 bounds what a distance may grow. On average, a surface with 16 random points to a square cell has its
  // nearest at a mean squared distance of 1 / (16 pi) beside the foot of x, which lowers f by 1 / (16 pi s^2) = 0.5 %
  // of its value with s = 2; edges, seen from inside, lose more.
  const Points points = moved(box(150'000, Sampling::Random, 7), randomPose(1)).cloud();
  const GaussianEdt edt(points, cells(32));
  const double cell = edt.cellSize(), s = edt.sigma() / cell;
  Points centers(3, edt.values().size() / 5);
  for (Eigen::Index i = 0; i < centers.cols(); ++i) centers.col(i) = edt.cellCenter(5 * i).cast<float>();
  const std::vector<float> sq_distances = closestPoints(*makeFlannSearch(points), centers, 1).sq_distances;
  double sum = 0.0, sum_expected = 0.0;
  for (Eigen::Index i = 0; i < centers.cols(); ++i) {
    const double distance = std::sqrt(sq_distances[i]) / cell, at_worst = distance + std::sqrt(3.0) / 4.0;
    if (at_worst > kReach * s) continue;
    const double value = edt.values()[5 * i], expected = std::exp(-distance * distance / (s * s));
    ASSERT_LE(value, expected + 1e-5);  // fewer points are never nearer
    ASSERT_GE(value, std::exp(-at_worst * at_worst / (s * s)) - 1e-5);
    sum += value;
    sum_expected += expected;
  }
  EXPECT_LT(sum, 0.9995 * sum_expected);  // it was thinned
  EXPECT_GT(sum, 0.99 * sum_expected);
}

TEST(GaussianEdt, InterpolationKeepsTheCorrelation) {
  // What D needs is the mean of f(x) interpolated(x) over the places of f. Interpolation multiplies a wave of k radians
  // per cell by sinc^2(k / 2) on each axis, sharpening by 1 + sum (2 - 2 cos k) / 12: together 1 - sum k^4 / 90 - sum
  // of k_i^2 k_j^2 / 144 over pairs. The power of a Gaussian of width s = 2 has E k_i^2 = 1/4 and E k_i^4 = 3/16, which
  // leaves 1 - 3 * (3/16) / 90 - 3 * (1/16) / 144 = 0.9924 and, without sharpening, about 1 - 3 * (1/4) / 12 = 0.94.
  GaussianEdtOptions options = cells(32);
  options.radius = 1.0;
  const GaussianEdt edt(Points::Zero(3, 1), options);
  RandomStream random(8);
  double interpolated = 0.0, exact = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    // Drawn with probability f: a normal distribution of variance s^2 / 2.
    const Eigen::Vector3d x =
        edt.sigma() * std::sqrt(0.5) * Eigen::Vector3d(gaussian(random), gaussian(random), gaussian(random));
    interpolated += edt(x);
    exact += std::exp(-x.squaredNorm() / (edt.sigma() * edt.sigma()));
  }
  EXPECT_NEAR(interpolated / exact, 0.9924, 0.002);  // the next terms of the series are of the size of 1e-3
}

TEST(GaussianEdt, InterpolationIsZeroOutside) {
  const GaussianEdt edt(sphere(500, 8).cloud(), cells(16));
  EXPECT_EQ(edt(edt.center() + Eigen::Vector3d(100.0, 0.0, 0.0)), 0.0);
  EXPECT_EQ(edt(Eigen::Vector3d::Constant(std::nan(""))), 0.0);
}

TEST(GaussianEdt, RefusesPointsThatAreNoShape) {
  EXPECT_THROW(GaussianEdt(Points(3, 0)), std::invalid_argument);
  EXPECT_THROW(GaussianEdt(Points::Constant(3, 1, 2.0f)), std::invalid_argument);
  EXPECT_THROW(GaussianEdt(Points::Constant(3, 50, 2.0f)), std::invalid_argument);
  Points points = box(100, Sampling::Random, 11).cloud();
  points(1, 50) = kNaN;
  EXPECT_THROW(GaussianEdt{points}, std::invalid_argument);
  points(1, 50) = std::numeric_limits<float>::infinity();
  EXPECT_THROW(GaussianEdt{points}, std::invalid_argument);
}

TEST(GaussianEdt, RefusesBadOptions) {
  const Points points = box(100, Sampling::Random, 12).cloud();
  const auto refused = [&](auto&& change) {
    GaussianEdtOptions options;
    change(options);
    EXPECT_THROW(GaussianEdt(points, options), std::invalid_argument);
  };
  refused([](auto& o) { o.num_cells = 7; });
  refused([](auto& o) { o.num_cells = 513; });
  refused([](auto& o) { o.sigma = -1.0; });
  refused([](auto& o) { o.sigma = std::nan(""); });
  refused([](auto& o) { o.radius = -1.0; });
  refused([](auto& o) { o.radius = std::numeric_limits<double>::infinity(); });
  refused([](auto& o) { o.center.x() = std::nan(""); });
  refused([](auto& o) { o.num_threads = -1; });
}

}  // namespace
