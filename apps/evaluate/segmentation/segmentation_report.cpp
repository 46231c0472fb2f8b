#include "evaluate/segmentation/segmentation_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <sstream>

#include "common/files/file_text.h"

namespace pcl_symmetry::apps {

namespace {

struct Measure {
  const char* name;
  const char* title;
  double SegmentationDistance::*value;
};

// derived: the four measures of the Princeton Segmentation Benchmark.
constexpr Measure kMeasures[] = {{"rand", "Rand", &SegmentationDistance::rand},
                                 {"cut_discrepancy", "cut", &SegmentationDistance::cut_discrepancy},
                                 {"hamming", "Hamming", &SegmentationDistance::hamming},
                                 {"hamming_missing", "missing", &SegmentationDistance::hamming_missing},
                                 {"hamming_false", "false", &SegmentationDistance::hamming_false},
                                 {"global_consistency", "GCE", &SegmentationDistance::global_consistency},
                                 {"local_consistency", "LCE", &SegmentationDistance::local_consistency}};

/// Mean of what is finite; NaN where nothing is.
class Mean {
public:
  void add(double value) {
    if (!std::isfinite(value)) return;
    sum_ += value;
    ++count_;
  }
  double value() const { return count_ > 0 ? sum_ / count_ : std::nan(""); }

private:
  double sum_ = 0.0;
  int count_ = 0;
};

template <typename Value>
double meanOver(const std::vector<const SegmentationResult*>& results, const Value& value) {
  Mean mean;
  for (const SegmentationResult* result : results) mean.add(value(*result));
  return mean.value();
}

/// Results with the same key, in the order in which the keys first appear.
template <typename Key>
std::vector<std::pair<std::string, std::vector<const SegmentationResult*>>> groupBy(
    const std::vector<const SegmentationResult*>& results, const Key& key) {
  std::vector<std::pair<std::string, std::vector<const SegmentationResult*>>> groups;
  for (const SegmentationResult* result : results) {
    auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == key(*result); });
    if (group == groups.end()) group = groups.insert(groups.end(), {key(*result), {}});
    group->second.push_back(result);
  }
  return groups;
}

auto byMethod(const std::vector<SegmentationResult>& results) {
  std::vector<const SegmentationResult*> all;
  for (const SegmentationResult& result : results) all.push_back(&result);
  return groupBy(all, [](const SegmentationResult& r) { return r.method; });
}

auto byCategory(const std::vector<const SegmentationResult*>& results) {
  return groupBy(results, [](const SegmentationResult& r) { return r.category; });
}

std::string shown(double value, const char* format) {
  char text[32];
  std::snprintf(text, sizeof(text), format, value);
  return std::isfinite(value) ? text : "-";
}

nlohmann::json orNull(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

double mirrorAgreementOf(const SegmentationResult& result) {
  return result.mirror_agreement;
}

double leastMirrorAgreement(const std::vector<const SegmentationResult*>& results) {
  double least = std::nan("");
  for (const SegmentationResult* result : results) least = std::fmin(least, result->mirror_agreement);
  return least;
}

void printCategories(const std::vector<SegmentationResult>& results) {
  const auto methods = byMethod(results);
  std::printf("\n%-16s", "Rand distance");
  for (const auto& method : methods) std::printf(" %14s", method.first.c_str());
  std::printf("\n");
  for (const auto& category : byCategory(methods.front().second)) {
    std::printf("%-16s", category.first.empty() ? "(none)" : category.first.c_str());
    for (const auto& method : methods) {
      std::vector<const SegmentationResult*> own;
      for (const SegmentationResult* result : method.second)
        if (result->category == category.first) own.push_back(result);
      const double rand = meanOver(own, [](const SegmentationResult& r) { return r.distance.rand; });
      std::printf(" %14s", shown(rand, "%.4f").c_str());
    }
    std::printf("\n");
  }
}

}  // namespace

