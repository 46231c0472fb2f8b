/// What refinement needs from the points themselves: bounding ball, axes, closest points, normals and spacing.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "core/evidence/plane_support.h"
#include "core/geometry/mesh_sampling.h"
#include "core/geometry/principal_axes.h"
#include "core/neighbours/surface_normals.h"
#include "pcl_symmetry/core/neighbours/closest_point_search.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

TEST(BoundingBall, HoldsEveryPointAndIsNearlyTheSmallest) {
  for (std::uint64_t pose = 0; pose < 5; ++pose) {
    // The corners of a box lie on its smallest ball.
    Eigen::Matrix3Xd corners(3, 8);
    for (int s = 0; s < 8; ++s)
      corners.col(s) = Eigen::Vector3d(s & 1 ? 1 : -1, s & 2 ? 0.7 : -0.7, s & 4 ? 0.45 : -0.45);
    const Points points = moved({corners, {}}, randomPose(pose)).cloud();
    const BoundingBall ball = boundingBall(points);
    const double smallest = Eigen::Vector3d(1.0, 0.7, 0.45).norm();
    for (Eigen::Index i = 0; i < points.cols(); ++i)
      EXPECT_LE((points.col(i).cast<double>() - ball.center).norm(), ball.radius * (1.0 + 1e-12));
    EXPECT_GE(ball.radius, smallest * (1.0 - 1e-6));
    EXPECT_LE(ball.radius, smallest * 1.02);
    EXPECT_LT((ball.center - randomPose(pose).translation()).norm(), 0.05);
  }
}

TEST(BoundingBall, OfOnePointHasNoRadius) {
  const BoundingBall ball = boundingBall(Points::Constant(3, 4, 2.5f));
  EXPECT_EQ(ball.radius, 0.0);
  EXPECT_EQ(ball.center, Eigen::Vector3d::Constant(2.5));
  EXPECT_EQ(boundingBall(Points(3, 0)).radius, 0.0);
}

TEST(CenterOfMass, IsTheMeanFarFromTheOrigin) {
  Points points(3, 3);
  points << 1e6f, 1e6f + 1.0f, 1e6f + 2.0f, -3.0f, 0.0f, 3.0f, 5.0f, 5.0f, 5.0f;
  EXPECT_LT((centerOfMass(points) - Eigen::Vector3d(1e6 + 1.0, 0.0, 5.0)).norm(), 1e-9);
  EXPECT_EQ(centerOfMass(Points(3, 0)), Eigen::Vector3d::Zero());
}

TEST(NormalizePoints, CentersAndScales) {
  Points points(3, 2);
  points << 3.0f, 5.0f, 0.0f, 2.0f, -1.0f, 1.0f;
  const Points expected = (Points(3, 2) << 1.0f, 2.0f, -0.5f, 0.5f, -1.0f, 0.0f).finished();
  EXPECT_EQ(normalizePoints(points, {1.0, 1.0, 1.0}, 2.0), expected);
}

