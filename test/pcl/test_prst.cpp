#include <gtest/gtest.h>
#include <pcl/features/feature.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "core/matching/symmetry_descriptor.h"
#include "pcl/clouds.h"
#include "pcl_symmetry/prst.h"

namespace pcl_symmetry {

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

Cloud::Ptr boxCloud(const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity(), double unit = 1.0) {
  return test::toCloud(test::moved(test::scaled(test::box(6000, test::Sampling::Random, 5), unit), pose));
}

template <typename PointT = pcl::PointXYZ>
pcl::PointCloud<PRSTSignature32768> describe(const typename pcl::PointCloud<PointT>::ConstPtr& cloud,
                                             bool use_input_axes) {
  PRSTEstimation<PointT> estimation;
  estimation.setUseInputAxes(use_input_axes);
  estimation.setInputCloud(cloud);
  pcl::PointCloud<PRSTSignature32768> output;
  estimation.compute(output);
  return output;
}

/// The box in its own axes, which most tests compare with.
const PRSTSignature32768& rawBox() {
  static const PRSTSignature32768 described = describe(boxCloud(), true)[0];
  return described;
}

float norm(const PRSTSignature32768& a) {
  return descriptorDistance(a, PRSTSignature32768());
}

}  // namespace

TEST(PRSTEstimation, DescribesInTheCanonicalFrame) {
  const Eigen::Isometry3d pose = test::randomPose(3);
  const auto a = describe(boxCloud(), false), b = describe(boxCloud(pose, 0.01), false);
  EXPECT_LT(descriptorDistance(a[0], b[0]), 0.15f * norm(a[0]));
  EXPECT_GT(descriptorDistance(rawBox(), describe(boxCloud(pose, 0.01), true)[0]), 0.2f * norm(a[0]));
}

/// The values that an estimation writes for a cloud.
template <typename PointT>
std::vector<float> valuesOf(PRSTEstimation<pcl::PointXYZ, PointT>& estimation, const Cloud::ConstPtr& cloud,
                            float (PointT::*field)[PointT::descriptorSize()]) {
  estimation.setInputCloud(cloud);
  pcl::PointCloud<PointT> output;
  estimation.compute(output);
  const float* const values = output.at(0).*field;
  return {values, values + PointT::descriptorSize()};
}

TEST(PaperDescriptors, AreThoseOfTheCoreToTheBit) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const test::Shape shape = seed % 3 == 0   ? test::cylinder(2000, seed)
                              : seed % 3 == 1 ? test::asymmetricBlob(2000, seed)
                                              : test::box(2000, test::Sampling::Random, seed);
    const Points points = test::moved(shape, test::randomPose(seed)).cloud();
    const Cloud::ConstPtr cloud = test::toCloud(points);
    DescriptorOptions options;
    options.by_equation_1 = seed % 2 == 0;
    const auto core = symmetryDescriptors(points, descriptorFrame(points, seed > 2, nullptr, options), options);
    const auto valuesBy = [&](auto estimation, auto field) {
      estimation.setByEquation1(options.by_equation_1);
      estimation.setUseInputAxes(seed > 2);
      return valuesOf(estimation, cloud, field);
    };
    EXPECT_EQ(valuesBy(PRSTEstimation<pcl::PointXYZ>(), &PRSTSignature32768::prst), core.prst) << seed;
    EXPECT_EQ(valuesBy(PRSDEstimation<pcl::PointXYZ>(), &PRSDSignature1024::prsd), core.prsd) << seed;
    EXPECT_EQ(valuesBy(GEDTEstimation<pcl::PointXYZ>(), &GEDTSignature32768::gedt), core.gedt) << seed;
  }
}

TEST(PRSTEstimation, HonorsIndicesAndWorksThroughTheBaseClass) {
  const Cloud::Ptr box = boxCloud();
  const std::size_t size = box->size();
  auto mixed = pcl::make_shared<Cloud>(*box);
  for (int i = 0; i < 500; ++i) mixed->push_back(pcl::PointXYZ(5.0f + 0.01f * static_cast<float>(i), 4.0f, 3.0f));
  mixed->push_back(pcl::PointXYZ(std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f));
  auto indices = pcl::make_shared<pcl::Indices>();
  for (std::size_t i = 0; i < size; ++i) indices->push_back(static_cast<int>(i));
  PRSTEstimation<pcl::PointXYZ> estimation;
  estimation.setUseInputAxes(true);
  estimation.setInputCloud(mixed);
  estimation.setIndices(indices);
  pcl::Feature<pcl::PointXYZ, PRSTSignature32768>& base = estimation;
  pcl::PointCloud<PRSTSignature32768> output;
  base.compute(output);
  ASSERT_EQ(output.size(), 1u);
  EXPECT_EQ(descriptorDistance(output[0], rawBox()), 0.0f);
  base.compute(output);
  ASSERT_EQ(output.size(), 1u);
}

