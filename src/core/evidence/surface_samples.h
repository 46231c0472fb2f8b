#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/geometry/surface_normals.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

/// Parameters of the evidence of a plane, besides EvidenceUnits and the fitted numbers (confidence_fit.h).
struct EvidenceRules {
  // Surface of samples.
  float disc_radius = 1.25f;  ///< radius of the disc that a sample represents, spacings; 1 in 135 holds no other sample
  /// Roughness above which normals count for nothing (volumes: 0.42), and width of the decline, spacings.
  float max_roughness = 0.25f, trust_width = 0.1f;
  /// Deviation of a new point from a plane, relative to the nine points to which the plane was fitted.
  float new_point_factor = 1.41421356f;
  float disc_cell = 1.5f;         ///< edge of a cell of SurfaceDiscs, spacings
  float max_disc_spacing = 3.0f;  ///< greatest spacing for which a point makes a disc, median spacings
  float max_disc_cells = 96.0f;   ///< greatest number of cells along the longest edge

  // Support.
  float normal_reach = 0.01f;     ///< reach across the surface, radii of the points
  float rough_reach = 3.0f;       ///< reach across the surface, roughnesses: 99.7 % of Gaussian noise
  float normal_angle = 0.5f;      ///< angle up to which normals agree, radians
  float surely = 0.99999f;        ///< share of a reach that rounding does not exceed
  float max_sq_deviation = 9.0f;  ///< squared deviation that counts as no support

  double exact_depth = 4e-3;         ///< depth error, radii, up to which a pixel without depth means free space
  float free_without_depth = 0.15f;  ///< confidence in free space at such a pixel where errors are larger

  // Confidence.
  /// Greatest spacing, tolerances; by default, the tolerance is raised where the spacing is wider.
  double coarsest = 3.0;
  /// `coarsest` for flat clouds and for scans whose spacing raised the tolerance.
  double coarsest_part = 0.5 * coarsest;
  /// Share by which spacing raises the tolerance of a scan until coarsest_part applies to it fully.
  double surely_coarser = 0.05;
  double lost_per_coarseness = 2.0;  ///< log odds lost per tolerance of spacing beyond `coarsest`
  double unknown_share = 0.5;        ///< uncertainty of the share per uninformative share
  double tilt_ridge = 1e-4;          ///< ridge for tilts of the plane, far below the stiffness of constrained ones

  // Where a cloud ends.
  /// Share of an edge from which its region begins to count as missing, and from which it counts fully.
  float min_explained = 0.4f, explained = 0.75f;
  float standard_errors = 1.96f;  ///< standard errors of that share
  double min_piece = 0.002;       ///< least share of the surface in a piece that was cut off
  std::size_t min_of_piece = 8;   ///< least number of samples in such a piece
  double far_view = 100.0;        ///< distance, radii, from which rays are practically parallel
  double layered_sheet = 0.1;     ///< greatest layered share of an open sheet; 38 of 40 cut objects have more
  /// Share near borders up to which they are trusted fully, and from which not at all.
  double few_borders = 0.6, borders_everywhere = 0.75;
  /// Spacings by which a piece overlaps the last points: up to the first it lies beyond the cloud, from the second on
  /// it does not.
  float in_front = 3.0f, behind = 4.0f;
  /// Cosine between the direction to the piece and the normals of the last points, up to which the surface runs into
  /// the cut, and from which it closes.
  float runs_into = 0.65f, closes = 0.8f;
  float last_points = 2.0f;  ///< depth of the last points, spacings
  double outliers = 0.002;   ///< share of the points that are left out at the end as outliers
  int max_steps = 200;       ///< greatest number of steps between convex hulls
  float min_gain = 0.02f;    ///< least share by which a step reduces the squared distance
  float no_distance = 1.0f;  ///< distance, spacings, below which convex hulls overlap

  // Density of points that resolve no surface.
  int max_cells = 160;               ///< greatest number of cells along the longest side
  double cell_size = 0.5;            ///< edge of a cell, bandwidths
  double margin = 4.0;               ///< margin around the points, bandwidths
  double kernel_reach = 3.0;         ///< reach of the kernel, standard deviations
  double cell_variance = 1.0 / 3.0;  ///< variance that spreading and interpolation add, squared cells
  double min_variance = 0.1;         ///< variance below which no blur is needed, squared cells
  double step = 0.5;                 ///< displacement of the farthest points for a difference, bandwidths
  double longest_step = 3.0;         ///< greatest step, in differences, within which the quadratic fit is valid
  double settled = 0.01;             ///< step that ends the refinement, bandwidths; far below the error of a plane
  double min_curvature = 1e-3;       ///< least curvature, as a share of the greatest
};

inline constexpr EvidenceRules kEvidence;

/// The piece of surface that a sample represents: a disc in its tangent plane.
struct SurfaceDisc {
  Eigen::Vector3f center, normal;  ///< center and unit normal
  float radius;

  /// \return squared distance of a point; distances across the disc are multiplied by the root of \p sq_across_factor.
  float sqDistance(const Eigen::Vector3f& x, float sq_across_factor = 1.0f) const {
    const Eigen::Vector3f difference = x - center;
    const float across = normal.dot(difference), sq_across = across * across;
    const float sq_along = std::max(0.0f, difference.squaredNorm() - sq_across);
    if (sq_along <= radius * radius) return sq_across_factor * sq_across;
    const float beside = std::sqrt(sq_along) - radius;
    return sq_across_factor * sq_across + beside * beside;
  }
};

/// The surface that samples describe, as a disc in the tangent plane of each sample. Cells of a grid list the discs
/// near them, so that a point is compared with a few discs and needs no tree.
class SurfaceDiscs {
public:
  struct Nearest {
    int disc = -1;  ///< index of the sample; -1 if no disc is within reach
    float distance = std::numeric_limits<float>::infinity();
  };