TEST(PrincipalAxes, AreThoseOfTheBox) {
  // Mirrored samples have no covariance between the box's axes beyond rounding. Variance along x of a surface sample
  // falls with the half extents.
  for (std::uint64_t pose = 0; pose < 3; ++pose) {
    const Eigen::Isometry3d motion = randomPose(pose);
    const PrincipalAxes axes = principalAxes(moved(box(4000, Sampling::Mirrored, 1), motion).cloud());
    EXPECT_LT((axes.center - motion.translation()).norm(), 1e-6);
    EXPECT_NEAR(axes.axes.determinant(), 1.0, 1e-12);
    EXPECT_LT((axes.axes.transpose() * axes.axes - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(std::abs(axes.axes.col(i).dot(motion.linear().col(i))), 1.0, 1e-10) << i;
    EXPECT_GT(axes.variances[0], axes.variances[1]);
    EXPECT_GT(axes.variances[1], axes.variances[2]);
  }
}

TEST(PrincipalAxes, VariancesAreThoseOfTheDefinition) {
  const Points points = (Points(3, 4) << 2, -2, 0, 0, 0, 0, 1, -1, 3, 3, 3, 3).finished();
  const PrincipalAxes axes = principalAxes(points);
  EXPECT_LT((axes.center - Eigen::Vector3d(0.0, 0.0, 3.0)).norm(), 1e-15);
  EXPECT_LT((axes.variances - Eigen::Vector3d(2.0, 0.5, 0.0)).norm(), 1e-14);
}

TEST(PrincipalAxes, PlanesLieAcrossThemThroughTheCenter) {
  const PrincipalAxes axes = principalAxes(asymmetricBlob(500, 1).cloud());
  const auto planes = principalPlanes(axes);
  ASSERT_EQ(planes.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(std::abs(planes[i].normal().dot(axes.axes.col(i))), 1.0, 1e-14);
    EXPECT_NEAR(planes[i].signedDistance(axes.center), 0.0, 1e-14);
  }
  EXPECT_THROW(principalAxes(Points(3, 0)), std::invalid_argument);
}

TEST(ClosestPointSearch, FindsWhatBruteForceFinds) {
  const Points points = moved(asymmetricBlob(700, 2), randomPose(2)).cloud();
  const auto search = makeFlannSearch(points);
  Points queries = moved(asymmetricBlob(100, 3), randomPose(2)).cloud();
  queries.col(7) = points.col(7);
  constexpr int kNum = 5;
  std::vector<int> indices;
  std::vector<float> sq_distances;
  search->search(queries, kNum, indices, sq_distances);
  ASSERT_EQ(indices.size(), 500u);
  ASSERT_EQ(sq_distances.size(), 500u);
  for (Eigen::Index q = 0; q < queries.cols(); ++q) {
    std::vector<float> expected(points.cols());
    for (Eigen::Index i = 0; i < points.cols(); ++i) expected[i] = (points.col(i) - queries.col(q)).squaredNorm();
    std::vector<float> sorted = expected;
    std::sort(sorted.begin(), sorted.end());
    for (int k = 0; k < kNum; ++k) {
      // The same sum of three squares, added in another order at most.
      EXPECT_NEAR(sq_distances[q * kNum + k], sorted[k], 3e-7f * sorted[k]);
      EXPECT_NEAR(expected[indices[q * kNum + k]], sorted[k], 3e-7f * sorted[k]);
    }
  }
  EXPECT_EQ(indices[7 * kNum], 7);
}

TEST(ClosestPointSearch, FindsWithinTheLimitWhateverWasGuessed) {
  /// Only search(): searchWithin() is that of the base class.
  struct Plain : ClosestPointSearch {
    explicit Plain(const Points& points) : all(makeFlannSearch(points)) {}
    void search(const PointsRef& queries, int num_neighbours, std::vector<int>& indices,
                std::vector<float>& sq_distances) const override {
      all->search(queries, num_neighbours, indices, sq_distances);
    }
    Ptr all;
  };
  const Points points = asymmetricBlob(700, 2).cloud();
  const Points queries = asymmetricBlob(100, 3).cloud();
  std::vector<int> closest;
  std::vector<float> closest_sq;
  makeFlannSearch(points)->search(queries, 1, closest, closest_sq);
  std::vector<float> sorted = closest_sq;
  std::sort(sorted.begin(), sorted.end());
  const float limit = sorted[50];
  std::vector<int> far(100);
  for (int i = 0; i < 100; ++i) far[i] = 7 * i;
  const std::vector<ClosestPointSearch::Ptr> searches{makeFlannSearch(points), std::make_shared<Plain>(points)};
  for (const auto& search : searches) {
    for (const std::vector<int>& guesses : {std::vector<int>(100, -1), far, closest}) {
      std::vector<int> indices = guesses;
      std::vector<float> sq_distances;
      search->searchWithin(queries, limit, indices, sq_distances);
      ASSERT_EQ(sq_distances.size(), 100u);
      for (int i = 0; i < 100; ++i) {
        EXPECT_EQ(indices[i], closest_sq[i] <= limit ? closest[i] : -1) << i;
        const float expected = indices[i] < 0 ? std::numeric_limits<float>::infinity() : closest_sq[i];
        EXPECT_FLOAT_EQ(sq_distances[i], expected) << i;
      }
    }
  }
}

TEST(ClosestPointSearch, TakesColumnsAtAnyDistance) {
  const Points points = box(200, Sampling::Random, 3).cloud();
  const Eigen::Matrix4Xf wide = points.colwise().homogeneous();
  const Eigen::Ref<const Eigen::Matrix3Xf, 0, Eigen::OuterStride<>> view(wide.topRows<3>());
  std::vector<int> indices;
  std::vector<float> sq_distances;
  makeFlannSearch(view)->search(view, 1, indices, sq_distances);
  for (int i = 0; i < 200; ++i) EXPECT_EQ(indices[i], i);
  makeFlannSearch(points)->search(Points(3, 0), 1, indices, sq_distances);
  EXPECT_TRUE(indices.empty());
}

TEST(LocalGeometry, NormalsOfASphereAreRadial) {
  const Points points = sphere(4000, 4).cloud();
  const LocalGeometry geometry = localGeometry(points, *makeFlannSearch(points), 8, 0);
  // Eight neighbours span a cap of angle sqrt(8 * 4 / 4000) = 0.09; the fitted normal is off by a fraction of it.
  double mean = 0.0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    EXPECT_NEAR(geometry.normals.col(i).norm(), 1.0f, 1e-5f);
    const double cosine = std::abs(geometry.normals.col(i).dot(points.col(i)));
    mean += std::acos(std::min(1.0, cosine)) / static_cast<double>(points.cols());
  }
  EXPECT_LT(mean, 0.5 * 0.09);
}

TEST(LocalGeometry, NormalsOfAPlaneAreExact) {
  const ReflectionPlane plane(Eigen::Vector3d(1.0, 2.0, -0.5), 0.3);
  const Eigen::Vector3d u = plane.normal().unitOrthogonal(), v = plane.normal().cross(u);
  RandomStream random(5);
  Points points(3, 500);
  for (int i = 0; i < 500; ++i)
    points.col(i) = (symmetric(random) * u + symmetric(random) * v + plane.offset() * plane.normal()).cast<float>();
  const LocalGeometry geometry = localGeometry(points, *makeFlannSearch(points), 8, 1);
  for (int i = 0; i < 500; ++i)
    EXPECT_GT(std::abs(geometry.normals.col(i).cast<double>().dot(plane.normal())), 1.0 - 1e-4) << i;
}

TEST(LocalGeometry, SpacingMeasuresDensity) {
  // spacing^2 * density = pi r_k^2 density / k; the count within r is Poisson, so that pi r_k^2 density is Gamma(k)
  // with mean k: the mean of the ratio is 1, that of n samples of 8 neighbours each (every point counts in about 8
  // neighbourhoods, so there are n / 8 independent ones) has a standard error of about 1 / sqrt(n).
  for (const int num_points : {2000, 8000}) {
    const Points points = sphere(num_points, 6).cloud();
    const LocalGeometry geometry = localGeometry(points, *makeFlannSearch(points), 8, 0);
    const double density = num_points / (4.0 * kPi);
    double mean = 0.0;
    for (const float spacing : geometry.spacing) mean += spacing * spacing * density / num_points;
    EXPECT_NEAR(mean, 1.0, 4.0 / std::sqrt(num_points)) << num_points;
  }
}

TEST(LocalGeometry, OfFewOrCoincidentPointsIsDefined) {
  for (const Points& points : {Points(Points::Constant(3, 1, 1.0f)), Points(Points::Constant(3, 20, 1.0f)),
                               Points((Points(3, 2) << 0, 1, 0, 0, 0, 0).finished())}) {
    const LocalGeometry geometry = localGeometry(points, *makeFlannSearch(points), 8, 1);
    ASSERT_EQ(geometry.normals.cols(), points.cols());
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      EXPECT_NEAR(geometry.normals.col(i).norm(), 1.0f, 1e-5f);
      EXPECT_TRUE(std::isfinite(geometry.spacing[i]));
    }
  }
}

