/// What must not change a plane: motions, scales, the order of the points, copies of points, and which points there
/// are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pcl_symmetry/core/detect_planes.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

/// Fewer candidates and samples than by default: the same steps in a third of the time.
DetectionOptions sweepOptions() {
  DetectionOptions options;
  options.expert.num_phi = 64;
  options.expert.max_candidates = 16;
  options.expert.num_refine_samples = 3000;
  return options;
}

/// Everything at once, drawn from a seed.
struct Change {
  Eigen::Isometry3d pose;
  double scale;
  std::vector<Eigen::Index> order;  ///< of the points that are left, some of them several times

  Change(std::uint64_t seed, Eigen::Index num_points) : pose(randomPose(seed)) {
    RandomStream random(seed, 5);
    scale = std::pow(10.0, 12.0 * random.uniform() - 6.0);
    const double share = 0.6 + 0.4 * random.uniform(), copies = 0.3 * random.uniform();
    for (Eigen::Index i = 0; i < num_points; ++i) {
      if (random.uniform() > share) continue;
      order.push_back(i);
      if (random.uniform() < copies) order.push_back(i);
    }
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  }

  Shape of(const Shape& shape) const {
    Shape result = scaled(moved(shape, pose), scale);
    Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(order.size()));
    for (std::size_t i = 0; i < order.size(); ++i)
      points.col(static_cast<Eigen::Index>(i)) = result.points.col(order[i]);
    result.points = points;
    return result;
  }
};

TEST(Invariance, PlanesStayWhateverIsDoneToThePoints) {
  const std::vector<std::pair<std::string, Shape>> shapes = {{"box", box(5000, Sampling::Random, 1)},
                                                             {"prism of 5", prism(5, 5000, Sampling::Random, 2)},
                                                             {"prism of 3", prism(3, 5000, Sampling::Random, 3)}};
  for (const auto& [name, shape] : shapes) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const Change change(seed, shape.points.cols());
      const Shape changed = change.of(shape);
      const Points cloud = changed.cloud();
      const Detection detection = detectPlanes(cloud, sweepOptions());
      SCOPED_TRACE(name + ", seed " + std::to_string(seed) + ", scale " + std::to_string(change.scale));
      EXPECT_EQ(std::count_if(detection.planes.begin(), detection.planes.end(),
                              [](const SymmetryPlane& plane) { return plane.kind == PlaneKind::Symmetry; }),
                static_cast<std::ptrdiff_t>(shape.planes.size()));
      const Eigen::Vector3d center = centerOfMass(cloud);
      for (const ReflectionPlane& expected : changed.planes) {
        const bool is_found =
            std::any_of(detection.planes.begin(), detection.planes.end(), [&](const SymmetryPlane& found) {
              const PlaneError error = planeError(found, expected, center);
              return error.angle < kDegree && error.offset < 0.01 * diagonal(cloud);
            });
        EXPECT_TRUE(is_found) << expected.normal().transpose();
      }
    }
  }
}

TEST(Invariance, NothingMakesAnAsymmetricShapeSymmetric) {
  const Shape shapes[] = {scaleneTetrahedron(5000, 4), asymmetricBlob(5000, 5)};
  for (const Shape& shape : shapes)
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const Detection detection = detectPlanes(Change(seed, shape.points.cols()).of(shape).cloud(), sweepOptions());
      for (const SymmetryPlane& plane : detection.planes)
        EXPECT_NE(plane.kind, PlaneKind::Symmetry) << "seed " << seed << ": " << plane.normal().transpose();
    }
}

}  // namespace
