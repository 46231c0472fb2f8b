#include "evaluate/frames/alignment_methods.h"

#include <Eigen/LU>

#include "common/command_line/console.h"
#include "core/geometry/principal_axes.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/symmetry_alignment.h"

namespace pcl_symmetry::apps {

namespace {

// Share of the radius of the scan. chosen: about as far as a hidden half moves the center of mass; smaller values push
// too little, larger ones beyond the middle.
constexpr double kPush = 0.15;

FoundFrame bySymmetry(bool as_published, const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud, std::uint64_t seed,
                      int num_threads) {
  FrameOptions options;
  options.as_published = as_published;
  SymmetryAlignment<pcl::PointXYZ> alignment;
  alignment.setOptions(options);
  alignment.setRandomSeed(seed);
  alignment.setNumberOfThreads(num_threads);
  if (as_published) alignment.setViewpointMode(Viewpoint::Mode::None);
  alignment.setInputCloud(cloud);
  const SymmetryFrame frame = alignment.compute();
  if (!alignment.getReason().empty()) detail::throwBadArgument(alignment.getReason());
  FoundFrame found{frame.center, frame.axes, {}, frame.revolution_axis};
  for (const Eigen::Isometry3d& T_canonical_input : frame.equivalent)
    found.equivalent.emplace_back(T_canonical_input.linear().transpose());
  return found;
}

FoundFrame byMass(const pcl::PointCloud<pcl::PointXYZ>& cloud, const std::optional<Eigen::Vector3d>& away_from) {
  const Points points = detail::selectPoints(cloud, nullptr, cloud.size(), 0).points;
  const PrincipalAxes principal = principalAxes(points);
  FoundFrame found{principal.center, principal.axes, {}};
  if (away_from) found.center += kPush * boundingBall(points).radius * (principal.center - *away_from).normalized();
  for (int k = -1; k < 3; ++k) {
    Eigen::Vector3d signs = Eigen::Vector3d::Constant(k < 0 ? 1.0 : -1.0);
    if (k >= 0) signs[k] = 1.0;
    found.equivalent.emplace_back(found.axes * signs.asDiagonal());
  }
  return found;
}

}  // namespace

std::string toString(AlignmentMethod method) {
  switch (method) {
    case AlignmentMethod::Symmetry:
      return "symmetry";
    case AlignmentMethod::AsPublished:
      return "as published";
    case AlignmentMethod::CenterOfMass:
      return "mass and PCA";
    default:
      return "mass + 0.15 R";
  }
}

FoundFrame FoundFrame::transformed(const Eigen::Isometry3d& motion) const {
  FoundFrame result = *this;
  result.center = motion * center;
  result.axes = motion.linear() * axes;
  for (Eigen::Matrix3d& other : result.equivalent) other = motion.linear() * other;
  return result;
}

FoundFrame findFrame(AlignmentMethod method, const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud,
                     const std::optional<Eigen::Vector3d>& viewpoint, std::uint64_t seed, int num_threads) {
  Stopwatch watch;
  FoundFrame found = method == AlignmentMethod::Symmetry || method == AlignmentMethod::AsPublished
                         ? bySymmetry(method == AlignmentMethod::AsPublished, cloud, seed, num_threads)
                         : byMass(*cloud, method == AlignmentMethod::PushedMass ? viewpoint : std::nullopt);
  found.milliseconds = watch.lap();
  return found;
}

}  // namespace pcl_symmetry::apps
