/// A cloud with what fits, measures and judges its planes.
#pragma once

#include <memory>

#include "core/detection/plane_decision.h"

namespace pcl_symmetry::test {

struct JudgedCloud {
  explicit JudgedCloud(const Points& points, const DetectionOptions& given = {}, const Visibility* seen = nullptr)
      : options(given), edt(points), cloud(points, edt, nullptr, seen, 1) {}

  ReflectionPlane normalized(const Eigen::Vector3d& normal, double offset) const {
    return cloud.toNormalized(ReflectionPlane(normal, offset));
  }

  const DetectionOptions options;
  const GaussianEdt edt;
  const NormalizedCloud cloud;
  const std::unique_ptr<PlaneFit> fit = makePlaneFit(cloud, options);
  const PlaneMeasure measure{cloud, *fit, options};
  const PlaneDecision decision{cloud, measure, options};
};

}  // namespace pcl_symmetry::test