TEST(LocalGeometry, SameBytesForAnyNumberOfThreads) {
  const Points points = asymmetricBlob(3000, 7).cloud();
  const auto search = makeFlannSearch(points);
  const LocalGeometry one = localGeometry(points, *search, 8, 1);
  for (const int num_threads : {2, 8}) {
    const LocalGeometry many = localGeometry(points, *search, 8, num_threads);
    EXPECT_EQ(many.normals, one.normals);
    EXPECT_EQ(many.spacing, one.spacing);
  }
}

TEST(SampleTriangles, SpreadsPointsByArea) {
  // Two triangles of areas 1 and 3: one point in each of equal shares of the area, so that the counts are exact.
  const Points vertices = (Points(3, 5) << 0, 2, 0, 6, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1).finished();
  const Points points = sampleTriangles(vertices, {{0, 1, 2}, {0, 3, 4}}, 4000);
  ASSERT_EQ(points.cols(), 4000);
  int num_first = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3f p = points.col(i);
    const bool first = i < 1000;  // in the order of the triangles
    num_first += first;
    if (first) {
      EXPECT_EQ(p.z(), 0.0f);
      EXPECT_LE(0.5f * p.x() + p.y(), 1.0f + 1e-6f);
      mean += p.cast<double>() / 1000.0;
    } else {
      EXPECT_EQ(p.y(), 0.0f);
      EXPECT_LE(p.x() / 6.0f + p.z(), 1.0f + 1e-6f);
    }
    EXPECT_GE(p.minCoeff(), 0.0f);
  }
  // Uniform in the triangle: its centroid, with standard deviations of 2 / sqrt(18 * 1000) and half of it.
  EXPECT_NEAR(mean.x(), 2.0 / 3.0, 4.0 * 0.015);
  EXPECT_NEAR(mean.y(), 1.0 / 3.0, 4.0 * 0.0075);
  EXPECT_EQ(sampleTriangles(vertices, {{0, 1, 2}, {0, 3, 4}}, 4000), points);
  EXPECT_NE(sampleTriangles(vertices, {{0, 1, 2}, {0, 3, 4}}, 4000, 2), points);
}

