#include "core/refinement/iterative_symmetric_points.h"

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>

#include "core/geometry/surface_normals.h"
#include "pcl_symmetry/core/visibility.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

ReflectionPlane randomPlane(RandomStream& random) {
  return ReflectionPlane(randomDirection(random), 0.3 * symmetric(random));
}

/// The cost that fitReflectionPlane states: sum w |x' - y|^2.
double cost(const Points& x, const Points& y, const std::vector<double>& weights, const ReflectionPlane& plane) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    sum += weights[i] * (plane.reflect(x.col(i).cast<double>()) - y.col(i).cast<double>()).squaredNorm();
  return sum;
}

struct Pairs {
  Points x, y;
  std::vector<double> weights;
};

/// Points and noisy images of them in a plane.
Pairs noisyPairs(const ReflectionPlane& plane, double noise, std::uint64_t seed) {
  RandomStream random(seed);
  Pairs pairs{asymmetricBlob(200, seed).cloud(), Points(3, 200), std::vector<double>(200)};
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d error(gaussian(random), gaussian(random), gaussian(random));
    pairs.y.col(i) = (plane.reflect(pairs.x.col(i).cast<double>()) + noise * error).cast<float>();
    pairs.weights[i] = random.uniform();
  }
  return pairs;
}

TEST(FitReflectionPlane, IsTheMinimumOfItsCost) {
  RandomStream random(2);
  for (int i = 0; i < 8; ++i) {
    const ReflectionPlane plane = randomPlane(random);
    const Pairs pairs = noisyPairs(plane, 0.2, i + 1);
    const auto costOf = [&](const ReflectionPlane& other) { return cost(pairs.x, pairs.y, pairs.weights, other); };
    const ReflectionPlane fitted = fitReflectionPlane(pairs.x, pairs.y, pairs.weights, {});
    EXPECT_GT(plane.angleTo(fitted), 1e-4);  // there was something to minimize
    for (int k = 0; k < 100; ++k) EXPECT_LE(costOf(fitted), costOf(randomPlane(random)));
    // A step of length e from the minimum costs e^2 of the curvature, which rounding of 1e-16 hides below 1e-8 or so.
    for (const double step : {1e-1, 1e-3, 1e-6})
      for (int k = 0; k < 20; ++k) {
        const ReflectionPlane beside(fitted.normal() + step * randomDirection(random),
                                     fitted.offset() + step * symmetric(random));
        EXPECT_LT(costOf(fitted), costOf(beside)) << step;
      }
  }
}

TEST(FitReflectionPlane, IgnoresPairsWithoutWeight) {
  const ReflectionPlane plane({1.0, 2.0, 3.0}, 0.1);
  Pairs pairs = noisyPairs(plane, 0.0, 3);
  for (int i = 0; i < 100; ++i) {
    pairs.y.col(i).setConstant(7.0f);
    pairs.weights[i] = 0.0;
  }
  EXPECT_LT(fitReflectionPlane(pairs.x, pairs.y, pairs.weights, {}).angleTo(plane), 1e-6);
  const std::vector<double> none(200, 0.0);
  EXPECT_EQ(fitReflectionPlane(pairs.x, pairs.y, none, plane).normal(), plane.normal());
}

/// A shape, its normals and its search.
struct Surface {
  explicit Surface(const Points& cloud)
      : points(cloud),
        search(makeFlannSearch(points)),
        geometry(localGeometry(points, *search, 1)),
        all(points.cols()) {
    std::iota(all.begin(), all.end(), 0);
  }
  IspSurface view() const { return {points, geometry.normals, *search}; }

  Points points;
  ClosestPointSearch::Ptr search;
  LocalGeometry geometry;
  std::vector<int> all;
};

ReflectionPlane disturbed(const ReflectionPlane& plane, double angle, double distance, std::uint64_t seed) {
  RandomStream random(seed);
  const Eigen::Vector3d u = plane.normal().unitOrthogonal(), v = plane.normal().cross(u);
  const double direction = 2.0 * kPi * random.uniform();
  const Eigen::Vector3d normal =
      std::cos(angle) * plane.normal() + std::sin(angle) * (std::cos(direction) * u + std::sin(direction) * v);
  return ReflectionPlane(normal, plane.offset() + (random.uniform() < 0.5 ? -distance : distance));
}

