/// What recognizes a scan: pairs of its points, and codes of views.
#include "core/matching/point_pair_index.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/random.h"
#include "core/matching/matching_rules.h"
#include "core/matching/pose_screening.h"
#include "core/matching/view_code.h"
#include "shapes/scans.h"
#include "shapes/threads.h"

namespace pcl_symmetry {
namespace {

/// Points spread over an ellipsoid with a lump on it.
Points lumpyEllipsoid(const Eigen::Vector3d& half, int count, std::uint64_t seed) {
  Points points(3, count);
  RandomStream random(seed);
  for (Eigen::Index i = 0; i < count; ++i) {
    Eigen::Vector3d x =
        Eigen::Vector3d::NullaryExpr([&] { return random.uniform() + random.uniform() + random.uniform() - 1.5; })
            .normalized()
            .cwiseProduct(half);
    if (i % 5 == 0) x = Eigen::Vector3d(0.5 * half.x(), 0.3 * half.y(), half.z()) + 0.35 * x;
    points.col(i) = x.cast<float>();
  }
  return points;
}

const Eigen::Vector3d kHalves[] = {
    {1.0, 0.6, 0.3}, {0.5, 0.5, 0.9}, {1.2, 0.3, 0.3}, {0.8, 0.8, 0.15}, {0.7, 0.4, 0.7}};

std::vector<SurfacePoints> shapes(double scale) {
  std::vector<SurfacePoints> made;
  for (const Eigen::Vector3d& half : kHalves)
    made.push_back(evenSurfacePoints(scale * lumpyEllipsoid(half, 4000, 1), kMatching.num_pair_points, 1));
  return made;
}

Eigen::Isometry3d motion(double angle, const Eigen::Vector3d& axis, const Eigen::Vector3d& translation) {
  return Eigen::Translation3d(translation) * Eigen::AngleAxisd(angle, axis.normalized());
}

Eigen::Isometry3d elsewhere(double scale) {
  return motion(1.1, {0.3, -0.8, 0.5}, scale * Eigen::Vector3d(3.0, -1.0, 2.0));
}

/// The points that are kept, scaled and then moved.
template <typename IsKept>
Points scaledPart(const Points& all, double scale, const Eigen::Isometry3d& motion, const IsKept& is_kept) {
  return test::moved(static_cast<float>(scale) * test::pointsWhere(all, is_kept), motion);
}

/// The side of a shape that faces a viewer above it, without what lies beyond a plane: about half of what is
/// seen.
Points halfHidden(const Eigen::Vector3d& half, double scale) {
  return scaledPart(lumpyEllipsoid(half, 6000, 2), scale, elsewhere(scale),
                    [](const Eigen::Vector3f& x) { return x.z() > 0.0f && x.x() > 0.0f; });
}

/// \return at the best of the poses, how far points of a scan are from the closest one of a shape. The 250 points of a shape
/// of 5 units of area are 0.14 apart, so that points of its own surface are 0.05 off.
double leastMeanDistance(const Points& scan, const std::vector<Eigen::Isometry3d>& poses, const Points& shape) {
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Isometry3d& pose : poses) {
    std::vector<double> distances;
    const Points placed = test::moved(scan, pose);
    for (Eigen::Index i = 0; i < placed.cols(); ++i)
      distances.push_back((shape.colwise() - placed.col(i)).colwise().norm().minCoeff());
    least = std::min(least, test::meanOf(distances));
  }
  return least;
}

TEST(SurfacePoints, AreSpreadEvenly) {
  const Points points = lumpyEllipsoid(kHalves[0], 4000, 1);
  const SurfacePoints few = evenSurfacePoints(points, 200, 1);
  EXPECT_LE(few.points.cols(), 200);
  EXPECT_GT(few.points.cols(), 150);
  float least = 1.0f;
  for (Eigen::Index i = 0; i < few.points.cols(); ++i) {
    EXPECT_NEAR(few.normals.col(i).norm(), 1.0f, 1e-4f);
    for (Eigen::Index j = 0; j < i; ++j) least = std::min(least, (few.points.col(i) - few.points.col(j)).norm());
  }
  // Of 200 points drawn at random on 5 units of area, two would be within sqrt(5 / (pi 200^2 / 2)) = 0.01.
  EXPECT_GT(least, 0.05f);
  EXPECT_EQ(evenSurfacePoints(points.leftCols(50), 200, 1).points.cols(), 50);
  const std::vector<SurfacePoints> both = evenSurfacePoints(points, {100, 200}, 1);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_LE(both[0].points.cols(), 100);
  EXPECT_EQ(both[1].points, few.points);
  EXPECT_EQ(both[1].normals, few.normals);
}

TEST(PointPairIndex, FindsShapesOfWhichHalfIsHidden) {
  for (const double scale : {1.0, 1e-3, 1e4}) {
    const std::vector<SurfacePoints> made = shapes(scale);
    const PointPairIndex index(made, 1);
    ASSERT_EQ(index.numShapes(), 5);
    for (int k = 0; k < 5; ++k) {
      const SurfacePoints scan = evenSurfacePoints(halfHidden(kHalves[k], scale), kMatching.num_scan_points, 1);
      const std::vector<ShapeOfPairs> found = index.nearest(scan);
      ASSERT_EQ(found.size(), 5u);
      EXPECT_EQ(found[0].shape, k) << scale;
      ASSERT_GE(found[0].T_shape_scan.size(), 1u);
      EXPECT_LE(found[0].T_shape_scan.size(), 6u);
      EXPECT_LT(leastMeanDistance(scan.points, found[0].T_shape_scan, made[static_cast<std::size_t>(k)].points),
                0.1 * scale)
          << k;
    }
  }
}

TEST(PointPairIndex, ThreadsDoNotChangeIt) {
  const SurfacePoints scan = evenSurfacePoints(halfHidden(kHalves[1], 1.0), kMatching.num_scan_points, 1);
  test::compareThreads([&](int num_threads) {
    PairSearchOptions options;
    options.num_nearest = 3;
    options.num_poses = 2;
    options.num_threads = num_threads;
    const std::vector<ShapeOfPairs> found = PointPairIndex(shapes(1.0), num_threads).nearest(scan, options);
    EXPECT_EQ(found.size(), 3u);
    for (const ShapeOfPairs& shape : found) EXPECT_EQ(shape.T_shape_scan.size(), 2u);
    return test::valuesOf(found, &ShapeOfPairs::shape, &ShapeOfPairs::votes,
                          [](const ShapeOfPairs& shape) { return test::matricesOf(shape.T_shape_scan); });
  });
}

TEST(PointPairIndex, DegenerateShapesAreFoundByNoPair) {
  const Points same = Points::Constant(3, 30, 2.0f);
  std::vector<SurfacePoints> with = shapes(1.0);
  with.push_back(evenSurfacePoints(same, 20, 1));
  const PointPairIndex index(with, 1);
  const SurfacePoints scan = evenSurfacePoints(halfHidden(kHalves[0], 1.0), kMatching.num_scan_points, 1);
  EXPECT_EQ(index.nearest(scan).front().shape, 0);
  EXPECT_EQ(index.nearest(scan).back().votes, 0.0);
  for (const ShapeOfPairs& shape : index.nearest(evenSurfacePoints(same, 20, 1))) EXPECT_EQ(shape.votes, 0.0);
  EXPECT_TRUE(PointPairIndex({}, 1).nearest(scan).empty());
}

ScreenedSurface screenedBox(const Eigen::Vector3d& half) {
  return ScreenedSurface(
      evenSurfacePoints(test::box(half, 5000, test::Sampling::Random, 1).cloud(), kMatching.num_screened_points, 1));
}

const Eigen::Vector3d kBoxes[] = {{1.0, 0.6, 0.3}, {0.8, 0.8, 0.5}, {1.2, 0.2, 0.4}};

Eigen::Isometry3d scannedBox(double scale) {
  return motion(0.9, {0.2, 0.5, -0.8}, scale * Eigen::Vector3d(4.0, -2.0, 1.0));
}

/// What is on one side of an oblique plane: the ends of the box and other corners are missing.
SurfacePoints scanOfHalfABox(const Eigen::Vector3d& half, double scale) {
  const auto is_kept = [](const Eigen::Vector3f& x) { return x.x() + 0.3f * x.y() - 0.4f * x.z() > 0.0f; };
  const Points box = test::box(half, 6000, test::Sampling::Random, 2).cloud();
  return evenSurfacePoints(scaledPart(box, scale, scannedBox(scale).inverse(), is_kept), 120, 1);
}

/// A box is the same after half turns about its axes.
double angleUpToHalfTurns(const Eigen::Matrix3d& rotation) {
  double least = test::angleOf(rotation);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Matrix3d turn = (2.0 * Eigen::Vector3d::Unit(axis) - Eigen::Vector3d::Ones()).asDiagonal();
    least = std::min(least, test::angleOf(rotation * turn));
  }
  return least;
}

