#include "core/segmentation/surface_extent.h"

#include <Eigen/Geometry>

#include "core/base/check.h"

namespace pcl_symmetry {

namespace {

constexpr double least_extent = 1e-15;  // input units; squares and sums stay within float
constexpr double greatest_extent = 1e15;

}  // namespace

void checkExtent(const PointsRef& points) {
  Eigen::AlignedBox3d box;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    if (points.col(i).allFinite()) box.extend(Eigen::Vector3d(points.col(i).cast<double>()));
  const double extent = box.isEmpty() ? 0.0 : box.diagonal().norm();
  check(extent == 0.0 || extent >= least_extent, "extent of the points", extent, ">= 1e-15");
  check(extent <= greatest_extent, "extent of the points", extent, "<= 1e15");
}

}  // namespace pcl_symmetry
