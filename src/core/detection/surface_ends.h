#pragma once

#include <vector>

#include "core/detection/normalized_cloud.h"
#include "core/evidence/cut_planes.h"
#include "core/evidence/outermost_points.h"

namespace pcl_symmetry {

/// Where a cloud ends although the object may go on: its open borders and the planes that it was cut by.
class SurfaceEnds {
public:
  /// \param cloud of CloudKind::Surface; must outlive this object.
  /// \param num_threads 0 = one per core.
  SurfaceEnds(const NormalizedCloud& cloud, std::uint64_t seed, int num_threads);

  /// Whether the counterparts of samples are missing from the cloud, in [0, 1], by which ends of the cloud say so: all
  /// of them, or none where the cloud is all borders, as a wire is.
  /// \param matched,closest,reflected as of missingCounterparts(), for all points.
  std::vector<float> missing(const std::vector<char>& matched, const std::vector<int>& closest,
                             const Points& reflected) const;

  /// How far ends say what is missing, in [0, 1].
  double trust() const { return trust_; }

private:
  bool isCutOff(const Eigen::Vector3f& x) const;

  const NormalizedCloud& cloud_;
  std::vector<char> borders_;
  OutermostPoints outermost_;
  std::vector<CutPlane> cuts_;
  double trust_;
};

}  // namespace pcl_symmetry
