#include "pcl_symmetry/viewpoint_selection.h"

#include <gtest/gtest.h>

#include "core/geometry/directions.h"
#include "pcl/clouds.h"
#include "pcl_symmetry/symmetry_maxima_refinement.h"

namespace pcl_symmetry {
namespace {

using namespace test;

ViewpointSelection selectionOf(const Shape& shape) {
  const auto cloud = toCloud(shape);
  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  refinement.setInputCloud(cloud);
  ViewpointSelection selection;
  selection.setPlanes(refinement.compute(), refinement.getAxes());
  selection.setInputCloud(cloud);
  return selection;
}

SymmetryPlane plane(const Eigen::Vector3d& normal, double score) {
  SymmetryPlane result(ReflectionPlane(normal, 0.0));
  result.kind = PlaneKind::Symmetry;
  result.score = score;
  return result;
}

TEST(ViewpointSelection, BestViewOfABoxIsItsDiagonalDirection) {
  const ViewpointSelection selection = selectionOf(box(10'000, Sampling::Random, 5));
  const SelectedView best = selection.getBestView();
  // Three planes of score near 1: (1, 1, 1) / sqrt(3), in one of eight octants; the scores differ by less than 5 %.
  EXPECT_LT((best.direction.cwiseAbs() - Eigen::Vector3d::Constant(1.0 / std::sqrt(3.0))).norm(), 0.05);
  EXPECT_GT(best.direction.z(), 0.0) << "from above";
  // Along two of its planes.
  EXPECT_GT(selection.getWorstView().direction.cwiseAbs().maxCoeff(), 0.999);
  EXPECT_DOUBLE_EQ(best.score, selection.getScore(best.direction));
  const std::vector<SelectedView> good = selection.getGoodViews(5);
  ASSERT_EQ(good.size(), 1u) << "the other seven show the same again";
  EXPECT_EQ(good[0].direction, best.direction);
}

TEST(ViewpointSelection, CameraLooksAtTheObjectAndStandsUpright) {
  const Eigen::Isometry3d pose = randomPose(6);
  const Shape shape = moved(box(5'000, Sampling::Random, 5), pose);
  ViewpointSelection selection;
  selection.setPlanes({plane(pose.linear().col(0), 1.0), plane(pose.linear().col(1), 0.9)});
  selection.setInputCloud(toCloud(shape));
  const Eigen::Vector3d said = pose.linear() * Eigen::Vector3d(0.2, 0.2, 1.0);
  selection.setUp(said);
  EXPECT_LT((selection.getUpAxis() - pose.linear().col(2)).norm(), 1e-9) << "the third axis, across the two planes";
  for (const Eigen::Vector3d& direction : evenDirections(40)) {
    const Eigen::Affine3d camera = selection.computePose(direction).cast<double>();
    EXPECT_NEAR(camera.linear().determinant(), 1.0, 1e-5);
    EXPECT_LT((camera.linear().col(2) + direction).norm(), 1e-5) << "forward is toward the object";
    EXPECT_GE(-camera.linear().col(1).dot(selection.getUpAxis()), -1e-5) << "y is down";
    EXPECT_NEAR(camera.linear().col(0).dot(selection.getUpAxis()), 0.0,
                std::abs(direction.dot(selection.getUpAxis())) < 0.98 ? 1e-5 : 1.0)
        << "x is level";
    const Eigen::Matrix3Xd seen = camera.inverse() * shape.points;
    const Eigen::ArrayXd tangent = seen.topRows<2>().colwise().norm().array() / seen.row(2).array();
    EXPECT_LE(tangent.maxCoeff(), std::tan(12.5 * kDegree) + 1e-4) << "all in a view of 25 degrees";
    EXPECT_GT(tangent.maxCoeff(), 0.5 * std::tan(12.5 * kDegree));
  }
}

TEST(ViewpointSelection, ShowsWhatIsHiddenLeast) {
  // An open cup on z: rim up. Of the two views at equal S the one into it is taken, and the sides are seen from above.
  const Points cup = pointsWhere(cylinder(20'000, 4).cloud(), [](const Eigen::Vector3f& x) { return x.z() <= 0.999f; });
  ViewpointSelection selection;
  selection.setPlanes({plane(Eigen::Vector3d::UnitX(), 1.0), plane(Eigen::Vector3d::UnitZ(), 1.0)});
  selection.setInputCloud(toCloud(cup));
  selection.setUp(Eigen::Vector3d::UnitY());
  EXPECT_GT(selection.getBestView().direction.z(), 0.0);
}

TEST(ViewpointSelection, MaximaCountInDirectionsThatNoPlaneCovers) {
  const auto maximum = [](const Eigen::Vector3d& normal, double value) {
    return LocalMaximum{{0, 0, 0}, ReflectionPlane(normal, 0.0), value};
  };
  const std::vector<LocalMaximum> maxima{maximum({0.9, 0.1, 0.0}, 0.7), maximum({0.0, 0.0, 1.0}, 0.6),
                                         maximum({0.0, 0.3, 1.0}, 0.5)};
  ViewpointSelection selection;
  selection.setPlanes({plane(Eigen::Vector3d::UnitX(), 0.8)}, {}, maxima);
  EXPECT_DOUBLE_EQ(selection.getScore(Eigen::Vector3d::UnitX()), 0.8);
  EXPECT_DOUBLE_EQ(selection.getScore(Eigen::Vector3d::UnitZ()), 0.6);
  EXPECT_DOUBLE_EQ(selection.getScore(Eigen::Vector3d::UnitY()), 0.0);
  // Planes that are seen from everywhere need no others.
  selection.setPlanes({plane({1, 0, 0}, 0.8), plane({1, 1, 0.3}, 0.8), plane({1, 0.3, 1}, 0.8)}, {}, maxima);
  const double of_three = selection.getScore(Eigen::Vector3d::UnitZ());
  selection.setPlanes({plane({1, 0, 0}, 0.8), plane({1, 1, 0.3}, 0.8), plane({1, 0.3, 1}, 0.8)});
  EXPECT_DOUBLE_EQ(of_three, selection.getScore(Eigen::Vector3d::UnitZ()));
}

TEST(ViewpointSelection, WithoutPlanesShowsTheObjectObliquely) {
  ViewpointSelection selection;
  selection.setInputCloud(toCloud(sphere(500, 1)));
  EXPECT_GT(selection.getBestView().direction.z(), 0.2);
  EXPECT_NO_THROW(selection.getWorstView());
}

TEST(ViewpointSelection, AnObjectWithoutExtentHasNoViews) {
  ViewpointSelection selection;
  selection.setPlanes({plane(Eigen::Vector3d::UnitX(), 1.0)});
  for (const pcl::PointCloud<pcl::PointXYZ>::Ptr& cloud :
       {pcl::PointCloud<pcl::PointXYZ>::Ptr(), pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>(),
        pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>(30, 1, pcl::PointXYZ(1.0f, 2.0f, 3.0f))}) {
    selection.setInputCloud(cloud);
    EXPECT_TRUE(selection.getGoodViews(3).empty());
    EXPECT_EQ(selection.getBestView().score, 0.0);
    EXPECT_EQ(selection.getWorstView().direction.norm(), 0.0);
  }
}

TEST(ViewpointSelection, RefusesDirectionsWithoutLength) {
  EXPECT_EQ(messageOf([] { ViewpointSelection().computePose(Eigen::Vector3d::Zero()); }),
            "direction = 0 0 0, must be finite and not zero");
}

}  // namespace
}  // namespace pcl_symmetry
