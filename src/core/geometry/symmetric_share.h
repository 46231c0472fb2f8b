#pragma once

namespace pcl_symmetry {

/// What symmetric means: a plane is a symmetry at a tolerance if it maps this share of the surface to within the
/// tolerance of the surface (core/evidence/README.md); and the rest.
constexpr double kSymmetricShare = 0.97, kOffShare = 0.03;

}  // namespace pcl_symmetry
