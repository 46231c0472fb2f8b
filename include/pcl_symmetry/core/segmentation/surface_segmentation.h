#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "pcl_symmetry/core/geometry/reflection_plane.h"
#include "pcl_symmetry/core/surface/surface_graph.h"
#include "pcl_symmetry/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// How a surface is cut into parts.
enum class SegmentationMethod {
  /// Small patches grow together to parts until none of them are more likely one part than two: beyond the paper.
  Merging,
  Splitting  ///< the paper's: clusters of equal support are split in two again and again (Section 5.3)
};

/// What merging goes by, beside areas and borders.
enum class MergingEvidence {
  Symmetry,              ///< support for the planes of the surface, and what is the image of what
  SymmetryAndConcavity,  ///< people see borders of parts where a surface is concave
  All                    ///< and thickness of the body and lines of sight within, which need a surface with an inside
};

struct MergingOptions {
  MergingEvidence evidence = MergingEvidence::All;
  int num_patches = 300;      ///< at the beginning, >= 1; time and memory grow with its square
  double least_area = 0.003;  ///< smaller regions join a neighbour; share of the surface, in [0, 1)
  /// Where a plane maps nearly all of the surface onto itself, the parts on one side are the images of those on the
  /// other, or lie across it. Not where the number of parts is given.
  bool agree_across_planes = true;
  /// Borders between parts are drawn anew by a minimum cut within this distance of them, in square roots of the area of
  /// the surface, >= 0; 0 leaves them along the patches.
  double cut_band = 0.03;
  double concavity_weight = 3.0;  ///< of that cut, as in SplittingOptions, >= 0; none with Symmetry alone

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// The paper's method. Its rule for the end (a node is split as long as a plane reflects more than min_share and less
/// than max_share of it onto itself) hardly ever ends, so that the depth decides.
struct SplittingOptions {
  int depth = 3;           ///< splits in a row at most, >= 0; up to 2^depth parts
  double min_share = 0.1;  ///< of the area, in [0, max_share]
  double max_share = 0.9;  ///< of the area, in [min_share, 1]
  double strength = 0.1;   ///< significant maxima: D >= strength * strongest D, as in LocalMaximaOptions, in [0, 1]
  int max_planes = 20;     ///< strongest maxima that count as features, >= 1
  double cut_band = 0.1;   ///< radii of the part: so far from the border of the clusters the cut may lie, > 0
  /// Capacity of the cut along an edge of concavity c: length * exp(-concavity_weight * c), c > 0 in radians; >= 0.
  /// With 0 (the paper's) the length alone counts, and cuts take the shortest way, through the thigh.
  double concavity_weight = 0.0;

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

struct SegmentationOptions {
  SegmentationMethod method = SegmentationMethod::Merging;
  MergingOptions merging;
  SplittingOptions splitting;  ///< its strength and max_planes hold for merging too
  int num_parts = 0;           ///< >= 0; 0 = as many as the method finds. Splitting takes the largest part first.
  std::uint64_t seed = 1;
  int num_threads = 0;  ///< >= 0; 0 = one per core
  /// Told the share of the work that is done, in [0, 1], now and then; may be empty.
  std::function<void(double)> progress;

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// A plane and how much of a part it reflects onto itself.
struct PartPlane {
  ReflectionPlane plane;
  double share;  ///< of the area of the part, in [0, 1]
};

/// A part of the surface, split in two or whole.
struct SegmentNode {
  int parent = -1;             ///< -1: the root
  int children[2] = {-1, -1};  ///< -1: a leaf
  int segment = -1;            ///< number of a leaf's segment; -1: not a leaf
  int depth = 0;
  std::vector<PartPlane> planes;  ///< significant planes of the part, strongest first
};

/// Planes that reflect no less of the surface onto itself have an image for every segment.
constexpr double kMappedShare = 0.75;

struct Segmentation {
  std::vector<int> labels;  ///< one per element, from 0, by falling area of the segments
  int num_segments = 0;
  std::vector<SegmentNode> tree;  ///< the root first, children after their parents
  /// Per plane of the root of share >= kMappedShare, in their order: the segment that each segment is reflected onto,
  /// which may be itself.
  std::vector<std::vector<int>> images;
};

/// Cuts a surface into parts by its symmetries (Section 5.3).
/// \throws std::invalid_argument for bad options or a surface without extent.
Segmentation segmentSurface(const SurfaceGraph& graph, const SegmentationOptions& options = {});

}  // namespace pcl_symmetry
