#include "calibrate/merge_fitting.h"

#include <gtest/gtest.h>

#include "core/segmentation/cues/merge_cues.h"
#include "shapes/meshes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

/// A dumbbell whose cubes and bar are parts, and a division of it into patches.
PeopledDivision peopledDumbbell(int division, std::vector<std::vector<int>>* people = nullptr) {
  const test::Mesh mesh = test::dumbbell();
  const SurfaceGraph graph = meshGraph(mesh.vertices, mesh.polygons);
  std::vector<int> labels;
  for (int i = 0; i < graph.size(); ++i)
    labels.push_back(graph.centers(0, i) < 8.0f ? 0 : graph.centers(0, i) < 14.0f ? 1 : 2);
  SegmentationOptions options;
  options.merging.num_patches = 60;
  options.num_threads = 1;
  const WholeEvidence whole(graph, options);
  if (people) *people = {labels};
  return peopledDivision(whole.ofDivision(division, MergingEvidence::All), {labels});
}

double randBetween(const std::vector<int>& a, const std::vector<int>& b) {
  std::size_t differ = 0, all = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      differ += (a[i] == a[j]) != (b[i] == b[j]) ? 1 : 0;
      ++all;
    }
  }
  return static_cast<double>(differ) / static_cast<double>(all);
}

TEST(MergeSamples, RandDistancesFollowTheMerges) {
  std::vector<std::vector<int>> people;
  const PeopledDivision division = peopledDumbbell(0, &people);
  const MergeRun run = runMerges(division, fittedWeights(MergingEvidence::All));
  ASSERT_EQ(run.rand.size(), run.least_log_odds.size() + 1);
  EXPECT_TRUE(std::is_sorted(run.least_log_odds.rbegin(), run.least_log_odds.rend()));
  EXPECT_NEAR(run.rand.front(), randBetween(division.evidence.patches.of_element, people[0]), 1e-9);
  EXPECT_NEAR(run.rand.back(), randBetween(std::vector<int>(people[0].size(), 0), people[0]), 1e-9) << "one region";
  EXPECT_EQ(run.randAt(1e9), run.rand.front());
  EXPECT_EQ(run.randAt(-1e9), run.rand.back());
  EXPECT_FALSE(run.samples.empty());
  for (const MergeSample& sample : run.samples) {
    EXPECT_GE(sample.together, 0.0);
    EXPECT_LE(sample.together, 1.0);
  }
}

TEST(MergeFitting, IsBetterThanPatchesAndOneRegionAndTheSameForAnyNumberOfThreads) {
  const PeopledDivision first = peopledDumbbell(0), second = peopledDumbbell(1);
  const std::vector<PeopledModel> models{{"a", &first}, {"b", &second}};
  MergeFitter fitter(models, cuesOf(MergingEvidence::SymmetryAndConcavity), 1);
  const MergeFitting fitting = fitter.fit();
  const MergeRun merges = runMerges(first, fitting.fit.weights);
  EXPECT_LT(fitting.fit.rand, 0.5 * merges.rand.front()) << "patches";
  EXPECT_LT(fitting.fit.rand, 0.5 * merges.rand.back()) << "one region";
  EXPECT_GT(fitting.num_samples, 50u);
  EXPECT_EQ(fitting.fit.weights[kSight], 0.0) << "no such cue";
  EXPECT_GT(fitting.half_width[kAlways], 0.0);
  EXPECT_EQ(MergeFitter(models, cuesOf(MergingEvidence::SymmetryAndConcavity), 3).fit().fit.weights,
            fitting.fit.weights);
  const std::vector<PathPoint> path = fitter.path({1e-3, 1e3});
  ASSERT_EQ(path.size(), 2u);
  EXPECT_LT(std::abs(path[1].weights[kContact]), std::abs(path[0].weights[kContact])) << "pulled to 0";
}

}  // namespace