  /// \param samples 3 x N, finite, N >= 1.
  /// \param geometry local geometry of the samples.
  /// \param disc_radius spacings, > 0.
  /// \param reach greatest distance of a query, units of the samples, > 0.
  SurfaceDiscs(const Points& samples, const LocalGeometry& geometry, float disc_radius, float reach);

  /// The nearest disc within reach of a point.
  Nearest nearest(const Eigen::Vector3f& x) const;

  /// Whether a disc is within \p distance <= reach of a point.
  bool isWithin(const Eigen::Vector3f& x, float distance) const;

  /// Distance of sample \p i from the discs of the others, as if it were a new sample. Distances across a disc are
  /// multiplied by \p across_factor.
  /// \return infinity if no other disc is within reach.
  float ownDistance(int i, float across_factor) const;

private:
  struct Range {
    const int *begin, *end;
  };

  Range discsNear(const Eigen::Vector3f& x) const;
  template <typename Visit>
  void visitCells(const SurfaceDisc& disc, const Visit& visit) const;

  std::vector<SurfaceDisc> discs_;
  float reach_;
  float cell_size_;
  Eigen::Vector3f origin_;  ///< corner of the grid
  Eigen::Array3i size_;     ///< cells along each axis
  std::vector<int> first_;  ///< for each cell, its first index in entries_; one more at the end
  std::vector<int> entries_;
};

/// A sample of a surface, the disc of surface that it represents, and its neighborhood.
struct alignas(64) SurfaceSample : SurfaceDisc {
  float roughness;     ///< LocalGeometry::roughness
  float normal_trust;  ///< reliability of the normal, in [0, 1]: 0 for noise beyond the spacing
  std::array<int, kNumDiscNeighbors> nearest;
};

using SurfaceSamples = std::vector<SurfaceSample>;

/// \param points 3 x N.
/// \param geometry of the points.
SurfaceSamples surfaceSamples(const Points& points, const LocalGeometry& geometry, int num_threads = 1);

/// How far points lie from the surface that samples describe. Each sample represents a disc in its tangent plane; the
/// disc of the closest sample or of one of its four neighbors counts, whichever is nearest.
/// \param points 3 x M, in the frame of the samples.
/// \param closest M indices of the closest samples; -1 = none is near.
/// \param samples the N samples.
/// \return M distances >= 0, units of the samples; infinity where no sample is near.
std::vector<float> surfaceDistances(const Points& points, const std::vector<int>& closest,
                                    const SurfaceSamples& samples, int num_threads = 1);

/// Distance of each sample from the surface that the others describe: the effect of sampling and noise alone.
/// \param samples the N >= 2 samples.
/// \return N distances >= 0, units of the samples.
std::vector<float> ownSurfaceDistances(const SurfaceSamples& samples, int num_threads = 1);

/// \param distances at least one.
/// \return share of the distances that are at most \p tolerance, in [0, 1].
double shareWithin(const std::vector<float>& distances, double tolerance);

/// Evidence of each of M reflected points, in [0, 1].
struct PointEvidence {
  std::vector<float> support;   ///< how well each reflection lies on the surface
  std::vector<float> conflict;  ///< how well each reflection lies in free space

  /// The support; NaN where the scanner could not see whether the reflection lies on the surface.
  std::vector<float> seenSupport() const;
};

/// How surely a point lies in free space. A pixel without a depth means free space if the sensor is exact, but little
/// if it has errors: it may be a shadow of the projector, or an occluder may have been cut out of the image.
/// \param x in the unit ball.
/// \return in [0, 1]: 0 behind the visible surface, 1 in front of it.
float freeConfidence(const Visibility& visibility, const Eigen::Vector3d& x);

/// How well single points of a surface support a reflection (the white regions of Figure 8). Near an edge the closest
/// sample may lie on another face: the best of that sample and of those next to it counts.
///
/// Departure from the paper: it measures the distance of the reflected point by the Gaussian of the transform; here the
/// unit is the spacing of the samples, so that the result needs no length in input units. A reflected point that lies
/// on the surface is farther from the closest sample than 1.25 spacings in 1 of 135 cases (spacing = 1 / sqrt(density),
/// measured at that sample). Up to there the support is 1; beyond, it falls as a Gaussian.
/// \param reflected 3 x M, reflections of points of the surface, normalized to the unit ball.
/// \param reflected_normals 3 x M, reflections of their normals.
/// \param closest M indices of the closest samples; -1: none is near.
/// \param samples the surface, in the same frame.
/// \param visibility what a scanner saw, in the same frame; null = the samples show the object from all sides.
PointEvidence pointEvidence(const Points& reflected, const Points& reflected_normals, const std::vector<int>& closest,
                            const SurfaceSamples& samples, const Visibility* visibility, int num_threads = 1);

/// Support of each sample by the surface that the other samples describe, which a symmetry reaches under this sampling.
/// \param samples the N samples, normalized to the unit ball.
/// \return N values in [0, 1].
std::vector<float> ownSupport(const SurfaceSamples& samples, int num_threads);

/// Support of \p points for several planes, on the surface that \p samples describe.
/// \param points 3 x M, finite.
/// \param samples 3 x N, finite, not all equal, in the same frame.
/// \param planes in the same frame.
/// \param seen what the scanner saw, same frame; null: the samples show the surface from all sides.
/// \return M values for each plane, as from PointEvidence::seenSupport().
/// \throws std::invalid_argument where all samples coincide.
std::vector<std::vector<float>> planeSupport(const PointsRef& points, const PointsRef& samples,
                                             const std::vector<ReflectionPlane>& planes,
                                             const Visibility* seen = nullptr, int num_threads = 0);

}  // namespace pcl_symmetry
