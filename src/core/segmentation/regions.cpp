#include "core/segmentation/regions.h"

#include <cmath>

#include "core/segmentation/segmentation_rules.h"

namespace pcl_symmetry {

namespace {

double ratio(double a, double b) {
  return b > 0.0 ? a / b : 0.0;
}

/// Log of the thickness at each patch. A patch behind which no ray met another side is open: as thick as the thickest.
std::vector<double> logThickness(const std::vector<double>& thickness) {
  const double thickest = *std::max_element(thickness.begin(), thickness.end());
  std::vector<double> log_thickness;
  for (const double t : thickness)
    log_thickness.push_back(std::log(std::max(kSegmentation.thinnest, t > 0.0 ? t : thickest)));
  return log_thickness;
}

}  // namespace

void Regions::Border::add(const Border& other) {
  length += other.length;
  edge_concavity += other.edge_concavity;
  patch_concavity += other.patch_concavity;
  log_thickness += other.log_thickness;
}

Regions::Regions(const PartEvidence& evidence)
    : region_(evidence.patches.areas.size()),
      areas_(evidence.patches.areas),
      log_thickness_(evidence.patches.areas.size()),
      perimeters_(evidence.patches.areas.size(), 0.0),
      inside_(evidence.patches.areas.size()),
      neighbors_(evidence.patches.areas.size()) {
  const int size = evidence.size();
  const std::vector<double> log_thickness = logThickness(evidence.thickness);
  Eigen::VectorXf areas(size);
  for (int i = 0; i < size; ++i) {
    region_[i] = i;
    areas[i] = static_cast<float>(areas_[i]);
    log_thickness_[i] = areas_[i] * log_thickness[i];
  }
  sight_ = areas.asDiagonal() * evidence.sight * areas.asDiagonal();
  support_ = evidence.support * areas.asDiagonal();
  for (const std::vector<int>& image : evidence.images) {
    images_.emplace_back(Eigen::MatrixXf::Zero(size, size));
    for (int i = 0; i < size; ++i) images_.back()(image[i], i) = areas[i];
    image_of_.push_back(image);
    for (int i = 0; i < size; ++i)
      if (areas[i] <= 0.0f) image_of_.back()[i] = -1;
  }
  for (const PatchBorder& b : evidence.borders) {
    neighbors_[b.from].push_back(b.to);
    neighbors_[b.to].push_back(b.from);
    perimeters_[b.from] += b.length;
    perimeters_[b.to] += b.length;
    border(b.from, b.to) = {b.length, b.length * b.edge_concavity, b.length * b.patch_concavity,
                            b.length * 0.5 * (log_thickness[b.from] + log_thickness[b.to])};
  }
}

Cues Regions::cues(int a, int b) const {
  const Border& between = borders_.at(std::minmax(a, b));
  const double area_a = std::max(kSegmentation.least_area, areas_[a]),
               area_b = std::max(kSegmentation.least_area, areas_[b]);
  Cues cues{};
  cues[kAlways] = 1.0;
  cues[kContact] = std::min(1.0, ratio(between.length, std::min(perimeters_[a], perimeters_[b])));
  cues[kSmallArea] = std::log(std::min(area_a, area_b));
  cues[kLargeArea] = std::log(std::max(area_a, area_b));
  if (support_.rows() > 0) {
    const Eigen::VectorXd difference =
        support_.col(a).cast<double>() / area_a - support_.col(b).cast<double>() / area_b;
    cues[kSupportDifference] = difference.norm() / std::sqrt(static_cast<double>(difference.size()));
  }
  for (std::size_t plane = 0; plane < images_.size(); ++plane)
    if (imageOf(a, plane) == b && imageOf(b, plane) == a) cues[kImages] = 1.0;
  cues[kEdgeConcavity] = ratio(between.edge_concavity, between.length);
  cues[kPatchConcavity] = ratio(between.patch_concavity, between.length);
  cues[kInnerConcavity] =
      ratio(inside_[a].patch_concavity + inside_[b].patch_concavity, inside_[a].length + inside_[b].length);
  const double thickness_a = log_thickness_[a] / area_a, thickness_b = log_thickness_[b] / area_b;
  cues[kThicknessRatio] = std::abs(thickness_a - thickness_b);
  cues[kConstriction] = std::min(thickness_a, thickness_b) - ratio(between.log_thickness, between.length);
  const double within = std::sqrt(sight_(a, a) * sight_(b, b)) / (area_a * area_b);
  cues[kSight] = sight_(a, b) / (area_a * area_b);
  cues[kRelativeSight] =
      std::min(kSegmentation.most_relative_sight, cues[kSight] / std::max(kSegmentation.least_inner_sight, within));
  cues[kSightOfSmall] = cues[kSight] * cues[kSmallArea];
  return cues;
}

/// The image of \p a is looked for anew; other images can only have moved to the region that grew.
void Regions::joinImages(int a, int b) {
  for (std::size_t plane = 0; plane < images_.size(); ++plane) {
    const Eigen::MatrixXf& shared = images_[plane];
    std::vector<int>& image = image_of_[plane];
    Eigen::Index most = 0;
    image[a] = shared.col(a).maxCoeff(&most) > 0.0f ? static_cast<int>(most) : -1;
    for (int c = 0; c < size(); ++c)
      if (c != a && image[c] >= 0 && (image[c] == b || shared(a, c) > shared(image[c], c))) image[c] = a;
  }
}

void Regions::merge(int a, int b) {
  const auto shared = borders_.find(std::minmax(a, b));
  inside_[a].add(inside_[b]);
  perimeters_[a] += perimeters_[b];
  if (shared != borders_.end()) {
    inside_[a].add(shared->second);
    perimeters_[a] -= 2.0 * shared->second.length;
    borders_.erase(shared);
  }
  areas_[a] += areas_[b];
  log_thickness_[a] += log_thickness_[b];
  support_.col(a) += support_.col(b);
  const auto join = [&](Eigen::MatrixXf& pairs) {
    pairs.col(a) += pairs.col(b);
    pairs.row(a) += pairs.row(b);
    pairs.row(b).setZero();
  };
  join(sight_);
  for (Eigen::MatrixXf& image : images_) join(image);
  joinImages(a, b);
  std::replace(region_.begin(), region_.end(), b, a);
  joinNeighbors(a, b);
}

/// Borders of \p b become borders of \p a.
void Regions::joinNeighbors(int a, int b) {
  const auto forget = [](std::vector<int>& list, int region) {
    list.erase(std::remove(list.begin(), list.end(), region), list.end());
  };
  forget(neighbors_[a], b);
  for (const int c : neighbors_[b]) {
    if (c == a) continue;
    forget(neighbors_[c], b);
    if (borders_.find(std::minmax(a, c)) == borders_.end()) {
      neighbors_[a].push_back(c);
      neighbors_[c].push_back(a);
    }
    border(a, c).add(border(b, c));
    borders_.erase(std::minmax(b, c));
  }
  neighbors_[b].clear();
}

}  // namespace pcl_symmetry