TEST(RefineSymmetricPoints, ConvergesFromFiveDegreesAndFivePerCent) {
  // The shapes lie about 0, so that the offset is that at their center. Mirrored samples coincide with their images up
  // to the rounding of coordinates, 6e-8: the plane is exact to that once every pair is the right one.
  for (const IspUpdate update : {IspUpdate::PointToPoint, IspUpdate::PointToPlane}) {
    for (const Shape& shape : {box(2000, Sampling::Mirrored, 1), prism(5, 2000, Sampling::Mirrored, 2)}) {
      const Surface surface(shape.cloud());
      const double size = diagonal(surface.points);
      for (std::size_t p = 0; p < shape.planes.size(); ++p) {
        const ReflectionPlane start = disturbed(shape.planes[p], 5.0 * kDegree, 0.05 * size, p);
        IspOptions options;
        options.update = update;
        options.sigma = options.final_sigma = 0.2;
        options.max_iterations = 200;
        const ReflectionPlane near = refineSymmetricPoints(surface.view(), surface.all, start, options).plane;
        // Narrow weights only where the plane already stands still: points between points hold on to wrong partners.
        options.final_sigma = 0.05;
        const IspResult result = refineSymmetricPoints(surface.view(), surface.all, near, options);
        const PlaneError error = planeError(result.plane, shape.planes[p], Eigen::Vector3d::Zero());
        const int kind = static_cast<int>(update);
        EXPECT_TRUE(result.converged) << kind << ", plane " << p;
        EXPECT_LT(error.angle, 1e-3 * kDegree) << kind << ", plane " << p << " after " << result.iterations;
        EXPECT_LT(error.offset, 1e-5 * size) << kind << ", plane " << p;
        EXPECT_LT(result.last.residual, 1e-4 * size);
        EXPECT_GT(result.last.weight, 0.99);
      }
    }
  }
}

TEST(RefineSymmetricPoints, PointToPlaneNeedsFewerIterations) {
  const Shape shape = box(3000, Sampling::Random, 3);
  const Surface surface(shape.cloud());
  const ReflectionPlane start = disturbed(shape.planes[1], 3.0 * kDegree, 0.05, 1);
  const auto refined = [&](IspUpdate update) {
    IspOptions options;
    options.update = update;
    options.sigma = options.final_sigma = 0.1;
    options.max_iterations = 300;
    return refineSymmetricPoints(surface.view(), surface.all, start, options);
  };
  const IspResult point = refined(IspUpdate::PointToPoint), across = refined(IspUpdate::PointToPlane);
  EXPECT_TRUE(point.converged);
  EXPECT_TRUE(across.converged);
  EXPECT_LT(2 * across.iterations, point.iterations);
  // The samples lie 0.06 apart: residuals of about 0.03 over 3000 of them leave 0.03 / sqrt(3000) = 5e-4 and more.
  EXPECT_LT(across.plane.angleTo(shape.planes[1]), 0.1 * kDegree);
}

TEST(RefineSymmetricPoints, StopsAfterMaxIterations) {
  const Shape shape = box(500, Sampling::Mirrored, 4);
  const Surface surface(shape.cloud());
  IspOptions options;
  options.sigma = options.final_sigma = 0.2;
  options.max_iterations = 1;
  const auto result =
      refineSymmetricPoints(surface.view(), surface.all, disturbed(shape.planes[0], 0.08, 0.1, 2), options);
  EXPECT_EQ(result.iterations, 1);
  EXPECT_FALSE(result.converged);
}

TEST(IterateSymmetricPoints, ReflectionsBehindWhatWasSeenDoNotPull) {
  // A camera at (0, 0, -10) looks along z and sees a wall at z = 0, in one pixel that is wide enough for all of it.
  Visibility::Projection projection = Visibility::Projection::Zero();
  projection(0, 0) = projection(1, 1) = 0.01;
  projection(2, 2) = 1.0;
  projection(2, 3) = 10.0;
  const Visibility visibility(projection, 1, 1, {10.0f});
  // The plane x = 0 takes the first point 0.3 behind the third, the second one 0.3 in front of it.
  const Points points = (Points(3, 3) << -1, -1, 1, 0, 0, 0, 0.3, -0.3, 0).finished();
  const auto search = makeFlannSearch(points);
  const Points no_normals(3, 0);
  IspSurface surface{points, no_normals, *search};
  const double sigma = 0.5, weight = std::exp(-0.09 / 0.25);
  const auto weightOf = [&](int sample) {
    return iterateSymmetricPoints(surface, {sample}, ReflectionPlane(Eigen::Vector3d::UnitX(), 0.0), sigma,
                                  IspUpdate::PointToPoint)
        .weight;
  };
  EXPECT_NEAR(weightOf(0), weight, 1e-6);
  EXPECT_NEAR(weightOf(1), weight, 1e-6);
  surface.visibility = &visibility;
  EXPECT_LT(weightOf(0), 1e-12);
  EXPECT_NEAR(weightOf(1), weight, 1e-6);
}

