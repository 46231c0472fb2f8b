#include <array>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "calibrate/planes/evidence_samples.h"
#include "common/command_line/run_tool.h"
#include "common/files/file_text.h"

namespace pcl_symmetry::apps {

namespace {

// derived: the members of EvidenceSample and PlaneEvidence.
constexpr const char* kHeading =
    "model,row,rank,partial,volume,share_on_mesh,near_share,share,unknown,support,conflict,baseline,score,own_"
    "score,"
    "spacing,tolerance,roughness,double_share,hold\n";
constexpr std::size_t kNumValues = 17;  // derived: the columns of kHeading after the names

std::array<double, kNumValues> valuesOf(const EvidenceSample& sample) {
  const PlaneEvidence& e = sample.evidence;
  return {static_cast<double>(sample.rank),
          static_cast<double>(e.partial),
          static_cast<double>(e.volume),
          sample.share,
          sample.near_share,
          e.share,
          e.unknown,
          e.support,
          e.conflict,
          e.baseline,
          e.score,
          e.own_score,
          e.spacing,
          e.tolerance,
          e.roughness,
          e.double_share,
          e.hold};
}

EvidenceSample sampleFrom(const std::string& model, const std::string& row, const std::array<double, kNumValues>& v) {
  EvidenceSample sample{model, row, {}, v[3], v[4], static_cast<int>(v[0])};
  PlaneEvidence& e = sample.evidence;
  e.partial = v[1] > 0.0;
  e.volume = v[2] > 0.0;
  e.share = v[5];
  e.unknown = v[6];
  e.support = v[7];
  e.conflict = v[8];
  e.baseline = v[9];
  e.score = v[10];
  e.own_score = v[11];
  e.spacing = v[12];
  e.tolerance = v[13];
  e.roughness = v[14];
  e.double_share = v[15];
  e.hold = v[16];
  return sample;
}

}  // namespace

std::string evidenceTable(const std::vector<EvidenceSample>& samples) {
  std::string text = kHeading;
  for (const EvidenceSample& sample : samples) {
    text += sample.model + "," + sample.row;
    for (const double value : valuesOf(sample)) {
      char number[32];
      std::snprintf(number, sizeof(number), ",%.17g", value);
      text += number;
    }
    text += "\n";
  }
  return text;
}

std::vector<EvidenceSample> readEvidenceTable(const std::string& path) {
  std::istringstream text(readWholeFile(path));
  std::string line, model, row;
  if (!std::getline(text, line) || line + "\n" != kHeading)
    throw InputError(path + ": line 1 must be " + std::string(kHeading));
  std::vector<EvidenceSample> samples;
  for (int number = 2; std::getline(text, line); ++number) {
    std::istringstream fields(line);
    std::getline(fields, model, ',');
    std::getline(fields, row, ',');
    std::array<double, kNumValues> values{};
    std::string field;
    for (double& value : values) {
      char* end = nullptr;
      if (std::getline(fields, field, ',')) value = std::strtod(field.c_str(), &end);
      if (field.empty() || !end || *end != '\0')
        throw InputError(path + ": line " + std::to_string(number) + ": '" + field + "', must be a number");
    }
    samples.push_back(sampleFrom(model, row, values));
  }
  return samples;
}

}  // namespace pcl_symmetry::apps
