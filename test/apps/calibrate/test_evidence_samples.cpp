#include "calibrate/planes/evidence_samples.h"

#include <gtest/gtest.h>

#include <set>

#include "apps/support/temporary_folder.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

TEST(EvidenceSamples, SharesAreThoseOfTheMesh) {
  const TemporaryFolder folder;
  const std::string path = folder.write(
      "box.off",
      "OFF\n8 6 0\n-1 -0.7 -0.4\n1 -0.7 -0.4\n1 0.7 -0.4\n-1 0.7 -0.4\n-1 -0.7 0.4\n1 -0.7 0.4\n1 0.7 0.4\n"
      "-1 0.7 0.4\n4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n");
  const std::vector<EvidenceSample> samples = sampleEvidence({"box", path, "box"}, 0.01);
  std::set<std::string> rows;
  int num_symmetries = 0;
  for (const EvidenceSample& sample : samples) {
    rows.insert(sample.row);
    EXPECT_EQ(sample.model, "box");
    EXPECT_GE(sample.near_share, sample.share);
    if (sample.row != "whole" || sample.share < 0.97) continue;
    ++num_symmetries;
    EXPECT_GT(sample.evidence.share, 0.97);
  }
  EXPECT_EQ(num_symmetries, 3);
  EXPECT_EQ(rows.size(), calibrationRecipes().size());
}

}  // namespace