TEST(IterateSymmetricPoints, ReportsWhatItSaw) {
  Points points = Points::Zero(3, 3);
  points.row(0) << 1.0f, -1.1f, 5.0f;
  const auto search = makeFlannSearch(points);
  const Points no_normals(3, 0);
  const IspSurface surface{points, no_normals, *search};
  const double sigma = 0.5;
  const IspStep step = iterateSymmetricPoints(surface, {0, 2}, ReflectionPlane(Eigen::Vector3d::UnitX(), 0.0), sigma,
                                              IspUpdate::PointToPoint);
  // (1, 0, 0) lands on (-1, 0, 0), 0.1 from its partner; (5, 0, 0) on (-5, 0, 0), 3.9 away: no weight to speak of.
  EXPECT_EQ(step.closest, (std::vector<int>{1, -1}));
  EXPECT_NEAR(step.sq_distances[0], 0.01, 1e-6);
  EXPECT_TRUE(std::isinf(step.sq_distances[1]));
  EXPECT_NEAR(step.weight, 0.5 * std::exp(-0.01 / 0.25), 1e-6);
  EXPECT_NEAR(step.residual, 0.1, 1e-6);
}

TEST(IterateSymmetricPoints, LeavesTheFreeDirectionsOfASphere) {
  // Pairs on a sphere say nothing about the direction of a plane through its center: only the offset may move.
  const Surface ball(sphere(3000, 5).cloud());
  const IspSurface surface{ball.points, ball.points, *ball.search};  // the normals of a sphere are its points
  const ReflectionPlane start({1.0, 2.0, 2.0}, 3.0 * 0.08);
  ReflectionPlane plane = start;
  for (int i = 0; i < 10; ++i)
    plane = iterateSymmetricPoints(surface, ball.all, plane, 0.3, IspUpdate::PointToPlane).plane;
  // Samples 0.065 apart, 3000 of them; an unbounded Gauss-Newton step would turn by its limit of 0.2 at every turn.
  EXPECT_LT(plane.angleTo(start), 0.02);
  EXPECT_LT(std::abs(plane.offset()), 0.01);
}

TEST(IterateSymmetricPoints, DoesNotMoveWithoutWeightsOrExtent) {
  const Points one = Points::Constant(3, 5, 1.0f), up = Points::Constant(3, 5, std::sqrt(1.0f / 3.0f));
  const auto search = makeFlannSearch(one);
  const ReflectionPlane through({1.0, 2.0, 3.0}, 6.0), far({1.0, 2.0, 3.0}, 60.0);
  for (const ReflectionPlane& plane : {through, far})
    for (const IspUpdate update : {IspUpdate::PointToPlane, IspUpdate::PointToPoint}) {
      if (update == IspUpdate::PointToPoint && plane.offset() < 10.0) continue;  // any plane through the point fits
      const IspStep step = iterateSymmetricPoints({one, up, *search}, {0, 1, 2, 3, 4}, plane, 0.1, update);
      EXPECT_EQ(step.plane.coefficients(), plane.coefficients());
    }
}

TEST(IspOptions, RefusesBadOnes) {
  const auto refused = [](auto&& change) {
    IspOptions options;
    options.sigma = options.final_sigma = 1.0;
    options.validate();
    change(options);
    EXPECT_THROW(options.validate(), std::invalid_argument);
  };
  refused([](auto& o) { o.sigma = 0.0; });
  refused([](auto& o) { o.sigma = std::nan(""); });
  refused([](auto& o) { o.final_sigma = 0.0; });
  refused([](auto& o) { o.final_sigma = 2.0; });
  refused([](auto& o) { o.max_iterations = 0; });
  refused([](auto& o) { o.settled_errors = -1.0; });
}

}  // namespace