/// Poses anywhere, behind the given ones.
std::vector<Eigen::Isometry3d> amongOthers(std::vector<Eigen::Isometry3d> poses, int count, double scale) {
  RandomStream random(5);
  for (int i = 0; i < count; ++i) {
    Eigen::Isometry3d pose = scannedBox(scale);
    pose.prerotate(Eigen::AngleAxisd(0.8 + 2.0 * random.uniform(), test::randomDirection(random)));
    pose.pretranslate(Eigen::Vector3d(0.5 * scale * test::randomPoint(random)));
    poses.insert(poses.begin(), pose);
  }
  return poses;
}

TEST(PoseScreening, FindsTheShapeAndImprovesItsPose) {
  for (const double scale : {1.0, 1e-3, 1e4}) {
    std::vector<ScreenedSurface> boxes;
    for (const Eigen::Vector3d& half : kBoxes) boxes.push_back(screenedBox(scale * half));
    for (int k = 0; k < 3; ++k) {
      Eigen::Isometry3d rough = scannedBox(scale);
      rough.prerotate(Eigen::AngleAxisd(0.2, Eigen::Vector3d(-0.6, 0.0, 0.8)));
      rough.pretranslate(Eigen::Vector3d(scale * Eigen::Vector3d(0.08, -0.05, 0.06)));
      std::vector<PosesOfShape> shapes;
      for (const ScreenedSurface& box : boxes) shapes.push_back({&box, amongOthers({rough}, 40, scale)});
      PoseScreeningOptions options;
      options.num_shapes = 2;
      options.num_poses = 3;
      options.max_behind = 2.0;  // no shape is left out
      const auto found = screenPoses(ScreenedSurface(scanOfHalfABox(kBoxes[k], scale)), shapes, options);
      ASSERT_EQ(found.size(), 2u);
      EXPECT_EQ(found[0].shape, k) << scale;
      ASSERT_GE(found[0].T_shape_scan.size(), 1u);
      EXPECT_LE(found[0].T_shape_scan.size(), 3u);
      const Eigen::Isometry3d error = found[0].T_shape_scan[0] * scannedBox(scale).inverse();
      // The start is off by 0.2 radians; points of a box of 1.2 radii are 0.06 apart.
      EXPECT_LT(angleUpToHalfTurns(error.linear()), 0.1) << k;
      EXPECT_LT(error.translation().norm(), 0.06 * scale) << k;
    }
  }
}