TEST(SampleTriangles, LeavesOutWhatIsNotFinite) {
  Points vertices = (Points(3, 4) << 0, 2, 0, 1, 0, 0, 1, 1, 0, 0, 0, 1).finished();
  vertices(0, 3) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(sampleTriangles(vertices, {{0, 1, 2}, {0, 1, 3}}, 100).allFinite());
}

TEST(SampleTriangles, RefusesWhatHasNoSurface) {
  const Points vertices = (Points(3, 3) << 0, 2, 1, 0, 0, 0, 0, 0, 0).finished();
  EXPECT_THROW(sampleTriangles(vertices, {{0, 1, 2}}, 10), std::invalid_argument);  // on a line
  EXPECT_THROW(sampleTriangles(vertices, {}, 10), std::invalid_argument);
  EXPECT_THROW(sampleTriangles(vertices, {{0, 1, 3}}, 10), std::invalid_argument);
  EXPECT_THROW(sampleTriangles(vertices, {{0, -1, 2}}, 10), std::invalid_argument);
}

TEST(PlaneSupport, IsOneOnTheSurfaceAndFallsOffIt) {
  // A square lattice of spacing 0.1: along the surface the support is 1 up to 1.25 spacings from the nearest sample,
  // across it up to 0.01 of the radius; beyond both it falls as a Gaussian of the excess.
  Points lattice(3, 41 * 41);
  for (int i = 0; i < 41 * 41; ++i) lattice.col(i) << 0.1f * (i % 41 - 20), 0.1f * (i / 41 - 20), 0.0f;
  const double radius = boundingBall(lattice).radius;
  const ReflectionPlane plane(Eigen::Vector3d::UnitX(), 0.0);
  const auto supportAt = [&](double x, double z) {
    const Points point = Eigen::Vector3d(x, 0.03, z).cast<float>();
    return planeSupport(point, lattice, plane, 1)[0];
  };
  EXPECT_EQ(supportAt(0.97, 0.0), 1.0f);
  EXPECT_EQ(supportAt(0.97, 0.009 * radius), 1.0f);
  EXPECT_NEAR(supportAt(0.97, 0.02 * radius), std::exp(-1.0f), 1e-3f);
  EXPECT_EQ(supportAt(2.1, 0.0), 1.0f);
  EXPECT_GT(supportAt(2.2, 0.0), supportAt(2.3, 0.0));
  EXPECT_LT(supportAt(3.0, 0.0), 1e-3f);
}

TEST(PlaneSupport, OfASymmetryIsThatOfASecondSample) {
  // 1 in 130 lies beyond the reach along the surface, where the second sample is independent.
  const Shape shape = box(6000, Sampling::Random, 8);
  const Points points = shape.cloud();
  for (const ReflectionPlane& plane : shape.planes) {
    const std::vector<float> support = planeSupport(points, points, plane, 1);
    const double mean = std::accumulate(support.begin(), support.end(), 0.0) / static_cast<double>(support.size());
    EXPECT_GT(mean, 1.0 - 1.0 / 130.0);
    EXPECT_EQ(planeSupport(points, points, plane, 8), support);
  }
  const std::vector<float> wrong = planeSupport(points, points, ReflectionPlane({1.0, 1.0, 0.0}, 0.0), 1);
  EXPECT_LT(std::accumulate(wrong.begin(), wrong.end(), 0.0) / static_cast<double>(wrong.size()), 0.7);
}

}  // namespace
