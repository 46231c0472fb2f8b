#pragma once

#include "core/detection/surface_fit.h"
#include "core/evidence/point_density.h"

namespace pcl_symmetry {

/// Planes of points that resolve no surface: the overlap of the points' density with its reflection.
class VolumeFit : public PlaneFit {
public:
  /// \param cloud must outlive this object.
  VolumeFit(const NormalizedCloud& cloud, const PlaneFitOptions& options);

  void refine(std::vector<Candidate>& candidates, const RefinementStage& stage) const override;
  void climb(std::vector<Candidate>&, const RefinementStage&) const override {}  ///< the density pulls at no plane
  ReflectionPlane refined(const ReflectionPlane& plane, const std::vector<int>& samples,
                          int max_iterations) const override;
  using PlaneFit::shares;
  PlaneShares shares(const ReflectionPlane& plane, const std::vector<int>& samples, const IspStep& step) const override;
  double relativeSupport(const PlaneShares& shares) const override;
  double merit(const PlaneShares& shares) const override;
  double familyAllowance() const override;
  PlaneEvidence evidence(double support, double conflict, double score) const override;

private:
  PlaneFitOptions options_;
  SurfaceFit surface_;  ///< support of single points
  PointDensity density_;
};

}  // namespace pcl_symmetry
