#pragma once

#include <array>
#include <map>
#include <vector>

#include "core/segmentation/part_evidence.h"

namespace pcl_symmetry {

/// What speaks for and against two neighbouring regions being one part.
enum Cue {
  kAlways,             ///< 1
  kContact,            ///< length of the border in perimeters of the region that has the shorter one
  kSmallArea,          ///< log of the smaller area, in shares of the surface
  kLargeArea,          ///< log of the larger area
  kSupportDifference,  ///< root mean square difference of their support for the planes of the surface
  kImages,             ///< 1 where they are each other's image in a plane that maps most of the surface onto itself
  kEdgeConcavity,      ///< along the border, at the edges
  kPatchConcavity,     ///< along the border, between the patches on both sides
  kInnerConcavity,     ///< between the patches within the two regions
  kThicknessRatio,     ///< |log| of the ratio of the thicknesses
  kConstriction,       ///< log of the thickness of the thinner region over that at the border
  kSight,              ///< share of the pairs of places, one in each, that see each other through the body
  kRelativeSight,      ///< the same over that within the regions
  kSightOfSmall,       ///< kSight times kSmallArea
  kNumCues
};
using Cues = std::array<double, kNumCues>;

/// Regions of a surface, at first its patches, that grow together.
class Regions {
public:
  /// \param evidence must outlive this object.
  explicit Regions(const PartEvidence& evidence);

  int size() const { return static_cast<int>(areas_.size()); }
  bool exists(int region) const { return exists_[region]; }
  double area(int region) const { return areas_[region]; }
  const std::vector<int>& neighbours(int region) const { return neighbours_[region]; }
  /// The region of each patch.
  const std::vector<int>& ofPatches() const { return region_; }

  /// \param a,b neighbours.
  Cues cues(int a, int b) const;

  /// Makes \p b part of \p a; they need not be neighbours.
  void merge(int a, int b);

  /// The region that holds most of the image of this one in a plane of PartEvidence::images; -1 for none.
  int imageOf(int region, std::size_t plane) const;

private:
  /// Sums along borders, by length.
  struct Border {
    double length = 0.0, edge_concavity = 0.0, patch_concavity = 0.0, log_thickness = 0.0;
    void add(const Border& other);
  };
  Border& border(int a, int b) { return borders_[std::minmax(a, b)]; }

  std::vector<char> exists_;
  std::vector<int> region_;
  std::vector<double> areas_, log_thickness_;  ///< the latter times the area
  std::vector<double> perimeters_;
  std::vector<Border> inside_;
  Eigen::MatrixXf sight_;                ///< sums over pairs of patches, times both areas
  Eigen::MatrixXf support_;              ///< planes x regions, times the area
  std::vector<Eigen::MatrixXf> images_;  ///< per plane: area of the image of a region (column) in each region (row)
  std::vector<std::vector<int>> neighbours_;
  std::map<std::pair<int, int>, Border> borders_;
};

/// Two regions became one.
struct Merge {
  int into, from;
};

/// Merges of regions, the likeliest to be one part first, until no two are neighbours.
struct MergeSequence {
  std::vector<Merge> merges;
  std::size_t num_likely = 0;  ///< of them up to where the likeliest is more likely two parts than one
};
/// \param regions by value: the merges are made on a copy.
MergeSequence mergeRegions(Regions regions, MergingEvidence kind);

}  // namespace pcl_symmetry