void printTable(const std::vector<SegmentationResult>& results, bool categories) {
  std::printf("%-22s %6s", "", "models");
  for (const Measure& measure : kMeasures) std::printf(" %8s", measure.title);
  std::printf(" %8s %14s %9s\n", "segments", "mirrored least", "ms");
  for (const auto& [name, own] : byMethod(results)) {
    std::printf("%-22s %6zu", name.c_str(), own.size());
    for (const Measure& measure : kMeasures) {
      const double mean = meanOver(own, [&](const SegmentationResult& r) { return r.distance.*measure.value; });
      std::printf(" %8s", shown(mean, "%.4f").c_str());
    }
    const double num_segments = meanOver(own, [](const SegmentationResult& r) { return r.num_segments; });
    const double ms = meanOver(own, [](const SegmentationResult& r) { return r.milliseconds; });
    const double mirrored = meanOver(own, mirrorAgreementOf);
    std::printf(" %8s %8s %5s %9s\n", shown(num_segments, "%.1f").c_str(), shown(mirrored, "%.3f").c_str(),
                shown(leastMirrorAgreement(own), "%.3f").c_str(), shown(ms, "%.0f").c_str());
  }
  std::printf(
      "mirrored: share of the area whose mirror image lies in the paired segment, on models with a global plane.\n");
  if (categories) printCategories(results);
}

nlohmann::json toJson(const std::vector<SegmentationResult>& results) {
  nlohmann::json json = nlohmann::json::array();
  for (const auto& [name, own] : byMethod(results)) {
    nlohmann::json method{{"method", name}, {"num_models", own.size()}};
    for (const Measure& measure : kMeasures)
      method[measure.name] =
          orNull(meanOver(own, [&](const SegmentationResult& r) { return r.distance.*measure.value; }));
    method["num_segments"] = orNull(meanOver(own, [](const SegmentationResult& r) { return r.num_segments; }));
    method["mirror_agreement"] = orNull(meanOver(own, mirrorAgreementOf));
    method["least_mirror_agreement"] = orNull(leastMirrorAgreement(own));
    method["milliseconds"] = orNull(meanOver(own, [](const SegmentationResult& r) { return r.milliseconds; }));
    for (const auto& [category, models] : byCategory(own))
      method["rand_by_category"][category] =
          orNull(meanOver(models, [](const SegmentationResult& r) { return r.distance.rand; }));
    json.push_back(method);
  }
  return json;
}

std::string segmentationCSV(const std::vector<SegmentationResult>& results) {
  std::ostringstream text;
  text << "method,model,category";
  for (const Measure& measure : kMeasures) text << ',' << measure.name;
  text << ",segments,smallest_share,mirror_agreement,milliseconds\n";
  for (const SegmentationResult& r : results) {
    text << r.method << ',' << r.model << ',' << r.category;
    for (const Measure& measure : kMeasures) {
      const double value = r.distance.*measure.value;
      text << ',';
      if (std::isfinite(value)) text << value;
    }
    text << ',' << r.num_segments << ',' << r.smallest_share << ',';
    if (std::isfinite(r.mirror_agreement)) text << r.mirror_agreement;
    text << ',' << r.milliseconds << '\n';
  }
  return text.str();
}

std::string benchmarkCategory(const std::string& model) {
  // derived: the Princeton Segmentation Benchmark, in the order of its numbers.
  constexpr const char* kCategories[] = {"Human",     "Cup",   "Glasses", "Airplane", "Ant",  "Chair",  "Octopus",
                                         "Table",     "Teddy", "Hand",    "Plier",    "Fish", "Bird",   "Spring",
                                         "Armadillo", "Bust",  "Mech",    "Bearing",  "Vase", "Fourleg"};
  constexpr std::uint64_t kModelsOfCategory = 20;  // derived: the same benchmark
  std::uint64_t number = 0;
  if (!spellsCount(model, &number) || number < 1 || number > kModelsOfCategory * std::size(kCategories)) return "";
  return kCategories[(number - 1) / kModelsOfCategory];
}

}  // namespace pcl_symmetry::apps
