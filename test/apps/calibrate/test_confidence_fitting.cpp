#include "calibrate/planes/confidence_fitting.h"

#include <gtest/gtest.h>

#include <cmath>

#include "apps/support/temporary_folder.h"
#include "common/command_line/run_tool.h"
#include "core/base/random.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

/// Four planes for each cloud, of which the first is a symmetry in nine of ten clouds, and each other in two of ten.
std::vector<EvidenceSample> madeUpSamples() {
  std::vector<EvidenceSample> samples;
  RandomStream random(1);
  for (int cloud = 0; cloud < 300; ++cloud) {
    for (int rank = 0; rank < 4; ++rank) {
      EvidenceSample sample{"model " + std::to_string(cloud), "scan 1", {}, 0.5, 0.5, rank};
      const bool is_symmetry = random.uniform() < (rank == 0 ? 0.9 : 0.2);
      if (is_symmetry) sample.share = sample.near_share = 0.99;
      sample.evidence.partial = cloud % 3 == 0;
      sample.evidence.volume = cloud % 3 == 1;
      sample.evidence.own_score = sample.evidence.volume ? 0.9 : 1.0;
      sample.evidence.share = 1.0 - (is_symmetry ? 0.05 : 0.2) * random.uniform();
      sample.evidence.score = 0.9 - 0.1 * rank - 0.1 * random.uniform();
      sample.evidence.support = sample.evidence.share - 0.01;
      sample.evidence.unknown = 0.1 * random.uniform();
      sample.evidence.spacing = 0.01 * (1.0 + random.uniform());
      samples.push_back(sample);
    }
  }
  return samples;
}

TEST(ConfidenceFitting, ATableGivesTheSameFitBitForBit) {
  const TemporaryFolder folder;
  std::vector<EvidenceSample> samples = madeUpSamples();
  const std::string path = folder.write("samples.csv", evidenceTable(samples));
  std::vector<EvidenceSample> read = readEvidenceTable(path);
  ASSERT_EQ(read.size(), samples.size());
  const DecisionFit fit = fitDecision(samples), again = fitDecision(read);
  for (std::size_t kind = 0; kind < fit.size(); ++kind)
    EXPECT_EQ((fit[kind].coefficients - again[kind].coefficients).cwiseAbs().maxCoeff(), 0.0) << kKindNames[kind];
  EXPECT_EQ(headerText(fit, 300, 0.01), headerText(again, 300, 0.01));
}

TEST(ConfidenceFitting, FurtherPlanesOfAScanAreLessProbable) {
  std::vector<EvidenceSample> samples = madeUpSamples();
  const DecisionFit fit = fitDecision(samples);
  const auto scan = static_cast<std::size_t>(EvidenceKind::Scan);
  EXPECT_LT(fit[scan].coefficients.tail<1>()[0], 0.0);
  int num_first = 0, num_further = 0;
  for (const EvidenceSample& sample : samples) {
    ++(sample.evidence.further ? num_further : num_first);
  }
  EXPECT_EQ(num_first, 300) << "one for each cloud";
  EXPECT_EQ(num_further, 900);
}

/// Log odds of the first plane of scans, of those that the fit learned from.
double oddsOfFirst(std::vector<EvidenceSample> samples) {
  const PlaneEvidence first = samples.front().evidence;
  const DecisionFit fit = fitDecision(samples);
  return logOdds(first, fit);
}

TEST(ConfidenceFitting, NearlySymmetricPlanesAreNone) {
  std::vector<EvidenceSample> samples = madeUpSamples();
  const double before = oddsOfFirst(samples);
  for (std::size_t i = 0; i < samples.size(); i += 2)
    if (samples[i].near_share >= 0.97) samples[i].near_share = 0.95;
  EXPECT_LT(oddsOfFirst(samples), before - 0.5);
}

TEST(ConfidenceFitting, PlanesOfOtherModelsAreForeseenBetterThanByTheirNumber) {
  const std::vector<EvidenceSample> samples = madeUpSamples();
  const std::array<double, 3> losses = crossValidation(samples, 5);
  double symmetric = 0.0;
  for (const EvidenceSample& sample : samples) symmetric += isSymmetry(sample) ? 1.0 : 0.0;
  const double share = symmetric / static_cast<double>(samples.size());
  // What a forecast costs that knows their number alone.
  const double by_number = -share * std::log(share) - (1.0 - share) * std::log(1.0 - share);
  for (const double loss : losses) {
    EXPECT_GT(loss, 0.0);
    EXPECT_LT(loss, 0.9 * by_number);
  }
}

TEST(EvidenceTable, NamesTheLineThatCannotBeRead) {
  const TemporaryFolder folder;
  const std::string good = evidenceTable(madeUpSamples());
  const std::string path = folder.write("bad.csv", good.substr(0, good.find('\n') + 1) + "model,scan 1,zero\n");
  try {
    readEvidenceTable(path);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("line 2"), std::string::npos) << error.what();
  }
  EXPECT_THROW(readEvidenceTable(folder.write("other.csv", "a,b\n1,2\n")), InputError);
}

}  // namespace
