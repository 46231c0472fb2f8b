#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "pcl_symmetry/core/closest_point_search.h"
#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/reflection_plane.h"
#include "pcl_symmetry/core/surface_graph.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// How a surface is cut into parts.
enum class SegmentationMethod {
  Merging,   ///< small patches are merged as long as two of them are more likely one part than two; not in the paper
  Splitting  ///< the paper's method: two-means of the support for symmetry planes, again and again (Section 5.3)
};

/// The evidence that merging uses, beside areas and contact.
enum class MergingEvidence {
  /// Support for the planes of the surface, regions that are each other's reflection, and concave edges: for surfaces
  /// without an inside, such as scans from one side.
  SymmetryAndConcavity,
  All  ///< also the thickness of the body and lines of sight within it
};

/// Options of SegmentationMethod::Splitting (Section 5.3). A part is split if a plane maps between the paper's 10 % and
/// 90 % of it onto itself; usually `depth` ends the splitting.
struct SplittingOptions {
  /// Greatest number of successive splits, in [0, 30]: the paper's "user-supplied depth". There are up to 2^depth
  /// parts.
  int depth = 3;

  /// An edge of concavity c > 0 radians costs length * exp(-concavity_weight * c) to cut; >= 0. With the paper's 0 the
  /// length alone counts.
  double concavity_weight = 0.0;

  /// Follows Sections 4.4 and 5.3 to the letter: the features are all maxima of the exact map as publishedPlanes()
  /// refines them, with 1000 points instead of the paper's 10 000, and elements outside the two largest components are
  /// assigned to the closer one. Otherwise a maximum whose refinement leaves its basin keeps its position on the grid,
  /// maxima of one basin count once, and the cut assigns the other elements.
  bool as_published = false;

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// Options of segmentSurface().
struct SegmentationOptions {
  SegmentationMethod method = SegmentationMethod::Merging;  ///< how parts are found
  MergingEvidence evidence = MergingEvidence::All;          ///< evidence used by SegmentationMethod::Merging
  SplittingOptions splitting;                               ///< options of SegmentationMethod::Splitting
  int num_parts = 0;       ///< >= 0; 0: the method finds the number. Splitting then splits the largest part first.
  std::uint64_t seed = 1;  ///< seed of the random samples
  int num_threads = 0;     ///< >= 0; 0: one per core
  /// Called repeatedly with the share of the work that is done, in [0, 1]; may be empty.
  std::function<void(double)> progress;
  MakeSearch make_search;  ///< makes the searches of Iterative Symmetric Points, one after the other; empty = FLANN

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// A plane and the share of a part that it maps onto itself.
struct PartPlane {
  ReflectionPlane plane;  ///< input frame
  double share;           ///< share of the area of the part that the plane maps onto the part, in [0, 1]
};

/// A node of the segmentation tree: a part of the surface, either split in two or a segment.
struct SegmentNode {
  int parent = -1;                ///< index into the tree; -1 for the root
  int children[2] = {-1, -1};     ///< indices into the tree; -1 for a leaf
  int segment = -1;               ///< number of the segment of a leaf; -1 for other nodes
  int depth = 0;                  ///< depth of the node; 0 for the root
  std::vector<PartPlane> planes;  ///< significant planes of the part, strongest first
};

/// Least share of the whole surface that a plane must map onto itself for Segmentation::images. At 0.5, planes pair
/// segments that are not alike; near 1, only nearly symmetric shapes have pairs.
constexpr double kMappedShare = 0.75;

/// The result of segmentSurface().
struct Segmentation {
  std::vector<int> labels;        ///< one per element: number of its segment, from 0; segment 0 has the largest area
  int num_segments = 0;           ///< number of segments; labels are below it
  std::vector<SegmentNode> tree;  ///< the root first, children after their parents
  /// One list per plane of the root with share >= kMappedShare, in the same order: the segment that each segment is
  /// reflected onto, which may be itself.
  std::vector<std::vector<int>> images;
  std::string reason;  ///< why the number of segments differs from SegmentationOptions::num_parts; else empty
};

/// Cuts a surface into parts by its symmetries (Section 5.3).
///
/// A cloud of fewer than 20 distinct points is one segment, whatever the options say: so few points show no surface.
/// \param graph N elements, from meshGraph() or cloudGraph().
/// \param options method, evidence, number of parts.
/// \return labels of the N elements, the tree of the parts and their images.
/// \throws std::invalid_argument for bad options or a surface without area.
Segmentation segmentSurface(const SurfaceGraph& graph, const SegmentationOptions& options = {});

/// The same for a cloud, whose points are joined with their 12 nearest ones.
/// \param points 3 x N, finite, N >= 1.
/// \param max_points number of points drawn from a larger cloud, one from each of as many equal runs; other points take
/// the label of the closest one drawn.
/// \return labels of the N points.
Segmentation segmentCloud(const PointsRef& points, std::size_t max_points, const SegmentationOptions& options = {});

}  // namespace pcl_symmetry
