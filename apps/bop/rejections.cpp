#include "bop/rejections.h"

#include <pcl/conversions.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>

#include "io/exact_coordinates.h"
#include "io/shape_output.h"

namespace pcl_symmetry::apps {

namespace {

constexpr double kFarFailure = 10.0;  // tolerances; derived: as ObjectSymmetryOptions::max_feature has it

pcl::PointXYZRGB colouredPoint(const Eigen::Vector3f& x, double distance, double tolerance) {
  // Grey, vermilion and purple of Okabe and Ito: apart for all eyes.
  const auto colour = [](std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
    return pcl::PointXYZRGB(red, green, blue);
  };
  pcl::PointXYZRGB point = distance <= tolerance                 ? colour(190, 190, 190)
                           : distance <= kFarFailure * tolerance ? colour(213, 94, 0)
                                                                 : colour(117, 36, 107);
  point.getVector3fMap() = x;
  return point;
}

}  // namespace

void printRejections(const ObjectSymmetries& symmetries, int digits) {
  if (symmetries.at_half_tolerance && symmetries.at_twice_tolerance)
    std::printf("  tolerance %.3g  at half of it %s, at twice %s\n", symmetries.tolerance,
                symmetries.at_half_tolerance->name().c_str(), symmetries.at_twice_tolerance->name().c_str());
  const std::size_t count = std::min<std::size_t>(kMostRejections, symmetries.rejected.size());
  for (std::size_t i = 0; i < count; ++i) {
    const RejectedRotation& rejected = symmetries.rejected[i];
    std::printf("  rejected %s about %9.6f %9.6f %9.6f: %.1f %% of the surface off, %.1f %% far off, about %s\n",
                rejected.fold == 0 ? "any angle" : ("fold " + std::to_string(rejected.fold)).c_str(), rejected.axis.x(),
                rejected.axis.y(), rejected.axis.z(), 100.0 * rejected.off, 100.0 * rejected.far,
                spelled(rejected.where, digits).c_str());
  }
}

void writeRejections(const std::string& prefix, const ObjectSymmetries& symmetries, const SurfaceEvidence& surface,
                     const Eigen::Vector3d& shift) {
  const std::size_t count = std::min<std::size_t>(kMostRejections, symmetries.rejected.size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::vector<double> distances = surface.distances(symmetries.rejected[i].motion);
    pcl::PointCloud<pcl::PointXYZRGB> points;
    for (std::size_t k = 0; k < distances.size(); ++k) {
      const Eigen::Vector3d x = surface.points().col(static_cast<Eigen::Index>(k)).cast<double>() + shift;
      points.push_back(colouredPoint(x.cast<float>(), distances[k], surface.tolerance()));
    }
    pcl::PCLPointCloud2 cloud;
    pcl::toPCLPointCloud2(points, cloud);
    saveCloud(prefix + "_rejected_" + std::to_string(i + 1) + ".ply", cloud, Eigen::Vector4f::Zero(),
              Eigen::Quaternionf::Identity());
  }
}

}  // namespace pcl_symmetry::apps
