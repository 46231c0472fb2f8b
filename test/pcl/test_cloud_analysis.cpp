#include "pcl_symmetry/impl/cloud_analysis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "pcl/clouds.h"
#include "pcl_symmetry/axial_symmetry_transform.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/object_symmetries.h"
#include "pcl_symmetry/planar_symmetry_transform.h"
#include "pcl_symmetry/symmetry_alignment.h"
#include "pcl_symmetry/symmetry_detection.h"
#include "pcl_symmetry/symmetry_maxima_refinement.h"
#include "pcl_symmetry/symmetry_segmentation.h"

namespace pcl_symmetry {
namespace {

using namespace detail;
using test::messageOf;

/// Returns the points that it uses.
class Copy : public ScanAnalysis<pcl::PointXYZ> {
public:
  Copy() : ScanAnalysis<pcl::PointXYZ>("Copy", 100) {}
  Points compute() { return selectInput(1, 1); }
};

pcl::PointCloud<pcl::PointXYZ>::Ptr grid(int size) {
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (int i = 0; i < size; ++i) cloud->emplace_back(0.1f * (i % 7), 0.1f * (i / 7), 0.01f * (i % 3));
  return cloud;
}

TEST(CloudAnalysis, SelectsFinitePointsOfTheIndices) {
  const auto cloud = grid(60);
  (*cloud)[3].x = std::numeric_limits<float>::infinity();
  auto indices = pcl::make_shared<pcl::Indices>();
  for (pcl::index_t i = 0; i < 40; ++i) indices->push_back(i);
  Copy copy;
  copy.setInputCloud(cloud);
  copy.setIndices(indices);
  const Points points = copy.compute();
  ASSERT_EQ(points.cols(), 39);
  ASSERT_EQ(copy.getUsedIndices().size(), 39u);
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    EXPECT_EQ(points.col(i), (*cloud)[copy.getUsedIndices()[i]].getVector3fMap());
  EXPECT_EQ(copy.getReason(), "");
}

TEST(CloudAnalysis, DrawsOnePointOfEachRun) {
  Copy copy;
  copy.setMaxPoints(50);
  copy.setInputCloud(grid(500));
  ASSERT_EQ(copy.compute().cols(), 50);
  for (std::size_t i = 0; i < 50; ++i) EXPECT_EQ(copy.getUsedIndices()[i] / 10, static_cast<int>(i));
}

TEST(CloudAnalysis, EveryClassSaysWhyDataHoldNoAnswer) {
  using P = pcl::PointXYZ;
  for (const auto& [name, cloud] : test::cloudsWithoutAnswer()) {
    SCOPED_TRACE(name);
    const auto expectNone = [&input = cloud](auto&& analysis, const auto& hasNone) {
      analysis.setInputCloud(input);
      EXPECT_TRUE(hasNone(analysis));
      EXPECT_EQ(analysis.getReason().rfind("input cloud: ", 0), 0u) << analysis.getReason();
    };
    expectNone(Copy(), [](auto& copy) { return copy.compute().cols() == 0 && copy.getUsedIndices().empty(); });
    expectNone(PlanarSymmetryTransform<P>(),
               [](auto& transform) { return transform.compute().empty() && !transform.getDistanceTransform(); });
    expectNone(AxialSymmetryTransform<P>(), [](auto& transform) {
      return transform.compute().empty() && transform.computeCenters().values.empty();
    });
    expectNone(SymmetryAlignment<P>(), [](auto& alignment) { return alignment.compute().equivalent.empty(); });
    expectNone(SymmetryMaximaRefinement<P>(), [](auto& refinement) {
      refinement.setApproximate(true);
      const std::vector<float> support = refinement.computePointSupport(ReflectionPlane());
      return refinement.compute().empty() && refinement.getAxes().empty() &&
             std::all_of(support.begin(), support.end(), [](float value) { return std::isnan(value); });
    });
    expectNone(SymmetrySegmentation<P>(), [](auto& segmentation) {
      std::vector<pcl::PointIndices> segments(3);
      segmentation.segment(segments);
      return segments.empty() && segmentation.getLabels().empty();
    });
  }
}

TEST(CloudAnalysis, TellsEmptyIndicesFromPointsThatAreNotFinite) {
  Copy copy;
  copy.setInputCloud(grid(60));
  copy.setIndices(pcl::make_shared<pcl::Indices>());
  copy.compute();
  EXPECT_EQ(copy.getReason(), "input cloud: the indices are empty");
  const auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>(*grid(60));
  (*cloud)[7].x = std::numeric_limits<float>::quiet_NaN();
  copy.setInputCloud(cloud);
  copy.setIndices(pcl::make_shared<pcl::Indices>(1, 7));
  copy.compute();
  EXPECT_EQ(copy.getReason(), "input cloud: no finite point among the indices");
}

TEST(CloudAnalysis, ForgetsTheLastCloud) {
  Copy copy;
  copy.setInputCloud(grid(60));
  copy.compute();
  copy.setInputCloud(nullptr);
  EXPECT_TRUE(copy.getUsedIndices().empty());
  copy.compute();
  EXPECT_EQ(copy.getReason(), "input cloud: not set");
  copy.setInputCloud(grid(60));
  EXPECT_EQ(copy.getReason(), "");
  EXPECT_EQ(copy.compute().cols(), 60);
}

TEST(CloudAnalysis, EveryClassNamesFieldValueAndRule) {
  using P = pcl::PointXYZ;
  Copy copy;
  EXPECT_EQ(messageOf([&] { copy.setMaxPoints(1); }), "max_points = 1, must be >= 2");
  copy.setInputCloud(grid(60));
  copy.setIndices(pcl::make_shared<pcl::Indices>(1, 60));
  EXPECT_EQ(messageOf([&] { copy.compute(); }), "indices[0] = 60, must be in [0, 60)");
  PlanarSymmetryTransform<P> planar;
  EXPECT_EQ(messageOf([&] { planar.setGridSize(4); }), "num_cells = 4, must be in [8, 512]");
  EXPECT_EQ(messageOf([&] { planar.setMapSize(8, 7, 8); }), "num_phi = 7, must be even and in [2, 4096]");
  EXPECT_EQ(messageOf([&] { planar.setSigma(-1.0); }), "sigma = -1, must be finite and >= 0");
  PlanarTransformOptions estimators;
  estimators.voting.num_pairs = 0;
  EXPECT_EQ(messageOf([&] { planar.setOptions(estimators); }), "num_pairs = 0, must be >= 1");
  estimators.sampled.num_samples = 0;
  EXPECT_EQ(messageOf([&] { planar.setOptions(estimators); }), "num_samples = 0, must be in [1, 10000000]");
  EXPECT_EQ(messageOf([&] { planar.setNumberOfThreads(-2); }), "num_threads = -2, must be >= 0");
  EXPECT_EQ(messageOf([&] { planar.setBounds(Eigen::Vector3d::Zero(), 0.0); }), "radius = 0, must be finite and > 0");
  AxialSymmetryTransform<P> axial;
  EXPECT_EQ(messageOf([&] { axial.setOptions({{1}}); }), "fold = 1, must be 0 or in [2, 60]");
  EXPECT_EQ(messageOf([&] { axial.setMapSize(8, 7, 8); }), "num_phi = 7, must be even and in [2, 1024]");
  SymmetryMaximaRefinement<P> refinement;
  EXPECT_EQ(messageOf([&] { refinement.setMinConfidence(1.5); }), "min_confidence = 1.5, must be in [0, 1]");
  EXPECT_EQ(messageOf([&] { refinement.setMaxPlanes(0); }), "max_planes = 0, must be >= 1");
  EXPECT_NE(messageOf([&] { refinement.setSymmetryMap(SymmetryMap(), nullptr); }).find("symmetry map: empty"),
            std::string::npos);
  SymmetrySegmentation<P> segmentation;
  SegmentationOptions options;
  options.splitting.depth = -1;
  EXPECT_EQ(messageOf([&] { segmentation.setOptions(options); }), "depth = -1, must be in [0, 30]");
  EXPECT_EQ(messageOf([&] { segmentation.setMaxPoints(19); }), "max_points = 19, must be >= 20");
  EXPECT_EQ(messageOf([&] { segmentation.setNumberOfParts(-2); }), "num_parts = -2, must be >= 0");
}

TEST(CloudAnalysis, FunctionsOfAnyCloudRefuseAlike) {
  DetectionOptions detection;
  detection.min_confidence = -1.0;
  for (const auto& cloud : {*grid(60), pcl::PointCloud<pcl::PointXYZ>()})
    EXPECT_EQ(messageOf([&] { detectSymmetryPlanes(cloud, detection); }), "min_confidence = -1, must be in [0, 1]");
  ObjectSymmetryOptions symmetries;
  symmetries.max_fold = 0;
  EXPECT_EQ(messageOf([&] { detectObjectSymmetries(*grid(60), symmetries); }), "max_fold = 0, must be >= 2");
}

TEST(CloudConversion, DrawsTheSameOfTheFinitePointsWhateverElseIsThere) {
  pcl::PointCloud<pcl::PointXYZ> finite, mixed;
  pcl::Indices place_in_mixed;
  const float none = std::numeric_limits<float>::quiet_NaN();
  for (int i = 0; i < 1000; ++i) {
    finite.emplace_back(static_cast<float>(i), 1.0f, 2.0f);
    if (i % 3 == 0) mixed.emplace_back(0.0f, none, 0.0f);
    place_in_mixed.push_back(static_cast<pcl::index_t>(mixed.size()));
    mixed.push_back(finite.back());
  }
  for (const std::size_t max_points : {std::size_t{10}, std::size_t{999}, std::size_t{1000}, std::size_t{2000}}) {
    const SelectedPoints of_finite = selectPoints(finite, nullptr, max_points, 3);
    const SelectedPoints of_mixed = selectPoints(mixed, nullptr, max_points, 3);
    ASSERT_EQ(of_finite.indices.size(), std::min<std::size_t>(max_points, 1000));
    ASSERT_EQ(of_mixed.points, of_finite.points);
    for (std::size_t i = 0; i < of_finite.indices.size(); ++i) {
      EXPECT_EQ(of_finite.points(0, static_cast<Eigen::Index>(i)), static_cast<float>(of_finite.indices[i]));
      EXPECT_EQ(of_mixed.indices[i], place_in_mixed[static_cast<std::size_t>(of_finite.indices[i])]);
    }
    EXPECT_EQ(selectPoints(mixed, &place_in_mixed, max_points, 3).indices, of_mixed.indices);
  }
}

}  // namespace
}  // namespace pcl_symmetry
