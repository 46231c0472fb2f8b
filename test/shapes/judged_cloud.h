/// A cloud with what fits, measures and judges its planes.
#pragma once

#include "core/detection/judged_cloud.h"

namespace pcl_symmetry::test {

/// Owns what a judged cloud refers to.
struct CloudToJudge {
  CloudToJudge(const Points& points, const DetectionOptions& given, const Visibility* seen)
      : own_options(given), edt(points), own_cloud(points, edt, nullptr, seen, 1) {}

  const DetectionOptions own_options;
  const GaussianEdt edt;
  const NormalizedCloud own_cloud;
};

struct JudgedShape : CloudToJudge, pcl_symmetry::JudgedCloud {
  explicit JudgedShape(const Points& points, const DetectionOptions& given = {}, const Visibility* seen = nullptr)
      : CloudToJudge(points, given, seen), pcl_symmetry::JudgedCloud(own_cloud, own_cloud.points, own_options) {}

  ReflectionPlane normalized(const Eigen::Vector3d& normal, double offset) const {
    return cloud.toNormalized(ReflectionPlane(normal, offset));
  }
};

}  // namespace pcl_symmetry::test
