#pragma once

#include <cstdint>
#include <vector>

namespace pcl_symmetry {

/// Sums of the lanes of bundles at equally spaced places, which differ from lane to lane of a row by a fraction of the
/// distance, and what they add up to at common places, by quintic splines (Unser, Splines: a perfect fit, 1999).
class LaneSums {
public:
  /// \param num_places of each lane.
  /// \param most_ahead distances that the first and the last lane of a row are from its middle, at most.
  LaneSums(int num_places, double most_ahead);

  /// \return number s * kBundleLanes + j is the sum of lane j at place s.
  std::int32_t* data() { return sums_.data(); }

  /// Adds the sums to the values at common places, and sets them to 0.
  /// \param ahead distances that each lane of a row is ahead of the one before; the middle of a row is at the common
  /// places.
  void bringTogether(double ahead);

  /// \return the value at common place s, 0 outside of [0, num_places).
  float at(std::int64_t s) const;

  /// Sets the values to 0.
  void clear();

private:
  int num_places_;
  int margin_;  ///< zeros on both sides of lane_
  std::vector<std::int32_t> sums_;
  std::vector<float> lane_;
  std::vector<float> coefficients_;  ///< of the spline through the values, with kReach zeros on both sides
};

}  // namespace pcl_symmetry
