#include <array>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "calibrate/planes/evidence_samples.h"
#include "common/command_line/run_tool.h"
#include "common/files/file_text.h"

namespace pcl_symmetry::apps {

namespace {

/// A number of the evidence and the name of its column.
struct Column {
  const char* name;
  double PlaneEvidence::*value;
};

// derived: the members of PlaneEvidence that are numbers.
constexpr std::array kEvidence{Column{"share", &PlaneEvidence::share},
                               Column{"unknown", &PlaneEvidence::unknown},
                               Column{"support", &PlaneEvidence::support},
                               Column{"conflict", &PlaneEvidence::conflict},
                               Column{"baseline", &PlaneEvidence::baseline},
                               Column{"score", &PlaneEvidence::score},
                               Column{"own_score", &PlaneEvidence::own_score},
                               Column{"spacing", &PlaneEvidence::spacing},
                               Column{"tolerance", &PlaneEvidence::tolerance},
                               Column{"roughness", &PlaneEvidence::roughness},
                               Column{"double_share", &PlaneEvidence::double_share},
                               Column{"hold", &PlaneEvidence::hold}};
constexpr std::size_t kFirst = 5;                              // derived: the columns of numbers before them
constexpr std::size_t kNumValues = kFirst + kEvidence.size();  // derived: all columns of numbers

std::string heading() {
  std::string text = "model,row,rank,partial,volume,share_on_mesh,near_share";
  for (const Column& column : kEvidence) text += std::string(",") + column.name;
  return text + "\n";
}

std::array<double, kNumValues> valuesOf(const EvidenceSample& sample) {
  const PlaneEvidence& e = sample.evidence;
  std::array<double, kNumValues> values{static_cast<double>(sample.rank), static_cast<double>(e.partial),
                                        static_cast<double>(e.volume), sample.share, sample.near_share};
  for (std::size_t k = 0; k < kEvidence.size(); ++k) values[kFirst + k] = e.*kEvidence[k].value;
  return values;
}

EvidenceSample sampleFrom(const std::string& model, const std::string& row, const std::array<double, kNumValues>& v) {
  EvidenceSample sample{model, row, {}, v[3], v[4], static_cast<int>(v[0])};
  sample.evidence.partial = v[1] > 0.0;
  sample.evidence.volume = v[2] > 0.0;
  for (std::size_t k = 0; k < kEvidence.size(); ++k) sample.evidence.*kEvidence[k].value = v[kFirst + k];
  return sample;
}

}  // namespace

std::string evidenceTable(const std::vector<EvidenceSample>& samples) {
  std::string text = heading();
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
  if (!std::getline(text, line) || line + "\n" != heading()) throw InputError(path + ": line 1 must be " + heading());
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
