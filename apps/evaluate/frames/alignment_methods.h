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
  Symmetry,         ///< SymmetryAlignment
  NoFreeSpace,      ///< the same without a viewpoint: scans count as whole clouds, and nothing is known to be free
  FirstMaximum,     ///< the paper's, at bin centers of a map of 64 samples
  ExactMap,         ///< the paper's, at bin centers of the exact map
  ExactMapRefined,  ///< the paper's, with maxima of the exact map refined by Iterative Symmetric Points
  CenterOfMass,     ///< and principal axes of the points
  PushedMass        ///< the center of mass of a scan moved away from the scanner by 0.15 radii, and principal axes
};

/// In the order of the table. derived: all of the enumeration.
constexpr AlignmentMethod kAlignmentMethods[] = {AlignmentMethod::Symmetry,        AlignmentMethod::NoFreeSpace,
                                                 AlignmentMethod::FirstMaximum,    AlignmentMethod::ExactMap,
                                                 AlignmentMethod::ExactMapRefined, AlignmentMethod::CenterOfMass,
                                                 AlignmentMethod::PushedMass};

std::string toString(AlignmentMethod method);

/// \return the named methods in the order of the table, or all where none is named; symmetry and the center of mass, which
/// others are compared with, are always among them.
/// \throws UsageError for a name that is none.
std::vector<AlignmentMethod> alignmentMethods(const std::vector<std::string>& names);

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