TEST(PoseScreening, ShapesThatFillEmptySpaceAreLeftBehind) {
  // The upper face of a box above a floor, seen from above: it fits on the middle of a wider one, but for the space
  // beside it.
  const Eigen::Vector3d half(0.5, 0.4, 0.3), wide(1.0, 0.9, 0.3);
  Points scene(3, 2 * 60 * 60);
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 60; ++j) {
      const Eigen::Vector3d at(i / 29.5 - 1.0, j / 29.5 - 1.0, 1.0);
      scene.col(60 * i + j) = at.cwiseProduct(half).cast<float>();
      scene.col(60 * 60 + 60 * i + j) = Eigen::Vector3f(3.0f, 3.0f, -1.0f).cwiseProduct(at.cast<float>());
    }
  const auto seen = Visibility::ofScene(scene, {0.0, 0.0, 6.0});
  ASSERT_TRUE(seen);
  EXPECT_LT(seen->depthBehind({0.8, 0.1, 0.3}), 0.0);
  const Points face = scene.leftCols(60 * 60);
  const ScreenedSurface narrow_box = screenedBox(half), wide_box = screenedBox(wide);
  const std::vector<PosesOfShape> shapes = {{&wide_box, {Eigen::Isometry3d::Identity()}},
                                            {&narrow_box, {Eigen::Isometry3d::Identity()}}};
  const ScreenedSurface scan(evenSurfacePoints(face, 120, 1), seen);
  const auto found = screenPoses(scan, shapes);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].shape, 1);
  EXPECT_EQ(screenPoses(scan, {shapes[0], shapes[0], shapes[1]}).size(), 2u) << "one that is far behind is kept";
  PoseScreeningOptions options;
  options.min_shapes = 1;
  EXPECT_EQ(screenPoses(scan, shapes, options).size(), 1u) << "the wide box is far behind";
  options.max_behind = 2.0;
  EXPECT_EQ(screenPoses(scan, shapes, options).size(), 2u);
}

