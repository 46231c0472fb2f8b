#include "core/segmentation/surface_extent.h"

#include <Eigen/Geometry>

#include "core/base/check.h"

namespace pcl_symmetry {

namespace {

// Input units. derived: squares between 1e-30 and 1e30 leave eight digits to the ends of float for sums and ratios.
constexpr double kLeastExtent = 1e-15, kGreatestExtent = 1e15;

}  // namespace

void checkExtent(const PointsRef& points) {
  Eigen::AlignedBox3d box;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    if (points.col(i).allFinite()) box.extend(Eigen::Vector3d(points.col(i).cast<double>()));
  const double extent = box.isEmpty() ? 0.0 : box.diagonal().norm();
  check(extent == 0.0 || extent >= kLeastExtent, "extent of the points", extent, ">= 1e-15");
  check(extent <= kGreatestExtent, "extent of the points", extent, "<= 1e15");
}

}  // namespace pcl_symmetry
