/// Ways to bring a scan to a model from any pose: ours, and what PCL's users have without it.
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <ctime>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/command_line/console.h"

namespace pcl_symmetry::apps {

struct RegistrationAnswer {
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  bool converged = false;
  double support = 0.0, conflict = 0.0;  ///< of SymmetryRegistration
  double milliseconds = 0.0;
  double processor_ms = 0.0;  ///< of all threads
};

/// Wall time and processor time of a registration, from its construction on.
class RegistrationTimer {
public:
  void stop(RegistrationAnswer& answer) {
    answer.milliseconds = watch_.lap();
    answer.processor_ms = 1000.0 * static_cast<double>(std::clock() - start_) / CLOCKS_PER_SEC;
  }

private:
  Stopwatch watch_;
  const std::clock_t start_ = std::clock();
};

/// What a method may know: the pose of the last frame of a track.
struct PoseGuess {
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  double angle, distance;  ///< radians and input units that it is off by, at most
};

/// Brings scans to one target.
/// \param source may hold points that are not finite.
/// \param guess used by SymmetryRegistration alone, which then searches around it, and prepares the target before the
/// first scan, out of the time.
using RegisterToTarget = std::function<RegistrationAnswer(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& source,
                                                          const std::optional<PoseGuess>& guess)>;

struct RegistrationMethod {
  const char* name;
  const char* summary;
  /// \param num_threads 0 = all.
  RegisterToTarget (*toTarget)(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& target, std::uint64_t seed,
                               int num_threads);
};

/// symmetry: SymmetryRegistration with its defaults; frames and rotations: with one of its two kinds of hypotheses;
/// anew: the target is prepared for each scan also where there is a guess.
/// pca: principal axes in the four proper orders of signs, ICP from each on voxels, ICP of the best with all points.
/// features: FPFH and SampleConsensusPrerejective on voxels, ICP with all points.
const std::vector<RegistrationMethod>& registrationMethods();

}  // namespace pcl_symmetry::apps
