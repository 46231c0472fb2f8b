#include "io/exact_coordinates.h"

#include <pcl/conversions.h>

#include <algorithm>
#include <cmath>

#include "io/answers.h"
#include "io/cloud_file.h"

namespace pcl_symmetry::apps {

namespace {

/// Relative spacing of float numbers: 23 bits of mantissa.
constexpr double kFloatSpacing = 0x1.0p-23;
constexpr double kAllowedSpacing = 1e-5;  // greatest spacing of coordinates, as a share of the extent

}  // namespace

Eigen::Vector3d shiftFor(const std::vector<Eigen::Vector3d>& points) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : points)
    if (point.allFinite()) box.extend(point);
  if (box.isEmpty()) return Eigen::Vector3d::Zero();
  const double extent = box.sizes().maxCoeff();
  const double largest = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  // A single point has no shape to lose.
  if (!(extent > 0.0) || !std::isfinite(extent) || largest * kFloatSpacing <= kAllowedSpacing * extent)
    return Eigen::Vector3d::Zero();
  const double unit = std::exp2(std::floor(std::log2(extent)));
  const Eigen::Vector3d shift = (box.center() / unit).array().round().matrix() * unit;
  // Extents below the smallest normal number give no unit in which the center could be rounded.
  return shift.allFinite() ? shift : Eigen::Vector3d::Zero();
}

Cloud shifted(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& shift) {
  Cloud cloud;
  cloud.reserve(points.size());
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3f p = (point - shift).cast<float>();
    cloud.emplace_back(p.x(), p.y(), p.z());
  }
  return cloud;
}

int digitsOfFloat(const Cloud& points, const Eigen::Vector3d& shift) {
  Eigen::AlignedBox3f box;
  for (const pcl::PointXYZ& point : points)
    if (point.getVector3fMap().allFinite()) box.extend(point.getVector3fMap());
  const double spacing = kFloatSpacing * shift.cwiseAbs().maxCoeff();
  return std::max(0, static_cast<int>(std::floor(std::log10(box.sizes().norm() / spacing))));
}

pcl::PCLPointCloud2 toFields(const Cloud& points, const Eigen::Vector3d& shift) {
  pcl::PCLPointCloud2 cloud;
  if (shift.isZero(0.0)) {
    pcl::toPCLPointCloud2(points, cloud);
    return cloud;
  }
  cloud.header = points.header;
  cloud.is_dense = points.is_dense;
  for (const char* name : {"x", "y", "z"}) {
    Column column{name, pcl::PCLPointField::FLOAT64, 1, sizeof(double), 0, -1};
    addField(column, cloud);
  }
  makeRoom(points.width, points.height, cloud);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d point = points[i].getVector3fMap().cast<double>() + shift;
    std::memcpy(&cloud.data[i * cloud.point_step], point.data(), cloud.point_step);
  }
  return cloud;
}

Viewpoint shifted(Viewpoint viewpoint, const Eigen::Vector3d& shift) {
  if (viewpoint.mode == Viewpoint::Mode::Given) viewpoint.position -= shift;
  return viewpoint;
}

Eigen::Vector4d shifted(const Eigen::Vector4d& plane, const Eigen::Vector3d& shift) {
  return {plane[0], plane[1], plane[2], plane[3] + plane.head<3>().dot(shift)};
}

Eigen::Vector3d shiftedBack(const Eigen::Vector3d& point, const Eigen::Vector3d& shift) {
  // Adding zero would turn -0 into 0.
  return shift.isZero(0.0) ? point : Eigen::Vector3d(point + shift);
}

ReflectionPlane shiftedBack(const ReflectionPlane& plane, const Eigen::Vector3d& shift) {
  if (shift.isZero(0.0)) return plane;
  return ReflectionPlane(plane.normal(), plane.offset() + plane.normal().dot(shift));
}

Eigen::Isometry3d shiftedBack(const Eigen::Isometry3d& T_target_source, const Eigen::Vector3d& source_shift,
                              const Eigen::Vector3d& target_shift) {
  Eigen::Isometry3d result = T_target_source;
  if (!source_shift.isZero(0.0)) result.translation() -= T_target_source.linear() * source_shift;
  if (!target_shift.isZero(0.0)) result.translation() += target_shift;
  return result;
}

Eigen::Vector4d printedCoefficients(const ReflectionPlane& plane, const Eigen::Vector3d& shift) {
  constexpr double kDecimals = 1e6;
  Eigen::Vector4d coefficients;
  for (int k = 0; k < 3; ++k) coefficients[k] = std::round(kDecimals * plane.normal()[k]) / kDecimals + 0.0;
  const Eigen::Vector3d normal = coefficients.head<3>();
  // The point of the plane that is closest to the middle of the points.
  coefficients[3] = -normal.dot(shift + plane.offset() * plane.normal()) + 0.0;
  return coefficients;
}

int lengthDigits(const Eigen::Vector3d& shift) {
  // Six digits resolve 1e-5 of the extent; a shift of up to a million extents takes six more.
  return shift.isZero(0.0) ? 6 : 12;
}

std::string spelled(const Eigen::Vector3d& point, int digits) {
  return formatted("%.*g %.*g %.*g", digits, point.x(), digits, point.y(), digits, point.z());
}

}  // namespace pcl_symmetry::apps
