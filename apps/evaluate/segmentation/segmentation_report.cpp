#include "evaluate/segmentation/segmentation_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <sstream>

#include "common/files/file_text.h"
#include "evaluate/runs/packed_rows.h"

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
    sum_of_squares_ += value * value;
    ++count_;
  }
  double value() const { return count_ > 0 ? sum_ / count_ : std::nan(""); }

  /// Half the width of the 95 % interval, the values taken as independent; NaN for fewer than two.
  double halfWidth() const {
    constexpr double kQuantile = 1.96;  // derived: 97.5 % of a normal distribution lie below it
    if (count_ < 2) return std::nan("");
    const double variance = std::max(0.0, sum_of_squares_ - sum_ * sum_ / count_) / (count_ - 1);
    return kQuantile * std::sqrt(variance / count_);
  }

private:
  double sum_ = 0.0, sum_of_squares_ = 0.0;
  int count_ = 0;
};

template <typename Value>
Mean summaryOf(const std::vector<const SegmentationResult*>& results, const Value& value) {
  Mean mean;
  for (const SegmentationResult* result : results) mean.add(value(*result));
  return mean;
}

template <typename Value>
double meanOver(const std::vector<const SegmentationResult*>& results, const Value& value) {
  return summaryOf(results, value).value();
}

double randOf(const SegmentationResult& result) {
  return result.distance.rand;
}

/// Rand distances minus those of another method on the same models.
Mean differenceOf(const std::vector<const SegmentationResult*>& results,
                  const std::vector<const SegmentationResult*>& others) {
  Mean mean;
  for (const SegmentationResult* result : results)
    for (const SegmentationResult* other : others)
      if (other->model == result->model) mean.add(randOf(*result) - randOf(*other));
  return mean;
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

/// What each method loses against one, model by model: most of the spread over models falls out of the difference.
void printDifferences(const std::vector<SegmentationResult>& results) {
  const auto methods = byMethod(results);
  auto reference =
      std::find_if(methods.begin(), methods.end(), [](const auto& method) { return method.first == "all"; });
  if (reference == methods.end() || methods.size() < 2) return;
  std::printf("\n%-22s %8s\n", "Rand minus that of all", "95 %");
  for (const auto& [name, own] : methods) {
    if (name == reference->first) continue;
    const Mean difference = differenceOf(own, reference->second);
    std::printf("%-22s %+8.4f  (%+.4f to %+.4f)\n", name.c_str(), difference.value(),
                difference.value() - difference.halfWidth(), difference.value() + difference.halfWidth());
  }
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
      const double rand = meanOver(own, randOf);
      std::printf(" %14s", shown(rand, "%.4f").c_str());
    }
    std::printf("\n");
  }
}

}  // namespace

void put(detail::PackedBytes& bytes, const SegmentationResult& result) {
  for (const std::string* text : {&result.method, &result.model, &result.category}) bytes.putText(*text);
  bytes.put(result.distance);
  for (const double number : {result.num_segments, result.smallest_share, result.mirror_agreement, result.milliseconds})
    bytes.put(number);
}

void get(detail::UnpackedBytes& bytes, SegmentationResult& result) {
  for (std::string* text : {&result.method, &result.model, &result.category}) *text = bytes.text();
  result.distance = bytes.get<SegmentationDistance>();
  for (double* number : {&result.num_segments, &result.smallest_share, &result.mirror_agreement, &result.milliseconds})
    *number = bytes.get<double>();
}

void printTable(const std::vector<SegmentationResult>& results, bool categories) {
  std::printf("%-22s %6s", "", "models");
  for (const Measure& measure : kMeasures) std::printf(&measure == kMeasures ? " %8s     +/-" : " %8s", measure.title);
  std::printf(" %8s %14s %9s\n", "segments", "mirrored least", "ms");
  for (const auto& [name, own] : byMethod(results)) {
    std::printf("%-22s %6zu", name.c_str(), own.size());
    for (const Measure& measure : kMeasures) {
      const double mean = meanOver(own, [&](const SegmentationResult& r) { return r.distance.*measure.value; });
      std::printf(" %8s", shown(mean, "%.4f").c_str());
      if (&measure == kMeasures) std::printf(" %7s", shown(summaryOf(own, randOf).halfWidth(), "%.4f").c_str());
    }
    const double num_segments = meanOver(own, [](const SegmentationResult& r) { return r.num_segments; });
    const double ms = meanOver(own, [](const SegmentationResult& r) { return r.milliseconds; });
    const double mirrored = meanOver(own, mirrorAgreementOf);
    std::printf(" %8s %8s %5s %9s\n", shown(num_segments, "%.1f").c_str(), shown(mirrored, "%.3f").c_str(),
                shown(leastMirrorAgreement(own), "%.3f").c_str(), shown(ms, "%.0f").c_str());
  }
  std::printf(
      "+/-: half of the 95 %% interval over models. mirrored: share of the area whose image in the reference plane "
      "lies\n"
      "in the partner of its segment, on models with such a plane.\n");
  printDifferences(results);
  if (categories) printCategories(results);
}

nlohmann::json toJson(const std::vector<SegmentationResult>& results) {
  nlohmann::json json = nlohmann::json::array();
  for (const auto& [name, own] : byMethod(results)) {
    nlohmann::json method{{"method", name}, {"num_models", own.size()}};
    for (const Measure& measure : kMeasures)
      method[measure.name] =
          orNull(meanOver(own, [&](const SegmentationResult& r) { return r.distance.*measure.value; }));
    method["rand_half_width"] = orNull(summaryOf(own, randOf).halfWidth());
    method["num_segments"] = orNull(meanOver(own, [](const SegmentationResult& r) { return r.num_segments; }));
    method["mirror_agreement"] = orNull(meanOver(own, mirrorAgreementOf));
    method["least_mirror_agreement"] = orNull(leastMirrorAgreement(own));
    method["milliseconds"] = orNull(meanOver(own, [](const SegmentationResult& r) { return r.milliseconds; }));
    for (const auto& [category, models] : byCategory(own))
      method["rand_by_category"][category] = orNull(meanOver(models, randOf));
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
