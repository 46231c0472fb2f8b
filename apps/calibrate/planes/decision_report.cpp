#include "calibrate/planes/decision_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "evaluate/shared/table_text.h"

namespace pcl_symmetry::apps {

namespace {

constexpr double kCalled = 0.5, kListed = 0.2;  // derived: DetectionOptions::min_confidence and min_possible

/// \return the group of a row: rows that differ in the number of points, the noise or the view are one.
std::string groupOf(const std::string& row) {
  if (row == "whole" || row.find("points") != std::string::npos) return "whole";
  for (const char* name : {"noise", "scan", "moved", "folds"})
    if (row.rfind(name, 0) == 0) return name;
  return row;
}

/// One plane of a cloud, and its confidence.
struct Judged {
  const EvidenceSample* sample;
  double confidence;
};

/// \return the planes of a cloud, surest first.
std::vector<Judged> judged(const EvidenceSample* first, const EvidenceSample* last, const DecisionFit& fit,
                           const EvidenceUnits& units) {
  const auto odds_of = [&](const EvidenceSample& sample, bool further) {
    PlaneEvidence evidence = sample.evidence;
    evidence.further = further;
    return logOdds(evidence, fit, units);
  };
  const EvidenceSample* best = std::max_element(first, last, [&](const EvidenceSample& a, const EvidenceSample& b) {
    return odds_of(a, false) < odds_of(b, false);
  });
  std::vector<Judged> planes;
  for (const EvidenceSample* sample = first; sample != last; ++sample)
    planes.push_back({sample, 1.0 / (1.0 + std::exp(-odds_of(*sample, sample != best)))});
  std::stable_sort(planes.begin(), planes.end(),
                   [](const Judged& a, const Judged& b) { return a.confidence > b.confidence; });
  return planes;
}

bool isNear(const EvidenceSample& sample) {
  return sample.near_share >= kAsymmetric && sample.near_share < kSymmetric;
}

void count(const std::vector<Judged>& planes, double best_share, GroupDecisions& group) {
  for (const Judged& plane : planes)
    if (plane.confidence >= kListed)
      group.forecasts.push_back({plane.confidence, plane.sample->near_share >= kSymmetric});
  const bool called = planes.front().confidence >= kCalled;
  if (best_share < kAsymmetric) group.asymmetric.add(called);
  if (best_share < kSymmetric) return;
  const auto first = std::find_if(planes.begin(), planes.end(), [](const Judged& p) { return !isNear(*p.sample); });
  group.right.add(first != planes.end() && first->confidence >= kCalled && first->sample->near_share >= kSymmetric);
  for (const Judged& plane : planes)
    group.num_false += plane.confidence >= kCalled && plane.sample->near_share < kAsymmetric ? 1 : 0;
}

/// A unit by name, as pointer to member.
const std::vector<std::pair<const char*, double EvidenceUnits::*>>& unitNames() {
  static const std::vector<std::pair<const char*, double EvidenceUnits::*>> names = {
      {"off", &EvidenceUnits::off},
      {"off_per_spacing", &EvidenceUnits::off_per_spacing},
      {"scan_off", &EvidenceUnits::scan_off},
      {"double_off", &EvidenceUnits::double_off},
      {"precision", &EvidenceUnits::precision},
      {"precision_per_spacing", &EvidenceUnits::precision_per_spacing},
      {"precision_per_unknown", &EvidenceUnits::precision_per_unknown},
      {"reach", &EvidenceUnits::reach},
      {"most_off", &EvidenceUnits::most_off},
      {"hidden_loss", &EvidenceUnits::hidden_loss},
      {"slipping", &EvidenceUnits::slipping},
      {"least_slipping", &EvidenceUnits::least_slipping},
      {"slipping_seen", &EvidenceUnits::slipping_seen},
      {"volume_off", &EvidenceUnits::volume_off},
      {"excess", &EvidenceUnits::excess},
      {"lost_overlap", &EvidenceUnits::lost_overlap},
      {"least_excess", &EvidenceUnits::least_excess},
      {"noise", &EvidenceUnits::noise}};
  return names;
}

}  // namespace

std::vector<GroupDecisions> decisionsOf(const std::vector<EvidenceSample>& samples, const DecisionFit& fit,
                                        const EvidenceUnits& units) {
  std::map<std::string, double> best_shares;
  for (const EvidenceSample& sample : samples)
    best_shares[sample.model] = std::max(best_shares[sample.model], sample.share);
  std::map<std::string, GroupDecisions> groups;
  const EvidenceSample* end = samples.data() + samples.size();
  for (const EvidenceSample* first = samples.data(); first != end;) {
    const EvidenceSample* last = std::find_if(first, end, [&](const EvidenceSample& sample) {
      return sample.model != first->model || sample.row != first->row;
    });
    count(judged(first, last, fit, units), best_shares[first->model], groups[groupOf(first->row)]);
    first = last;
  }
  std::vector<GroupDecisions> list;
  for (auto& [name, group] : groups) {
    group.group = name;
    list.push_back(std::move(group));
  }
  return list;
}

void printDecisions(const std::vector<GroupDecisions>& groups) {
  std::printf("%-16s %-34s %-34s %s\n", "clouds", "decided and right, of symmetric", "called symmetric, of asymmetric",
              "false planes");
  std::vector<Reliability> reliabilities;
  for (const GroupDecisions& group : groups) {
    std::printf("%-16s %-34s %-34s %d\n", group.group.c_str(), group.right.text().c_str(),
                group.asymmetric.text().c_str(), group.num_false);
    reliabilities.push_back(reliabilityOf(group.group, group.forecasts, {}));
  }
  printReliability(reliabilities);
}

void printSensitivity(const std::vector<EvidenceSample>& samples, const std::vector<EvidenceSample>& others) {
  std::printf("right of symmetric / called of asymmetric models\n%-24s", "unit");
  const auto row = [&](const std::string& name, const EvidenceUnits& units) {
    std::vector<EvidenceSample> marked = samples;
    const std::vector<GroupDecisions> groups = decisionsOf(others, fitDecision(marked, units), units);
    if (name == "as chosen") {
      for (const GroupDecisions& group : groups) std::printf(" %16s", group.group.c_str());
      std::printf("\n");
    }
    std::printf("%-24s", name.c_str());
    for (const GroupDecisions& group : groups)
      std::printf(" %16s",
                  (std::to_string(group.right.count) + " / " + std::to_string(group.asymmetric.count)).c_str());
    std::printf("\n");
  };
  row("as chosen", {});
  for (const auto& [name, unit] : unitNames()) {
    for (const double factor : {0.5, 2.0}) {
      EvidenceUnits units;
      units.*unit *= factor;
      row(std::string(name) + (factor < 1.0 ? ", half" : ", twice"), units);
    }
  }
}

}  // namespace pcl_symmetry::apps
