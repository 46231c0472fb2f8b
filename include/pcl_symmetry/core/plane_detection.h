#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/gaussian_edt.h"
#include "pcl_symmetry/core/iterative_symmetric_points.h"
#include "pcl_symmetry/core/local_maxima.h"
#include "pcl_symmetry/core/symmetry_map.h"

namespace pcl_symmetry {

/// A refined local maximum of the transform. Canonical: theta of the normal in [0, pi/2].
struct SymmetryPlane : ReflectionPlane {
  /// D(f, gamma) at this very plane, the paper's measure: the correlation of the GEDT with its reflection, in [0, 1].
  double score = 0.0;
  /// Share of the points whose reflection lies on the cloud within the spacing of its samples, in [0, 1]: the mean of
  /// point_support. Does not depend on sigma.
  double support = 0.0;
  /// One value in [0, 1] per point used, in their order: 1 where the reflection meets the surface as closely as samples
  /// of the surface themselves lie, falling to 0 beyond.
  std::vector<float> point_support;
  int iterations = 0;        ///< of Iterative Symmetric Points, all stages
  bool converged = false;    ///< the plane stood still
  bool approximate = false;  ///< below DetectionOptions::min_support or min_score
  double residual = 0.0;  ///< weighted root mean square distance of the reflected points from the surface, input units
};

struct DetectionOptions {
  GaussianEdtOptions edt;
  /// Bins of the map that candidates come from. As many as the paper's 64 x 64 directions, but as fine in phi at the
  /// equator as in theta, because a peak of D is narrower than a bin of 5.6 degrees.
  int num_theta = 32;    ///< >= 1
  int num_phi = 128;     ///< even, >= 2
  int num_radius = 64;   ///< >= 1
  int num_samples = 64;  ///< of the sampled transform, >= 1: 1 % of PRST is enough to find maxima
  LocalMaximaOptions maxima;
  int max_candidates = 24;       ///< strongest maxima that are refined, >= 1
  bool principal_planes = true;  ///< planes across the principal axes are candidates too
  /// A candidate that refinement moves by more than this many bins beyond its own is unstable and dropped, >= 0; the
  /// paper has 0. One bin leaves room for the noise of the sampled map.
  double max_drift = 1.0;
  IspUpdate update = IspUpdate::PointToPlane;
  int num_coarse_samples = 100;     ///< points reflected in early iterations, >= 10
  int num_refine_samples = 10'000;  ///< points reflected in late iterations (the paper's figure), >= 10
  int max_iterations = 30;          ///< of each stage, >= 1
  double merge_angle = 0.035;       ///< radians, >= 0: planes closer than this in angle ...
  double merge_offset = 0.02;       ///< ... and this share of the radius in offset are one, >= 0
  /// A plane is a symmetry of the shape where support and score reach these two, in [0, 1]. Set by hand on few shapes:
  /// sampled boxes have 0.999 and 0.97 and more from 1000 points on; the best plane of a scalene tetrahedron and of a
  /// sphere with five bumps has at most 0.90 and 0.86 from 4000 points on, and with 1000, whose spacing lets nearly
  /// everything pass, a score below 0.87. One-sided scans of symmetric objects mostly stay below.
  double min_support = 0.9;
  double min_score = 0.9;
  /// Reports the other maxima too: approximate symmetries and symmetries of parts.
  bool approximate = false;
  int max_planes = 20;  ///< >= 1
  std::uint64_t seed = 1;
  int num_threads = 0;  ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

struct Detection {
  std::vector<SymmetryPlane> planes;                      ///< best first: by support, then by score
  SymmetryMap map;                                        ///< empty where one was given
  std::vector<std::pair<std::string, double>> timing_ms;  ///< stages in order
};

/// From points to planes: transform, maxima, refinement (Sections 4.1 to 4.4).
/// \param points 3 x N, finite, input units; at least two different ones.
/// \throws std::invalid_argument for bad options or points without extent.
/// \param make_search makes the search of refineMaxima for the distance transform of these points; null = FLANN.
Detection detectPlanes(const PointsRef& points, const DetectionOptions& options = {},
                       const std::function<ClosestPointSearch::Ptr(const GaussianEdt&)>& make_search = nullptr);

/// The same from a map that was made before.
/// \param edt,map of these points. \param search closest points among \p points divided by edt.radius() after taking
/// away edt.center(); null = FLANN.
Detection refineMaxima(const PointsRef& points, const GaussianEdt& edt, const SymmetryMap& map,
                       const DetectionOptions& options = {}, ClosestPointSearch::Ptr search = nullptr);

}  // namespace pcl_symmetry