TEST(PoseScreening, ThreadsDoNotChangeIt) {
  std::vector<ScreenedSurface> boxes;
  for (const Eigen::Vector3d& half : kBoxes) boxes.push_back(screenedBox(half));
  std::vector<PosesOfShape> shapes;
  for (const ScreenedSurface& box : boxes) shapes.push_back({&box, amongOthers({scannedBox(1.0)}, 200, 1.0)});
  const ScreenedSurface scan(scanOfHalfABox(kBoxes[1], 1.0));
  test::compareThreads([&](int num_threads) {
    PoseScreeningOptions options;
    options.num_threads = num_threads;
    options.max_behind = 2.0;  // no shape is left out
    const std::vector<ScreenedShape> found = screenPoses(scan, shapes, options);
    EXPECT_EQ(found.size(), 3u);
    return test::valuesOf(found, &ScreenedShape::shape,
                          [](const ScreenedShape& shape) { return test::matricesOf(shape.T_shape_scan); });
  });
}

TEST(PoseScreening, WithoutPosesOrSizeThereIsNoShape) {
  const ScreenedSurface scan(scanOfHalfABox(kBoxes[0], 1.0)), box = screenedBox(kBoxes[0]);
  EXPECT_TRUE(screenPoses(scan, {}).empty());
  EXPECT_TRUE(screenPoses(scan, {{&box, {}}}).empty());
  const ScreenedSurface point(evenSurfacePoints(Points::Constant(3, 30, 2.0f), 20, 1));
  EXPECT_TRUE(screenPoses(scan, {{&point, {Eigen::Isometry3d::Identity()}}}).empty());
  PoseScreeningOptions none;
  none.num_shapes = 0;
  EXPECT_TRUE(screenPoses(scan, {{&box, {scannedBox(1.0)}}}, none).empty());
}

std::vector<std::vector<View>> viewsOfShapes(int count) {
  std::vector<std::vector<View>> shapes;
  RandomStream random(4);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d half(1.0, 0.2 + 0.8 * random.uniform(), 0.2 + 0.8 * random.uniform());
    shapes.push_back(viewsAround(lumpyEllipsoid(half, 1500, 10 + static_cast<std::uint64_t>(i)), 12, 1));
  }
  return shapes;
}

