/// What `pcl_symmetry_evaluate segmentation` prints and writes.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluate/segmentation/segmentation_distance.h"
#include "recognition/packing/packed_bytes.h"

namespace pcl_symmetry::apps {

/// One segmentation of one model, against those of people.
struct SegmentationResult {
  std::string method, model, category;
  SegmentationDistance distance;  ///< mean over the people
  double num_segments = 0.0;
  double smallest_share = 0.0;    ///< of the faces that the smallest segment has
  double mirror_agreement = 0.0;  ///< mirrorAgreement() across the reference plane; NaN where none was looked for
  double milliseconds = 0.0;
};

/// To and from the bytes that processes pass on.
void put(detail::PackedBytes& bytes, const SegmentationResult& result);
void get(detail::UnpackedBytes& bytes, SegmentationResult& result);

/// A line for each method, means over models, and the Rand distance by category where \p categories.
void printTable(const std::vector<SegmentationResult>& results, bool categories);

nlohmann::json toJson(const std::vector<SegmentationResult>& results);

/// One row for each method and model.
std::string segmentationCSV(const std::vector<SegmentationResult>& results);

/// \return the category that the Princeton Segmentation Benchmark has for a model of this number ("Human" for 1 to 20);
/// empty for another name.
std::string benchmarkCategory(const std::string& model);

}  // namespace pcl_symmetry::apps
