#pragma once

#include <Eigen/Core>
#include <vector>

namespace pcl_symmetry {

/// mean + cosine cos(phi) + sine sin(phi): the squared distance of a point from one that rotates about an axis.
struct CircleWave {
  double mean, cosine, sine;

  /// \param terms 1, cos(phi) and sin(phi).
  double at(const Eigen::Vector3d& terms) const { return mean * terms[0] + cosine * terms[1] + sine * terms[2]; }
};

/// The angle at which the greatest of some waves is least.
///
/// That is at the trough of a wave, or where two waves cross: both have closed forms. Intervals of angles whose
/// greatest wave cannot be less are cut off, and so are waves that are nowhere the greatest.
/// \param waves at least one.
/// \return radians, in [0, 2 pi].
double circleMinimax(const std::vector<CircleWave>& waves);

}  // namespace pcl_symmetry