std::vector<View> joined(const std::vector<std::vector<View>>& shapes) {
  std::vector<View> views;
  for (const auto& shape : shapes) views.insert(views.end(), shape.begin(), shape.end());
  return views;
}

TEST(ViewCode, RotationsOfThePictureDoNotChangeIt) {
  const Points points = lumpyEllipsoid({1.0, 0.6, 0.3}, 1500, 1);
  const Eigen::Vector3d forward = Eigen::Vector3d(0.3, -1.0, 0.5).normalized();
  const View view = viewOf(points, forward);
  const Eigen::VectorXf own = magnitudesOf(view.values);
  ASSERT_EQ(own.size(), kViewMagnitudes);
  EXPECT_NEAR(own.norm(), 1.0, 1e-5);
  const ViewCoder coder = ViewCoder::fit(viewsAround(points, 40, 1));
  for (const double angle : {0.4, 1.7, -2.6}) {
    const Eigen::Matrix3d rotation = Eigen::AngleAxisd(angle, forward).toRotationMatrix();
    const View rotated = viewOf(rotation.cast<float>() * points, forward);
    EXPECT_GT((rotated.values - view.values).norm(), 0.3) << angle;
    EXPECT_LT((magnitudesOf(rotated.values) - own).norm(), 0.15) << angle;  // the cells of the picture
    const ViewCode a = coder.codeOf(view), b = coder.codeOf(rotated);
    for (std::size_t k = 0; k < kViewCodeSize; ++k) EXPECT_NEAR(a.values[k], b.values[k], 0.15f / kViewCodeStep);
  }
  // Magnitudes are no farther from each other than what they are the magnitudes of.
  const View other = viewOf(points, {1.0, 0.0, 0.2});
  EXPECT_LE((magnitudesOf(other.values) - own).norm(), (other.values - view.values).norm() + 1e-6f);
}

TEST(ViewCode, CoderComesBackFromItsNumbers) {
  const std::vector<View> views = joined(viewsOfShapes(4));
  const ViewCoder coder = ViewCoder::fit(views), again = ViewCoder::fromValues(coder.toValues());
  EXPECT_EQ(coder.codesOf(views), again.codesOf(views));
  EXPECT_EQ(coder.codesOf(views).size(), (kViewCodeSize + 2) * views.size());
  EXPECT_THROW(ViewCoder::fromValues(Eigen::MatrixXf::Zero(3, 3)), std::invalid_argument);
  EXPECT_THROW(ViewCoder::fit({}), std::invalid_argument);
  View huge = views[0];
  huge.radius = 1e30;
  EXPECT_EQ(coder.codeOf(huge).size, 32767) << "it ends at the greatest size";
}

TEST(ViewCodeIndex, FindsWhatAComparisonOfAllCodesFinds) {
  const auto shapes = viewsOfShapes(60);
  const ViewCoder coder = ViewCoder::fit(joined(shapes));
  ViewCodeIndex index;
  for (const auto& views : shapes) index.add(coder.codesOf(views));
  index.add("");  // a shape without views is never found
  EXPECT_EQ(index.numShapes(), 61u);
  const ViewCode scan = coder.codeOf(shapes[17][5]);
  std::vector<std::pair<double, int>> distances;
  for (int i = 0; i < 60; ++i) {
    double least = 1e9;
    for (const View& view : shapes[static_cast<std::size_t>(i)]) {
      const ViewCode code = coder.codeOf(view);
      double sum = 0.0;
      for (std::size_t k = 0; k < kViewCodeSize; ++k) sum += std::pow(code.values[k] - scan.values[k], 2.0);
      least = std::min(
          least, static_cast<double>(kViewCodeStep) * std::sqrt(sum) +
                     kMatching.size_weight * static_cast<double>(kViewSizeStep) * std::abs(code.size - scan.size));
    }
    distances.emplace_back(least, i);
  }
  std::sort(distances.begin(), distances.end());
  EXPECT_EQ(distances[0].second, 17);
  std::vector<int> expected;
  for (std::size_t i = 0; i < 10; ++i) expected.push_back(distances[i].second);
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(index.nearest(scan, 10, 1), expected);
  EXPECT_EQ(index.nearest(scan, 10, 3), expected);
  EXPECT_EQ(index.nearest(scan, 100, 1).size(), 60u);
  EXPECT_TRUE(index.nearest(scan, 0, 1).empty());
  EXPECT_THROW(index.nearest(scan, -1, 1), std::invalid_argument);
  EXPECT_THROW(index.add("12345"), std::invalid_argument);
}

