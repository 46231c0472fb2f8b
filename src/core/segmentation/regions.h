#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "core/segmentation/merge_cues.h"
#include "core/segmentation/part_evidence.h"

namespace pcl_symmetry {

/// Regions of a surface that grow together, at first one per patch. A region has the number of one of its patches.
class Regions {
public:
  /// One region per patch.
  explicit Regions(const PartEvidence& evidence);

  /// \return the number of patches; regions have numbers below it.
  int size() const { return static_cast<int>(areas_.size()); }

  /// \return share of the surface.
  double area(int region) const { return areas_[region]; }
  const std::vector<int>& neighbors(int region) const { return neighbors_[region]; }

  /// \return the region of each patch.
  const std::vector<int>& ofPatches() const { return region_; }

  /// What speaks for and against two neighbors being one part.
  Cues cues(int a, int b) const;

  /// \return the region that holds most of the reflection of a region in a plane of PartEvidence::images; -1 for none.
  int imageOf(int region, std::size_t plane) const { return image_of_[plane][region]; }

  /// Makes \p b part of \p a; they need not be neighbors.
  void merge(int a, int b);

private:
  /// Sums along a border, weighted by length.
  struct Border {
    double length = 0.0, edge_concavity = 0.0, patch_concavity = 0.0, log_thickness = 0.0;
    void add(const Border& other);
  };
  Border& border(int a, int b) { return borders_[std::minmax(a, b)]; }
  void joinNeighbors(int a, int b);
  void joinImages(int a, int b);

  std::vector<int> region_;              ///< of each patch
  std::vector<double> areas_;            ///< shares of the surface
  std::vector<double> log_thickness_;    ///< sums over patches, weighted by area
  std::vector<double> perimeters_;       ///< input units
  std::vector<Border> inside_;           ///< sums over the borders between patches of one region
  Eigen::MatrixXf sight_;                ///< sums over pairs of patches, weighted by both areas
  Eigen::MatrixXf support_;              ///< planes x regions, sums over patches, weighted by area
  std::vector<Eigen::MatrixXf> images_;  ///< per plane: area of the reflection of a region (column) in a region (row)
  std::vector<std::vector<int>> image_of_;  ///< per plane: of each region; the row with the most area in its column
  std::vector<std::vector<int>> neighbors_;
  std::map<std::pair<int, int>, Border> borders_;
};

}  // namespace pcl_symmetry
