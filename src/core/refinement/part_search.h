#pragma once

#include <functional>
#include <vector>

#include "pcl_symmetry/core/refinement/iterative_symmetric_points.h"

namespace pcl_symmetry {

/// A part of a surface, all that lies in a ball, and a plane of symmetry of that part.
struct SymmetricPart {
  ReflectionPlane plane;
  std::vector<int> points;  ///< indices of the points in the ball
  double support = 0.0;     ///< share of these points whose reflection lies on the surface, in [0, 1]
  int iterations = 0;       ///< of Iterative Symmetric Points
};

/// Share of samples (indices of points of the surface) that a plane maps onto the surface, in [0, 1].
using SupportOfSamples = std::function<double(const ReflectionPlane&, const std::vector<int>&)>;

/// Symmetries of parts of a surface, as planes 2 to 4 of Figure 8.
///
/// Departure from the paper, which takes them from the local maxima of the transform of the whole shape: a small part
/// contributes too little to the transform to be a maximum. Here planes through the middles of balls, of several radii
/// and spread over the surface, are refined on the points of their ball alone; the ball then moves to the plane. Where
/// parts overlap, the best remains.
/// \param surface normalised to the unit ball; its number of threads is that of the search.
/// \param refinement of each plane, from the widest to the narrowest weights.
/// \param support called from several threads.
/// \return large and well supported parts first.
std::vector<SymmetricPart> findSymmetricParts(const IspSurface& surface, const IspOptions& refinement,
                                              const SupportOfSamples& support);

}  // namespace pcl_symmetry
