#include "evaluate/frames/alignment_methods.h"

#include <Eigen/LU>

#include <set>

#include "common/command_line/console.h"
#include "common/command_line/tool_errors.h"
#include "core/geometry/principal_axes.h"
#include "evaluate/frames/published_frame.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/symmetry_alignment.h"

namespace pcl_symmetry::apps {

namespace {

// Share of the radius of the scan. chosen: about as far as a hidden half moves the center of mass; smaller values push
// too little, larger ones beyond the middle.
constexpr double kPush = 0.15;

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

Points pointsOf(const Cloud& cloud) {
  return detail::selectPoints(cloud, nullptr, cloud.size(), 0).points;
}

/// All signs of the axes that make a rotation: planes have none.
void addSigns(FoundFrame& found) {
  for (int k = -1; k < 3; ++k) {
    Eigen::Vector3d signs = Eigen::Vector3d::Constant(k < 0 ? 1.0 : -1.0);
    if (k >= 0) signs[k] = 1.0;
    found.equivalent.emplace_back(found.axes * signs.asDiagonal());
  }
}

FoundFrame bySymmetry(AlignmentMethod method, const Cloud::ConstPtr& cloud, std::uint64_t seed, int num_threads) {
  FrameOptions options;
  options.as_published = method == AlignmentMethod::FirstMaximum;
  options.turns = false;
  SymmetryAlignment<pcl::PointXYZ> alignment;
  alignment.setOptions(options);
  alignment.setRandomSeed(seed);
  alignment.setNumberOfThreads(num_threads);
  if (method != AlignmentMethod::Symmetry) alignment.setViewpointMode(Viewpoint::Mode::None);
  alignment.setInputCloud(cloud);
  const SymmetryFrame frame = alignment.compute();
  if (!alignment.getReason().empty()) detail::throwBadArgument(alignment.getReason());
  FoundFrame found{frame.center, frame.axes, {}, frame.revolution_axis};
  for (const Eigen::Isometry3d& T_canonical_input : frame.equivalent)
    found.equivalent.emplace_back(T_canonical_input.linear().transpose());
  return found;
}

FoundFrame asPublished(bool refined, const Cloud& cloud, std::uint64_t seed, int num_threads) {
  PublishedFrameOptions options;
  options.refined = refined;
  options.seed = seed;
  options.num_threads = num_threads;
  const PublishedFrame frame = publishedFrame(pointsOf(cloud), options);
  FoundFrame found{frame.center, frame.axes, {}};
  addSigns(found);
  return found;
}

FoundFrame byMass(const Cloud& cloud, const std::optional<Eigen::Vector3d>& away_from) {
  const Points points = pointsOf(cloud);
  const PrincipalAxes principal = principalAxes(points);
  FoundFrame found{principal.center, principal.axes, {}};
  if (away_from) found.center += kPush * boundingBall(points).radius * (principal.center - *away_from).normalized();
  addSigns(found);
  return found;
}

FoundFrame frameBy(AlignmentMethod method, const Cloud::ConstPtr& cloud,
                   const std::optional<Eigen::Vector3d>& viewpoint, std::uint64_t seed, int num_threads) {
  switch (method) {
    case AlignmentMethod::ExactMap:
    case AlignmentMethod::ExactMapRefined:
      return asPublished(method == AlignmentMethod::ExactMapRefined, *cloud, seed, num_threads);
    case AlignmentMethod::CenterOfMass:
      return byMass(*cloud, std::nullopt);
    case AlignmentMethod::PushedMass:
      return byMass(*cloud, viewpoint);
    default:
      return bySymmetry(method, cloud, seed, num_threads);
  }
}

}  // namespace

std::string toString(AlignmentMethod method) {
  switch (method) {
    case AlignmentMethod::Symmetry:
      return "symmetry";
    case AlignmentMethod::NoFreeSpace:
      return "no free space";
    case AlignmentMethod::FirstMaximum:
      return "first maximum";
    case AlignmentMethod::ExactMap:
      return "exact map";
    case AlignmentMethod::ExactMapRefined:
      return "exact map ISP";
    case AlignmentMethod::CenterOfMass:
      return "mass and PCA";
    default:
      return "mass + 0.15 R";
  }
}

std::vector<AlignmentMethod> alignmentMethods(const std::vector<std::string>& names) {
  std::vector<AlignmentMethod> chosen;
  std::set<std::string> unknown(names.begin(), names.end());
  std::string list;
  for (const AlignmentMethod method : kAlignmentMethods) {
    const std::string name = toString(method);
    list += (list.empty() ? "" : ", ") + name;
    const bool named = unknown.erase(name) > 0;
    if (names.empty() || named || method == AlignmentMethod::Symmetry || method == AlignmentMethod::CenterOfMass)
      chosen.push_back(method);
  }
  if (!unknown.empty()) throw UsageError("method '" + *unknown.begin() + "': unknown, must be one of " + list);
  return chosen;
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
  FoundFrame found = frameBy(method, cloud, viewpoint, seed, num_threads);
  found.milliseconds = watch.lap();
  return found;
}

}  // namespace pcl_symmetry::apps