TEST(PRSTEstimation, WorksWithOtherPointTypes) {
  const auto cloud = test::toCloud<pcl::PointWithRange>(Points(boxCloud()->getMatrixXfMap(3, 4, 0)));
  EXPECT_EQ(descriptorDistance(describe<pcl::PointWithRange>(cloud, true).at(0), rawBox()), 0.0f);
}

TEST(PRSTEstimation, CloudsWithoutAnswerGiveAnEmptyOutputAndAWarningAndWrongParametersThrow) {
  PRSTEstimation<pcl::PointXYZ> estimation;
  pcl::PointCloud<PRSTSignature32768> output;
  const auto warningFor = [&](const Cloud::ConstPtr& cloud) {
    if (cloud) estimation.setInputCloud(cloud);
    output.resize(3);
    testing::internal::CaptureStderr();
    estimation.compute(output);
    EXPECT_TRUE(output.empty());
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_NE(warningFor(nullptr).find("input cloud: not set"), std::string::npos);
  EXPECT_NE(warningFor(pcl::make_shared<Cloud>()).find("no finite point"), std::string::npos);
  const std::string same = warningFor(pcl::make_shared<Cloud>(10, 1, pcl::PointXYZ(1.0f, 2.0f, 3.0f)));
  EXPECT_NE(same.find("1 distinct point"), std::string::npos) << same;
  EXPECT_NE(same.find("[pcl_symmetry::PRSTEstimation]"), std::string::npos) << same;
  // The object works again with another input.
  estimation.setInputCloud(boxCloud());
  estimation.setUseInputAxes(true);
  estimation.compute(output);
  ASSERT_EQ(output.size(), 1u);
  EXPECT_EQ(descriptorDistance(output[0], rawBox()), 0.0f);
  EXPECT_EQ(test::messageOf([&] { estimation.setMaxPoints(1); }), "max_points = 1, must be >= 2");
  Viewpoint inside;
  inside.mode = Viewpoint::Mode::Given;
  estimation.setViewpoint(inside);
  EXPECT_NE(test::messageOf([&] { estimation.compute(output); }).find("viewpoint"), std::string::npos);
}

TEST(PRSTEstimation, SaysOnceThatASearchRadiusIsIgnored) {
  PRSTEstimation<pcl::PointXYZ> estimation;
  estimation.setUseInputAxes(true);
  estimation.setInputCloud(boxCloud());
  estimation.setRadiusSearch(0.1);
  pcl::PointCloud<PRSTSignature32768> output;
  testing::internal::CaptureStderr();
  estimation.compute(output);
  estimation.compute(output);
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_NE(text.find("setRadiusSearch"), std::string::npos) << text;
  EXPECT_EQ(text.find("setRadiusSearch"), text.rfind("setRadiusSearch")) << text;
  EXPECT_EQ(descriptorDistance(output.at(0), rawBox()), 0.0f);
}

TEST(ProductDistance, MultipliesTheDistancesOfBothDescriptors) {
  PRSTSignature32768 prst, no_prst;
  GEDTSignature32768 gedt, no_gedt;
  prst.prst[5] = 2.0f;
  gedt.gedt[7] = 3.0f;
  const float sine = std::sin(0.5f * static_cast<float>(M_PI_2) / 32.0f);  // of the first of 32 bins of theta
  EXPECT_NEAR(descriptorDistance(prst, no_prst), 2.0f * std::sqrt(sine), 1e-5f);
  EXPECT_NEAR(descriptorDistance(gedt, no_gedt), 3.0f, 1e-5f);
  EXPECT_NEAR(productDistance(prst, gedt, no_prst, no_gedt), 6.0f * std::sqrt(sine), 1e-5f);
  EXPECT_EQ(productDistance(prst, gedt, no_prst, gedt), 0.0f);
}

}  // namespace pcl_symmetry
