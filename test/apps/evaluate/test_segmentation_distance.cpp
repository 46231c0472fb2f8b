#include "evaluate/segmentation/segmentation_distance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "apps/support/strip_mesh.h"
#include "apps/support/temporary_folder.h"
#include "common/shape_input/shape_input.h"
#include "evaluate/segmentation/mirror_agreement.h"
#include "pcl_symmetry/symmetry_segmentation.h"

namespace {

using namespace pcl_symmetry::apps;

class SegmentationDistanceTest : public testing::Test {
protected:
  SegmentationDistance between(const std::vector<int>& a, const std::vector<int>& b) const {
    return comparison_.compare(comparison_.prepare(a), comparison_.prepare(b));
  }

  const TemporaryFolder folder_;
  const SegmentationComparison comparison_{*loadShape(folder_.write("strip.off", stripOFF(8))).mesh};
  const std::vector<int> one_ = {0, 0, 0, 0, 0, 0, 0, 0}, halves_ = {7, 7, 7, 7, 3, 3, 3, 3},
                         early_ = {0, 0, 1, 1, 1, 1, 1, 1}, quarters_ = {0, 0, 1, 1, 2, 2, 3, 3};
};

TEST_F(SegmentationDistanceTest, EqualPartitionsAreAtZeroWhateverTheirLabels) {
  const SegmentationDistance d = between(halves_, {1, 1, 1, 1, 0, 0, 0, 0});
  for (const double value : {d.rand, d.cut_discrepancy, d.hamming, d.global_consistency, d.local_consistency})
    EXPECT_EQ(value, 0.0);
}

TEST_F(SegmentationDistanceTest, OneSegmentAgainstHalves) {
  const SegmentationDistance d = between(halves_, one_);
  EXPECT_NEAR(d.rand, 16.0 / 28.0, 1e-12) << "4 x 4 of the 28 pairs of faces are apart";
  EXPECT_TRUE(std::isnan(d.cut_discrepancy)) << "one segment has no cut";
  EXPECT_NEAR(d.hamming_missing, 0.0, 1e-6) << "the one segment covers both halves";
  EXPECT_NEAR(d.hamming_false, 0.5, 1e-6) << "it overlaps one of them most, half of it lies outside";
  EXPECT_NEAR(d.hamming, 0.25, 1e-6);
  EXPECT_NEAR(d.global_consistency, 0.0, 1e-6) << "one refines the other";
}

TEST_F(SegmentationDistanceTest, ShiftedCut) {
  const SegmentationDistance d = between(halves_, early_);
  EXPECT_NEAR(d.rand, 12.0 / 28.0, 1e-12) << "two faces change sides: 2 x 2 pairs come apart, 2 x 4 come together";
  const double mean_radius = 2.0;  // centers at 0.5 to 7.5, center of mass at 4
  EXPECT_NEAR(d.cut_discrepancy, 2 * 2.0 / mean_radius, 1e-6) << "the cuts are 2 apart, both ways";
  EXPECT_NEAR(d.hamming, 0.25, 1e-6) << "2 of 8 faces both ways";
  // Against the early cut's segments: 4 faces lie in one half with errors 2/4, 4 in the other with error 0; the other
  // way 2 faces have error 0 and of 6 faces two have 4/6 and four have 2/6.
  EXPECT_NEAR(d.global_consistency, 4 * 0.5 / 8, 1e-6);
}

TEST_F(SegmentationDistanceTest, RefinementCountsForHammingNotForConsistency) {
  const SegmentationDistance d = between(halves_, quarters_);
  EXPECT_NEAR(d.global_consistency, 0.0, 1e-6);
  EXPECT_NEAR(d.local_consistency, 0.0, 1e-6);
  EXPECT_NEAR(d.hamming_missing, 0.5, 1e-6);
  EXPECT_NEAR(d.hamming_false, 0.0, 1e-6);
}

TEST_F(SegmentationDistanceTest, RefusesAnotherNumberOfLabels) {
  EXPECT_THROW(comparison_.prepare({0, 1}), std::invalid_argument);
}

TEST_F(SegmentationDistanceTest, MirrorImagesLieInPartnersOfSegments) {
  // The strip's squares in its own order; across its middle the i-th is the image of the (7 - i)-th.
  const auto graph = pcl_symmetry::meshGraph(*loadShape(folder_.write("strip.off", stripOFF(8))).mesh);
  const Eigen::Vector3d along = (graph.centers.col(7) - graph.centers.col(0)).cast<double>();
  const Eigen::Vector3d middle = 0.5 * (graph.centers.col(7) + graph.centers.col(0)).cast<double>();
  const pcl_symmetry::ReflectionPlane across(along, along.dot(middle));
  EXPECT_EQ(mirrorAgreement(graph, {0, 0, 1, 1, 1, 1, 2, 2}, across), 1.0);
  EXPECT_EQ(mirrorAgreement(graph, {0, 0, 0, 0, 0, 0, 0, 0}, across), 1.0) << "one segment is its own partner";
  EXPECT_EQ(mirrorAgreement(graph, {0, 0, 0, 1, 1, 1, 2, 2}, across), 0.75)
      << "the third square and its image do not match";
  EXPECT_EQ(mirrorAgreement(graph, {0, 0, 1, 1, 1, 1, 1, 1}, across), 0.75) << "the last two have no partner";
}

}  // namespace