/// The surface of a slab with a tower on one end, 8000 points.
Points slabWithTower(double length, double height) {
  const test::Block slab{Eigen::Vector3d::Zero(), {length, 0.5, 0.2}};
  const test::Block tower{{0.7 * length, 0.2, height}, {0.2, 0.15, height}};
  return test::surfaceOf({{slab, tower}, {}}, 8000, 3);
}

constexpr double kAngleStep = 2.0 * M_PI / 48.0;

TEST(ViewSignature, HasUnitNormAndItsSizeAndPlace) {
  const Points points = slabWithTower(1.0, 0.6);
  const View view = viewOf(points, {0.0, 0.0, -1.0});
  ASSERT_EQ(view.values.size(), kViewSignatureSize);
  EXPECT_NEAR(view.values.norm(), 1.0, 1e-5);
  // From above the outline is the slab of 2 x 1: its root mean square radius is sqrt((2^2 + 1^2) / 12).
  EXPECT_NEAR(view.radius, std::sqrt(5.0 / 12.0), 0.02);
  const Eigen::Vector3d middle = view.T_view_input.inverse() * Eigen::Vector3d::Zero();
  EXPECT_NEAR(middle.x(), 0.0, 2.0 / 48.0);  // a cell of the outline
  EXPECT_NEAR(middle.y(), 0.0, 2.0 / 48.0);
  EXPECT_GT((view.T_view_input * Eigen::Vector3d(0.0, 0.0, -5.0)).z(), 4.0);  // z points away from the viewer
}

TEST(ViewSignature, DoesNotChangeWithSizeAndPlace) {
  const Points points = slabWithTower(1.0, 0.6);
  const View view = viewOf(points, {1.0, 2.0, -1.0});
  for (const float scale : {1e-6f, 1e6f}) {
    Points scaled = scale * points;
    scaled.colwise() += scale * Eigen::Vector3f(3.0f, -2.0f, 5.0f);
    const View other = viewOf(scaled, {1.0, 2.0, -1.0});
    EXPECT_LT((view.values - other.values).norm(), 0.02) << scale;
    EXPECT_NEAR(other.radius / scale, view.radius, 1e-3 * view.radius);
  }
}

TEST(ViewSignature, ARotationOfThePictureIsFound) {
  const Points points = slabWithTower(1.0, 0.6);
  const Eigen::Vector3d forward = Eigen::Vector3d(1.0, 2.0, -3.0).normalized();
  const View view = viewOf(points, forward);
  for (const double angle : {0.0, 0.6, 2.0, -1.1, 3.1}) {
    const Eigen::Isometry3d T = motion(angle, forward, {4.0, 1.0, -2.0});
    const View rotated = viewOf(test::moved(points, T), forward);
    const ViewAgreement agreement = ViewComparison(rotated).compare(view.values.data(), 2.0f);
    EXPECT_LT(agreement.distance, 0.15f) << angle;
    const Eigen::Isometry3d pose = poseOfView(rotated, view, agreement.angle);
    EXPECT_LT(test::angleOf((pose * T).linear()), 0.5 * kAngleStep + 0.02) << angle;
    EXPECT_LT((pose * (T * Eigen::Vector3d::Zero())).norm(), 0.1) << angle;
  }
}

