/// The ways to find a canonical frame that `pcl_symmetry_evaluate alignment` compares.
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pcl_symmetry::apps {

enum class AlignmentMethod {
  Symmetry,      ///< SymmetryAlignment
  AsPublished,   ///< the paper's own method: greedily by D alone, blind to what was seen
  CenterOfMass,  ///< and principal axes of the points
  PushedMass     ///< the center of mass of a scan moved away from the scanner by 0.15 radii, and principal axes
};

/// In the order of the table. derived: all of the enumeration.
constexpr AlignmentMethod kAlignmentMethods[] = {AlignmentMethod::Symmetry, AlignmentMethod::AsPublished,
                                                 AlignmentMethod::CenterOfMass, AlignmentMethod::PushedMass};

std::string toString(AlignmentMethod method);

struct FoundFrame {
  Eigen::Vector3d center;
  Eigen::Matrix3d axes;                     ///< columns
  std::vector<Eigen::Matrix3d> equivalent;  ///< axes of the frames that are equally good, these among them
  int revolution_axis = -1;                 ///< as of SymmetryFrame
  double milliseconds = 0.0;

  FoundFrame transformed(const Eigen::Isometry3d& motion) const;
};

/// \param viewpoint of a scan, in its frame.
/// \throws pcl::BadArgumentException where the points have no extent.
FoundFrame findFrame(AlignmentMethod method, const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud,
                     const std::optional<Eigen::Vector3d>& viewpoint, std::uint64_t seed, int num_threads);

}  // namespace pcl_symmetry::apps
