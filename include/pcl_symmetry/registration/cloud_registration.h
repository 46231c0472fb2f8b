#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/pose_search.h"

namespace pcl_symmetry {

/// Options of the refinement by pcl::IterativeClosestPointWithNormals.
struct RefinementOptions {
  int max_iterations = 30;                        ///< >= 1
  std::optional<double> max_correspondence = {};  ///< input units, > 0; chosen from the data if not set
  double transformation_epsilon = 0.0;            ///< as pcl::Registration has it, of coordinates in radii
  double rotation_epsilon = 0.0;                  ///< as pcl::Registration has it
};

struct CloudRegistration {
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  PoseScore score;
  std::vector<std::pair<std::string, double>> timing_ms;  ///< stages in order
};

/// The best pose of two clouds: frames by symmetry, search, refinement, and a last look with all points.
/// \param source,target 3 x N, finite, not all equal. \param source_seen,target_seen what scanners saw of them.
/// \param guess tried besides.
/// \throws std::invalid_argument for bad options or points without extent.
CloudRegistration registerClouds(const Points& source, std::optional<Visibility> source_seen, const Points& target,
                                 std::optional<Visibility> target_seen, const Eigen::Isometry3d& guess,
                                 const PoseSearchOptions& search, const RefinementOptions& refinement,
                                 std::uint64_t seed);

}  // namespace pcl_symmetry