TEST(ViewSignature, ComparisonStopsWhereNothingNearerCanBe) {
  const View view = viewOf(slabWithTower(1.0, 0.6), {1.0, 2.0, -3.0});
  const View other = viewOf(slabWithTower(3.0, 0.2), {0.0, 1.0, 0.0});
  const ViewAgreement agreement = ViewComparison(view).compare(other.values.data(), 2.0f);
  ASSERT_GT(agreement.distance, 0.1f);
  EXPECT_EQ(ViewComparison(view).compare(other.values.data(), 0.9f * agreement.distance).distance, 2.0f);
  EXPECT_EQ(ViewComparison(view).compare(other.values.data(), 1.1f * agreement.distance).distance, agreement.distance);
}

TEST(ViewSignature, RefusesWhatCannotBeSeen) {
  const Points points = slabWithTower(1.0, 0.6);
  EXPECT_THROW(viewOf(Points(3, 0), {0, 0, 1}), std::invalid_argument);
  EXPECT_THROW(viewOf(Points(Points::Ones(3, 10)), {0, 0, 1}), std::invalid_argument);
  EXPECT_THROW(viewOf(points, Eigen::Vector3d::Zero()), std::invalid_argument);
  Points line = Points::Zero(3, 10);
  line.row(2).setLinSpaced(0.0f, 1.0f);
  EXPECT_THROW(viewOf(line, {0, 0, 1}), std::invalid_argument);
  Points bad = points;
  bad(1, 7) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(viewOf(bad, {0, 0, 1}), std::invalid_argument);
  EXPECT_THROW(viewsAround(points, 0), std::invalid_argument);
}

TEST(ViewIndex, FindsTheShapeAndItsPose) {
  ViewIndex index;
  const Points shape = slabWithTower(1.0, 0.6);
  index.add(viewsAround(slabWithTower(2.0, 0.2)));
  index.add(viewsAround(shape));
  index.add(viewsAround(slabWithTower(0.6, 1.2)));
  const Eigen::Isometry3d T_scan_shape = motion(1.3, {1.0, -0.4, 0.3}, {2.0, 0.0, 1.0});
  const View scan = viewOf(test::moved(shape, T_scan_shape), {0.3, -1.0, 0.6});
  const std::vector<ShapeOfView> found = index.nearest(scan);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found.front().shape, 1);
  EXPECT_LT(found.front().distance, found[1].distance);
  double least = M_PI;
  for (const Eigen::Isometry3d& pose : found.front().T_shape_scan)
    least = std::min(least, test::angleOf((pose * T_scan_shape).linear()));
  EXPECT_LT(least, 0.35);  // views are 20 degrees apart
}

TEST(ViewIndex, AsksForNoMoreThanItHolds) {
  ViewIndex index;
  const View view = viewOf(slabWithTower(1.0, 0.6), {0, 0, 1});
  EXPECT_TRUE(index.nearest(view).empty());
  index.add({});
  EXPECT_TRUE(index.nearest(view).empty());
  index.add({view});
  EXPECT_EQ(index.nearest(view).size(), 1u);
  EXPECT_TRUE(index.nearest(view, 0).empty());
}

TEST(ViewIndex, AnyNumberOfThreadsGivesTheSame) {
  ViewIndex index;
  for (int i = 0; i < 20; ++i) index.add(viewsAround(slabWithTower(0.5 + 0.1 * i, 0.6), 10, 1));
  const View scan = viewOf(slabWithTower(1.07, 0.6), {0.3, -1.0, 0.6});
  test::compareThreads([&](int num_threads) {
    return test::valuesOf(index.nearest(scan, 10, num_threads), &ShapeOfView::shape, &ShapeOfView::distance);
  });
}

}  // namespace
}  // namespace pcl_symmetry
