#include "pcl_symmetry/symmetry_maxima_refinement.h"

#include <gtest/gtest.h>
#include <pcl/common/io.h>
#include <pcl/search/brute_force.h>
#include <pcl/search/flann_search.h>
#include <pcl/search/octree.h>
#include <pcl/search/organized.h>
#include <pcl/search/impl/brute_force.hpp>
#include <pcl/search/impl/flann_search.hpp>

#include "pcl/clouds.h"
#include "pcl_symmetry/planar_symmetry_transform.h"
#include "pcl_symmetry/symmetry_detection.h"
#include "shapes/found_planes.h"

namespace pcl_symmetry {
namespace {

using test::expectSamePlanes;
using test::numFound;
using test::Sampling;

int numUnseen(const std::vector<float>& support) {
  return static_cast<int>(std::count_if(support.begin(), support.end(), [](float s) { return std::isnan(s); }));
}

TEST(SymmetryMaximaRefinement, HonorsIndicesAndLeavesOutPointsThatAreNotFinite) {
  const auto cloud = test::toCloud(test::box(2000, Sampling::Random, 4));
  const auto expected = detectSymmetryPlanes(*cloud);
  const auto holes = test::withHoles(*cloud, 5);
  expectSamePlanes(detectSymmetryPlanes(*holes), expected);

  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  refinement.setInputCloud(holes);
  expectSamePlanes(refinement.compute(), expected);
  const pcl::Indices& used = refinement.getUsedIndices();
  ASSERT_EQ(used.size(), cloud->size());
  // The three planes are as good as each other; one of them is taken, whichever is first.
  const auto across_z = std::max_element(expected.begin(), expected.end(), [](const auto& a, const auto& b) {
    return std::abs(a.normal().z()) < std::abs(b.normal().z());
  });
  const std::vector<float> support = refinement.computePointSupport(*across_z);
  ASSERT_EQ(support.size(), holes->size());
  for (std::size_t i = 0; i < used.size(); ++i) {
    EXPECT_TRUE(pcl::isXYZFinite((*holes)[used[i]]));
    EXPECT_NEAR(support[used[i]], across_z->point_support[i], 0.05f)
        << "the plane moved by a step that no longer mattered";
  }
  EXPECT_EQ(numUnseen(support), static_cast<int>(holes->size() - cloud->size()));
}

/// Also for points that were not used, and where the scanner could not see.
TEST(SymmetryMaximaRefinement, SupportOfEveryPointIsThatOfThePlane) {
  const auto cloud = test::pictureOf(test::scan(test::blockChair(), {3.0, -4.0, 3.0}));
  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  refinement.setInputCloud(cloud);
  refinement.setMaxPoints(2000);
  const auto planes = refinement.compute();
  ASSERT_FALSE(planes.empty());
  const std::vector<float> support = refinement.computePointSupport(planes[0]);
  double num_points = 0.0;
  std::vector<float> seen;
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    if (!pcl::isXYZFinite((*cloud)[i])) continue;
    num_points += 1.0;
    if (!std::isnan(support[i])) seen.push_back(support[i]);
  }
  EXPECT_LT(planes[0].seen, 0.9);
  EXPECT_NEAR(static_cast<double>(seen.size()) / num_points, planes[0].seen, 0.05);
  EXPECT_NEAR(test::meanOf(seen), planes[0].support, 0.05);
  EXPECT_NEAR(numUnseen(planes[0].point_support), (1.0 - planes[0].seen) * 2000.0, 100.0);
}

TEST(SymmetryMaximaRefinement, TakesAnySearchMethod) {
  const auto shape = test::moved(test::box(1500, Sampling::Random, 5), test::randomPose(6));
  const auto cloud = test::withHoles(*test::toCloud(shape), 9);
  const auto counting = pcl::make_shared<test::CountingKdTree>();
  const std::vector<pcl::search::Search<pcl::PointXYZ>::Ptr> searches = {
      counting, pcl::make_shared<pcl::search::Octree<pcl::PointXYZ>>(0.05),
      pcl::make_shared<pcl::search::BruteForce<pcl::PointXYZ>>(),
      pcl::make_shared<pcl::search::FlannSearch<pcl::PointXYZ>>()};
  for (const auto& search : searches) {
    SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
    refinement.setInputCloud(cloud);
    refinement.setSearchMethod(search);
    EXPECT_EQ(numFound(shape, refinement.compute(), 0.2 * test::kDegree, 0.003), 3) << search->getName();
  }
  EXPECT_GT(counting->num_queries, 10'000);
}

TEST(SymmetryMaximaRefinement, FindsWithoutASearchMethodThatItCannotUse) {
  const auto cloud = test::toCloud(test::box(1500, Sampling::Random, 5));
  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  refinement.setInputCloud(cloud);
  refinement.setSearchMethod(pcl::make_shared<pcl::search::OrganizedNeighbor<pcl::PointXYZ>>());
  expectSamePlanes(refinement.compute(), detectSymmetryPlanes(*cloud));
}

/// The cloud with one normal for all points.
pcl::PointCloud<pcl::PointNormal>::Ptr withNormals(const pcl::PointCloud<pcl::PointXYZ>& cloud,
                                                   const Eigen::Vector3f& normal) {
  auto result = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  pcl::copyPointCloud(cloud, *result);
  for (auto& point : *result) point.getNormalVector3fMap() = normal;
  return result;
}

TEST(SymmetryMaximaRefinement, UsesTheNormalsOfTheInput) {
  const auto shape = test::box(2000, Sampling::Random, 4);
  const auto cloud = test::toCloud(shape);
  const auto estimated = detectSymmetryPlanes(*cloud);

  // Normals that are zero or not finite are estimated.
  SymmetryMaximaRefinement<pcl::PointNormal> refinement;
  for (const float missing : {0.0f, std::numeric_limits<float>::quiet_NaN()}) {
    refinement.setInputCloud(withNormals(*cloud, Eigen::Vector3f::Constant(missing)));
    expectSamePlanes(refinement.compute(), estimated);
  }

  // Those of the faces of the box give its planes.
  auto faces = withNormals(*cloud, Eigen::Vector3f::Zero());
  const Eigen::Vector3f low = cloud->getMatrixXfMap(3, 4, 0).rowwise().minCoeff();
  const Eigen::Vector3f high = cloud->getMatrixXfMap(3, 4, 0).rowwise().maxCoeff();
  for (auto& point : *faces) {
    const Eigen::Array3f x = point.getArray3fMap();
    Eigen::Index axis;
    (x - low.array()).abs().min((high.array() - x).abs()).minCoeff(&axis);
    point.getNormalVector3fMap() = 2.0f * Eigen::Vector3f::Unit(axis);  // of any length
  }
  refinement.setInputCloud(faces);
  const auto exact = refinement.compute();
  EXPECT_EQ(numFound(shape, exact, 0.2 * test::kDegree, 0.003), 3);

  // Wrong ones change the result, unless they are not to be used.
  refinement.setInputCloud(withNormals(*cloud, Eigen::Vector3f::UnitX()));
  EXPECT_LT(numFound(shape, refinement.compute(), 0.2 * test::kDegree, 0.003), 3);
  refinement.setUseInputNormals(false);
  expectSamePlanes(refinement.compute(), estimated);
}

TEST(SymmetryMaximaRefinement, TakesAMapMadeBefore) {
  const auto shape = test::moved(test::cube(3000, Sampling::Mirrored, 6), test::randomPose(7));
  const auto cloud = test::toCloud(shape);
  PlanarSymmetryTransform<pcl::PointXYZ> transform;
  transform.setInputCloud(cloud);
  transform.setMethod(TransformMethod::Convolution);
  transform.setGridSize(32);
  const SymmetryMap map = transform.compute();
  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  refinement.setInputCloud(cloud);
  refinement.compute();
  EXPECT_EQ(refinement.getSymmetryMap().grid.size(), refinement.getSymmetryMap().values.size());
  EXPECT_NE(refinement.getSymmetryMap().values, map.values) << "its own, by another method";
  refinement.setSymmetryMap(map, transform.getDistanceTransform());
  const auto planes = refinement.compute();
  EXPECT_EQ(refinement.getSymmetryMap().values, map.values);
  EXPECT_EQ(planes.size(), 9u);
  EXPECT_EQ(numFound(shape, planes, 0.001 * test::kDegree, 1e-5 * test::diagonal(shape.cloud())), 9);
}

TEST(SymmetryMaximaRefinement, AUsedObjectIsAsGoodAsANewOne) {
  const auto first = test::toCloud(test::cylinder(3000, 3)),
             second = test::toCloud(test::cube(3000, Sampling::Random, 6));
  PlanarSymmetryTransform<pcl::PointXYZ> transform;
  transform.setInputCloud(first);
  transform.setGridSize(32);
  SymmetryMaximaRefinement<pcl::PointXYZ> used, fresh;
  used.setInputCloud(first);
  const SymmetryMap map = transform.compute();
  used.setSymmetryMap(map, transform.getDistanceTransform());
  used.compute();
  EXPECT_FALSE(used.getAxes().empty());
  used.setInputCloud(second);
  EXPECT_TRUE(used.getAxes().empty());
  EXPECT_TRUE(used.getSymmetryMap().empty()) << "the map was that of another cloud";
  fresh.setInputCloud(second);
  const auto expected = fresh.compute();
  EXPECT_FALSE(expected.empty());
  expectSamePlanes(used.compute(), expected);
  EXPECT_EQ(used.getSymmetryMap().values, fresh.getSymmetryMap().values);
  used.setInputCloud(nullptr);
  EXPECT_TRUE(used.compute().empty());
  EXPECT_TRUE(used.getUsedIndices().empty());
}

}  // namespace
}  // namespace pcl_symmetry
