/// Planes of scans: what was seen from one side supports the true planes and rules out others.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "pcl_symmetry/core/detect_planes.h"
#include "shapes/scans.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

/// The plane of the answers nearest to a true one: within 2 degrees and 2 % of the diagonal, or none.
const SymmetryPlane* find(const Detection& detection, const ReflectionPlane& plane, const Points& cloud) {
  for (const SymmetryPlane& found : detection.planes) {
    const PlaneError error = planeError(found, plane, centerOfMass(cloud));
    if (error.angle < 2.0 * kDegree && error.offset < 0.02 * diagonal(cloud)) return &found;
  }
  return nullptr;
}

struct NamedScan {
  std::string name;
  Scan scan;
};

/// Views that show two or three sides of everything.
std::vector<NamedScan> scans() {
  std::vector<NamedScan> result;
  const std::vector<std::pair<std::string, BlockObject>> objects = {
      {"box", blockBox()}, {"L", blockL()}, {"chair", blockChair()}};
  for (const auto& [name, object] : objects)
    for (const Eigen::Vector3d& from :
         {Eigen::Vector3d(2.5, -3.0, 2.0), Eigen::Vector3d(1.5, 3.0, 2.5), Eigen::Vector3d(-2.0, 3.2, -1.8)})
      result.push_back({name, scan(object, from)});
  return result;
}

TEST(Scans, TruePlanesAreAmongTheAnswers) {
  int num_planes = 0, num_found = 0, num_wrong = 0;
  for (const auto& [name, scan] : scans()) {
    const Points cloud = scan.cloud();
    const Visibility visibility = scan.visibility();
    const Detection detection = detectPlanes({cloud, &visibility});
    int found_here = 0;
    for (const ReflectionPlane& plane : scan.planes) found_here += find(detection, plane, cloud) ? 1 : 0;
    double best_wrong = 0.0, best_true = 0.0;
    for (const SymmetryPlane& plane : detection.planes) {
      EXPECT_TRUE(plane.kind == PlaneKind::Symmetry || plane.kind == PlaneKind::Possible) << name;
      EXPECT_GT(plane.seen, 0.0) << name;
      EXPECT_LE(plane.seen, 1.0) << name;
      bool is_true = false;
      for (const ReflectionPlane& truth : scan.planes) {
        const PlaneError error = planeError(plane, truth, centerOfMass(cloud));
        is_true |= error.angle < 2.0 * kDegree && error.offset < 0.02 * diagonal(cloud);
      }
      num_wrong += plane.kind == PlaneKind::Symmetry && !is_true ? 1 : 0;
      double& best = is_true ? best_true : best_wrong;
      best = std::max(best, plane.confidence);
    }
    EXPECT_GE(found_here, 1) << name << " from " << scan.viewpoint.transpose();
    EXPECT_GT(best_true, best_wrong) << name << " from " << scan.viewpoint.transpose();
    num_planes += static_cast<int>(scan.planes.size());
    num_found += found_here;
  }
  EXPECT_EQ(num_found, num_planes);
  // The README's rate of scans of asymmetric objects that are called symmetric is 21 %: 1.9 of nine scans.
  EXPECT_LE(num_wrong, static_cast<int>(0.21 * static_cast<double>(scans().size())));
}

TEST(Scans, SameBytesForAnyNumberOfThreads) {
  const Scan view = scan(blockL(), {2.5, -3.0, 2.0});
  const Points cloud = view.cloud();
  const Visibility visibility = view.visibility();
  std::optional<Detection> one;
  for (const int num_threads : {1, 2, 8}) {
    DetectionOptions options;
    options.num_threads = num_threads;
    const Detection detection = detectPlanes({cloud, &visibility}, options);
    if (!one) one = detection;
    EXPECT_EQ(detection.map.values, one->map.values);
    ASSERT_EQ(detection.planes.size(), one->planes.size());
    for (std::size_t i = 0; i < one->planes.size(); ++i) {
      EXPECT_EQ(detection.planes[i].coefficients(), one->planes[i].coefficients());
      EXPECT_EQ(detection.planes[i].confidence, one->planes[i].confidence);
      EXPECT_EQ(detection.planes[i].seen, one->planes[i].seen);
    }
  }
}

}  // namespace
