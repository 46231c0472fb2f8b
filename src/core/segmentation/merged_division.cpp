#include "core/segmentation/merged_division.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/segmentation/segmentation_rules.h"

namespace pcl_symmetry {

namespace {

/// The first merge that is not sure, or that leaves fewer regions than asked for.
std::size_t firstDoubt(const std::vector<Merge>& merges, std::size_t num_made) {
  std::size_t i = 0;
  while (i < std::min(merges.size(), num_made) && merges[i].log_odds >= kSegmentation.surely_one) ++i;
  return i;
}

/// Consecutive numbers for the regions of patches.
std::map<int, int> numbersOf(const std::vector<int>& regions) {
  std::map<int, int> number;
  for (const int region : regions) number.emplace(region, static_cast<int>(number.size()));
  return number;
}

}  // namespace

MergedDivision mergedDivision(const PartEvidence& evidence, const MergeWeights& weights, int num_parts) {
  Regions regions(evidence);
  const std::vector<Merge> merges = mergeRegions(regions, weights).merges;
  const auto num_made = static_cast<std::size_t>(std::max(0, evidence.size() - num_parts));
  const std::size_t doubt = num_parts > 0 ? std::min(merges.size(), num_made) : firstDoubt(merges, merges.size());
  regions = merged(std::move(regions), merges, doubt);
  const std::map<int, int> number = numbersOf(regions.ofPatches());
  MergedDivision division;
  for (const int patch : evidence.patches.of_element) division.cell.push_back(number.at(regions.ofPatches()[patch]));
  const auto size = static_cast<Eigen::Index>(number.size());
  division.probability = Eigen::MatrixXf::Identity(size, size);
  if (num_parts > 0) return division;
  std::map<int, std::vector<int>> cells_of;
  for (const auto& [region, cell] : number) cells_of[region] = {cell};
  float least = 1.0f;
  for (std::size_t i = doubt; i < merges.size(); ++i) {
    least = std::min(least, static_cast<float>(1.0 / (1.0 + std::exp(-merges[i].log_odds))));
    std::vector<int>&into = cells_of[merges[i].into], &from = cells_of[merges[i].from];
    for (const int a : into)
      for (const int b : from) division.probability(a, b) = division.probability(b, a) = least;
    into.insert(into.end(), from.begin(), from.end());
  }
  return division;
}

MergedDivision reflectedDivision(const MergedDivision& division, const std::vector<int>& reflected) {
  MergedDivision result{{}, division.probability};
  for (const int element : reflected) result.cell.push_back(division.cell[element]);
  return result;
}

}  // namespace pcl_symmetry
