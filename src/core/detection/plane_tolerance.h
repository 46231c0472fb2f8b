#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/detection/detection_rules.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry {

/// Two planes within both limits are one plane.
struct PlaneTolerance {
  double angle;   ///< between the normals, radians
  double offset;  ///< between the offsets from the origin of the planes' frame, its units

  bool same(const ReflectionPlane& a, const ReflectionPlane& b) const {
    const double sign = a.normal().dot(b.normal()) < 0.0 ? -1.0 : 1.0;
    return a.angleTo(b) <= angle && std::abs(a.offset() - sign * b.offset()) <= offset;
  }

  /// \param plane_of the member of an entry of the list that is its plane, or a function that takes it there.
  /// \return whether an entry of the list has the same plane.
  template <typename List, typename PlaneOf>
  bool anySame(const List& list, const ReflectionPlane& plane, const PlaneOf& plane_of) const {
    return std::any_of(list.begin(), list.end(),
                       [&](const auto& entry) { return same(std::invoke(plane_of, entry), plane); });
  }

  bool anySame(const std::vector<ReflectionPlane>& list, const ReflectionPlane& plane) const {
    return anySame(list, plane, [](const ReflectionPlane& entry) { return entry; });
  }
};

/// Limits within which two planes are one, normalized frame.
inline constexpr PlaneTolerance kSamePlane{kDetection.stages.same_angle, kDetection.stages.same_offset};

/// Limits within which two maxima share one basin of refinement, normalized frame.
inline constexpr PlaneTolerance kSameMaximum{kDetection.stages.same_maximum_angle,
                                             kDetection.stages.same_maximum_offset};

}  // namespace pcl_symmetry
