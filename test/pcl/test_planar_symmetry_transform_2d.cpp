#include "pcl_symmetry/planar_symmetry_transform_2d.h"

#include <gtest/gtest.h>

#include "pcl/clouds.h"
#include "shapes/contours.h"

namespace pcl_symmetry {
namespace {

using namespace test;
using Transform = PlanarSymmetryTransform2D<pcl::PointXYZ>;

pcl::PointCloud<pcl::PointXYZ>::Ptr toSheet(const Points2D& contour, const Eigen::Isometry3d& pose) {
  Shape shape{Eigen::Matrix3Xd::Zero(3, contour.cols()), {}};
  shape.points.topRows<2>() = contour.cast<double>();
  return toCloud(moved(shape, pose));
}

TEST(PlanarSymmetryTransform2D, LinesOfATiltedRectangleArePlanesAcrossItsSheet) {
  const Eigen::Isometry3d pose = randomPose(4);
  Transform transform;
  transform.setInputCloud(withHoles(*toSheet(rectangle(1.6, 0.9), pose), 9));
  const LineMap map = transform.compute();
  EXPECT_EQ(map.values.size(), 128u * 128u);
  ASSERT_GE(transform.getLines().size(), 2u);
  for (const Eigen::Vector3d& normal : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0)}) {
    const ReflectionPlane expected = ReflectionPlane(normal, 0.0).transformed(pose);
    const ReflectionPlane first = transform.getPlane(transform.getLines()[0].line);
    const ReflectionPlane second = transform.getPlane(transform.getLines()[1].line);
    const PlaneError error =
        planeError(first.angleTo(expected) < second.angleTo(expected) ? first : second, expected, pose.translation());
    EXPECT_LT(error.angle, 0.2 * kDegree);
    EXPECT_LT(error.offset, 0.003);
  }
}

TEST(PlanarSymmetryTransform2D, HonorsIndicesAndTheGivenWidth) {
  const auto cloud = toSheet(rectangle(1.6, 0.9, 800), Eigen::Isometry3d::Identity());
  cloud->emplace_back(9.0f, 3.0f, 0.0f);
  Transform transform;
  transform.setInputCloud(cloud);
  pcl::IndicesPtr indices(new pcl::Indices(800));
  for (int i = 0; i < 800; ++i) (*indices)[i] = i;
  transform.setIndices(indices);
  transform.setSigma(0.05);
  EXPECT_EQ(transform.compute().sigma, 0.05);
  EXPECT_NEAR(transform.getDistanceTransform()->radius(), 0.5 * std::hypot(1.6, 0.9), 0.02);
  EXPECT_EQ(transform.getSheetPoints().cols(), 800);
}

}  // namespace
}  // namespace pcl_symmetry
