#pragma once

#include <vector>

#include "pcl_symmetry/core/surface_graph.h"

namespace pcl_symmetry {

/// Divides a surface into small patches of about equal size, whose borders prefer concave edges (over-segmentation).
///
/// Each of the num_patches largest connected pieces has at least one patch; smaller pieces belong to the closest patch.
/// \param num_patches >= 1; there may be a few more or fewer patches.
/// \param concave_detour >= 0, per radian: a step across an edge of concavity c > 0 is 1 + concave_detour * c times as
/// long.
/// \param first the element from which the first patch grows; -1 = the last element with an area.
/// \return the patch of each element, from 0.
std::vector<int> growPatches(const SurfaceGraph& graph, int num_patches, float concave_detour, int first = -1);

/// K small patches of a surface.
struct Patches {
  std::vector<int> of_element;  ///< the patch of each element, in [0, K)
  std::vector<double> areas;    ///< K, shares of the surface
  Points centers;               ///< 3 x K, means weighted by area, input frame
  Points normals;               ///< 3 x K, means weighted by area, unit

  int size() const { return static_cast<int>(areas.size()); }
};

/// Two neighboring patches and their common border.
struct PatchBorder {
  int from, to;
  double length;          ///< input units
  double edge_concavity;  ///< mean concavity of the edges, weighted by length, radians
  /// (n_from - n_to) . d in [-2, 2], with d the unit vector between the two centers; > 0 if the normals point toward
  /// each other.
  double patch_concavity;
};

/// Measures patches.
/// \param of_element the patch of each element, from 0.
Patches measuredPatches(const SurfaceGraph& graph, std::vector<int> of_element);

/// \return the borders between neighboring patches, ordered by patches.
std::vector<PatchBorder> patchBorders(const SurfaceGraph& graph, const Patches& patches);

}  // namespace pcl_symmetry
