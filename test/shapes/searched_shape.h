/// A cloud with what fits, measures and judges its planes.
#pragma once

#include "core/detection/plane_search.h"

namespace pcl_symmetry::test {

/// Owns what a search refers to.
struct CloudToSearch {
  CloudToSearch(const Points& points, const DetectionOptions& given, const Visibility* seen)
      : own_options(given), edt(points), own_cloud(points, edt, nullptr, seen, 1) {}

  const DetectionOptions own_options;
  const GaussianEdt edt;
  const NormalizedCloud own_cloud;
};

struct SearchedShape : CloudToSearch, pcl_symmetry::PlaneSearch {
  explicit SearchedShape(const Points& points, const DetectionOptions& given = {}, const Visibility* seen = nullptr)
      : CloudToSearch(points, given, seen), pcl_symmetry::PlaneSearch(own_cloud, own_cloud.points, own_options) {}

  ReflectionPlane normalized(const Eigen::Vector3d& normal, double offset) const {
    return cloud.toNormalized(ReflectionPlane(normal, offset));
  }
};

}  // namespace pcl_symmetry::test
