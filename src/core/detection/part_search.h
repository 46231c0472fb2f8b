/// Planes that are symmetries of parts of a surface: of what lies in a ball.
#pragma once

#include <functional>
#include <vector>

#include "pcl_symmetry/core/refinement/iterative_symmetric_points.h"

namespace pcl_symmetry {

struct SymmetricPart {
  ReflectionPlane plane;
  std::vector<int> points;  ///< of the surface, in the ball
  double support = 0.0;     ///< of the plane among them, in [0, 1]
  int iterations = 0;
};

/// Share of the samples (indices of points of the surface) that a plane maps onto the surface, in [0, 1].
using SupportOfSamples = std::function<double(const ReflectionPlane&, const std::vector<int>&)>;

/// Balls of several sizes about places spread over the surface. Planes through the middle of a ball are refined on its
/// points alone; the ball then moves to where the plane is. Of parts that overlap the best remains, as a limb has many.
/// \param surface normalised to the unit ball; its number of threads is that of the search. \param refinement of each
/// plane, from the widest to the narrowest weights.
/// \return best first: those that are large and well supported.
std::vector<SymmetricPart> findSymmetricParts(const IspSurface& surface, const IspOptions& refinement,
                                              const SupportOfSamples& support);

}  // namespace pcl_symmetry
