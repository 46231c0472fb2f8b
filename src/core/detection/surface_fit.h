#pragma once

#include "core/detection/plane_fit.h"

namespace pcl_symmetry {

/// What matchSymmetricPoints() finds, without weights: closest points and their distances only.
/// \param guesses IspStep::closest of a plane nearby; null = not known.
IspStep matchReflectionsOnly(const IspSurface& surface, const std::vector<int>& samples, const ReflectionPlane& plane,
                             double sigma, const std::vector<int>* guesses);

/// Planes of points that resolve a surface: Iterative Symmetric Points, and the share of points whose reflection lies
/// on the surface.
class SurfaceFit : public PlaneFit {
public:
  /// \param cloud must outlive this object.
  SurfaceFit(const NormalizedCloud& cloud, const PlaneFitOptions& options) : PlaneFit(cloud), options_(options) {}

  void refine(std::vector<Candidate>& candidates, const RefinementStage& stage) const override;
  void climb(std::vector<Candidate>& candidates, const RefinementStage& stage) const override;
  ReflectionPlane refined(const ReflectionPlane& plane, const std::vector<int>& samples,
                          int max_iterations) const override;
  using PlaneFit::shares;
  PlaneShares shares(const ReflectionPlane& plane, const std::vector<int>& samples, const IspStep& step) const override;
  double relativeSupport(const PlaneShares& shares) const override;
  double merit(const PlaneShares& shares) const override;
  double familyAllowance() const override;
  PlaneEvidence evidence(double support, double conflict, double score) const override;

private:
  /// \param samples that the final merit is taken of.
  /// \param fewer samples by which the plane climbs.
  void climbOne(Candidate& candidate, const std::vector<int>& samples, const std::vector<int>& fewer) const;
  void undoSlide(Candidate& candidate, const ReflectionPlane& start, const std::vector<int>& samples,
                 double sigma) const;

  PlaneFitOptions options_;
};

}  // namespace pcl_symmetry
