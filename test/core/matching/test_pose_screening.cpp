#include "core/matching/pose_screening.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/base/random.h"

namespace pcl_symmetry {

namespace {

/// Points spread over the faces of a box about the origin, as many to each unit of area.
Points pointsOfBox(const Eigen::Vector3d& half, int count, std::uint64_t seed) {
  RandomStream random(seed);
  const Eigen::Vector3d areas(half.y() * half.z(), half.z() * half.x(), half.x() * half.y());
  Points points(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double at = random.uniform() * areas.sum();
    const int axis = at < areas.x() ? 0 : at < areas.x() + areas.y() ? 1 : 2;
    Eigen::Vector3d x = Eigen::Vector3d::NullaryExpr([&] { return 2.0 * random.uniform() - 1.0; });
    x[axis] = x[axis] < 0.0 ? -1.0 : 1.0;
    points.col(i) = x.cwiseProduct(half).cast<float>();
  }
  return points;
}

ScreenedSurface screenedBox(const Eigen::Vector3d& half) {
  return ScreenedSurface(evenSurfacePoints(pointsOfBox(half, 5000, 1), matching_rules.num_screened_points, 1));
}

const Eigen::Vector3d kBoxes[] = {{1.0, 0.6, 0.3}, {0.8, 0.8, 0.5}, {1.2, 0.2, 0.4}};

Eigen::Isometry3d scannedBox(double scale) {
  Eigen::Isometry3d T_shape_scan(Eigen::AngleAxisd(0.9, Eigen::Vector3d(0.2, 0.5, -0.8).normalized()));
  T_shape_scan.translation() = scale * Eigen::Vector3d(4.0, -2.0, 1.0);
  return T_shape_scan;
}

/// What is on one side of an oblique plane: the ends of the box and other corners are missing.
SurfacePoints scanOfHalfABox(const Eigen::Vector3d& half, double scale) {
  const Points all = pointsOfBox(half, 6000, 2);
  std::vector<int> kept;
  for (Eigen::Index i = 0; i < all.cols(); ++i)
    if (all(0, i) + 0.3f * all(1, i) - 0.4f * all(2, i) > 0.0f) kept.push_back(static_cast<int>(i));
  Points points(3, static_cast<Eigen::Index>(kept.size()));
  for (std::size_t i = 0; i < kept.size(); ++i)
    points.col(static_cast<Eigen::Index>(i)) =
        (scannedBox(scale).inverse() * Eigen::Vector3d(scale * all.col(kept[i]).cast<double>())).cast<float>();
  return evenSurfacePoints(points, 120, 1);
}

/// A box is the same after half turns about its axes.
double angleUpToHalfTurns(const Eigen::Matrix3d& rotation) {
  double least = Eigen::AngleAxisd(rotation).angle();
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Matrix3d turn = (2.0 * Eigen::Vector3d::Unit(axis) - Eigen::Vector3d::Ones()).asDiagonal();
    least = std::min(least, Eigen::AngleAxisd(Eigen::Matrix3d(rotation * turn)).angle());
  }
  return least;
}

/// Poses anywhere, behind the given ones.
std::vector<Eigen::Isometry3d> amongOthers(std::vector<Eigen::Isometry3d> poses, int count, double scale) {
  RandomStream random(5);
  const auto direction = [&] {
    return Eigen::Vector3d(Eigen::Vector3d::NullaryExpr([&] { return 2.0 * random.uniform() - 1.0; }));
  };
  for (int i = 0; i < count; ++i) {
    Eigen::Isometry3d pose = scannedBox(scale);
    pose.prerotate(Eigen::AngleAxisd(0.8 + 2.0 * random.uniform(), direction().normalized()));
    pose.pretranslate(Eigen::Vector3d(0.5 * scale * direction()));
    poses.insert(poses.begin(), pose);
  }
  return poses;
}

}  // namespace

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
      options.most_behind = 2.0;  // no shape is left out
      const auto found = screenPoses(ScreenedSurface(scanOfHalfABox(kBoxes[k], scale)), shapes, options);
      ASSERT_EQ(found.size(), 2u);
      EXPECT_EQ(found[0].shape, k) << scale;
      ASSERT_GE(found[0].T_shape_scan.size(), 1u);
      EXPECT_LE(found[0].T_shape_scan.size(), 3u);
      const Eigen::Isometry3d error = found[0].T_shape_scan[0] * scannedBox(scale).inverse();
      // derived: the start is off by 0.2 radians; points of a box of 1.2 radii are 0.06 apart.
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
  PoseScreeningOptions options;
  options.least_shapes = 1;
  EXPECT_EQ(screenPoses(scan, shapes, options).size(), 1u) << "the wide box is far behind";
  options.most_behind = 2.0;
  EXPECT_EQ(screenPoses(scan, shapes, options).size(), 2u);
}

TEST(PoseScreening, ThreadsDoNotChangeIt) {
  std::vector<ScreenedSurface> boxes;
  for (const Eigen::Vector3d& half : kBoxes) boxes.push_back(screenedBox(half));
  std::vector<PosesOfShape> shapes;
  for (const ScreenedSurface& box : boxes) shapes.push_back({&box, amongOthers({scannedBox(1.0)}, 200, 1.0)});
  const ScreenedSurface scan(scanOfHalfABox(kBoxes[1], 1.0));
  std::vector<ScreenedShape> found[2];
  for (int i = 0; i < 2; ++i) {
    PoseScreeningOptions options;
    options.num_threads = 1 + 3 * i;
    found[i] = screenPoses(scan, shapes, options);
    ASSERT_EQ(found[i].size(), 3u);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(found[0][k].shape, found[1][k].shape);
    ASSERT_EQ(found[0][k].T_shape_scan.size(), found[1][k].T_shape_scan.size());
    for (std::size_t i = 0; i < found[0][k].T_shape_scan.size(); ++i)
      EXPECT_EQ(found[0][k].T_shape_scan[i].matrix(), found[1][k].T_shape_scan[i].matrix());
  }
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

}  // namespace pcl_symmetry
