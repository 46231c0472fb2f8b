/// Scans with known planes of symmetry: pictures of boxes by a pinhole camera.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <vector>

#include "core/geometry/directions.h"
#include "pcl_symmetry/core/visibility.h"
#include "shapes/shapes.h"

namespace pcl_symmetry::test {

/// A box with faces across the axes.
struct Block {
  Eigen::Vector3d center, half;

  /// Distance along a ray to where it enters the box, in lengths of \p direction; infinite where it does not.
  double hit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
    const Eigen::Array3d a = (center - half - origin).array() / direction.array();
    const Eigen::Array3d b = (center + half - origin).array() / direction.array();
    const double enters = a.min(b).maxCoeff(), leaves = a.max(b).minCoeff();
    return enters <= leaves && enters > 0.0 ? enters : std::numeric_limits<double>::infinity();
  }
};

/// A body of blocks and its planes of symmetry.
struct BlockObject {
  std::vector<Block> blocks;
  std::vector<ReflectionPlane> planes;
};

inline BlockObject blockBox(const Eigen::Vector3d& half = {1.0, 0.7, 0.45}) {
  return {{{Eigen::Vector3d::Zero(), half}},
          {{Eigen::Vector3d::UnitX(), 0.0}, {Eigen::Vector3d::UnitY(), 0.0}, {Eigen::Vector3d::UnitZ(), 0.0}}};
}

/// An L with arms of two lengths: only the plane between its two faces.
inline BlockObject blockL() {
  return {{{{0.0, 0.0, 0.0}, {1.0, 0.25, 0.45}}, {{-0.7, 0.85, 0.0}, {0.3, 0.6, 0.45}}},
          {{Eigen::Vector3d::UnitZ(), 0.0}}};
}

/// Seat, back and four legs: left and right are alike.
inline BlockObject blockChair() {
  BlockObject chair{{{{0.0, 0.0, 0.0}, {0.5, 0.5, 0.06}}, {{0.0, 0.44, 0.55}, {0.5, 0.06, 0.5}}},
                    {{Eigen::Vector3d::UnitX(), 0.0}}};
  for (int leg = 0; leg < 4; ++leg)
    chair.blocks.push_back({{leg & 1 ? 0.43 : -0.43, leg & 2 ? 0.43 : -0.43, -0.45}, {0.07, 0.07, 0.4}});
  return chair;
}

/// Points spread evenly over the outer surface of an object.
inline Points surfaceOf(const BlockObject& object, int num_points, std::uint64_t seed = 1) {
  RandomStream random(seed);
  double total = 0.0;
  std::vector<double> ends;  // of the areas of the faces across x, y, z of all blocks, added up
  for (const Block& block : object.blocks)
    for (int axis = 0; axis < 3; ++axis) ends.push_back(total += block.half.prod() / block.half[axis]);
  Points points(3, num_points);
  for (int i = 0; i < num_points;) {
    const auto face = std::upper_bound(ends.begin(), ends.end(), random.uniform() * total) - ends.begin();
    const Block& on = object.blocks[static_cast<std::size_t>(face / 3)];
    Eigen::Vector3d unit = randomPoint(random);
    unit[face % 3] = random.below(2) ? 1.0 : -1.0;
    const Eigen::Vector3d point = on.center + on.half.cwiseProduct(unit);
    const bool inside = std::any_of(object.blocks.begin(), object.blocks.end(), [&](const Block& block) {
      return ((point - block.center).cwiseAbs().array() < block.half.array()).all();
    });
    if (!inside) points.col(i++) = point.cast<float>();
  }
  return points;
}

/// A picture of points, row by row, NaN where the ray met nothing; the camera stands at the viewpoint.
struct Scan {
  int width, height;
  Points pixels;  ///< 3 x (width * height), object frame
  Eigen::Vector3d viewpoint;
  Eigen::Isometry3d T_camera_object;  ///< x to the right, y down, z forward
  double focal;                       ///< pixels
  std::vector<ReflectionPlane> planes;

  /// The points that were measured.
  Points cloud() const {
    return pointsWhere(pixels, [](const Eigen::Vector3f& x) { return x.allFinite(); });
  }

  /// What the camera saw, from its own projection.
  Visibility visibility() const {
    Eigen::Matrix3d camera;
    camera << focal, 0.0, 0.5 * (width - 1), 0.0, focal, 0.5 * (height - 1), 0.0, 0.0, 1.0;
    const Visibility::Projection projection = camera * T_camera_object.matrix().topRows<3>();
    std::vector<float> depths(static_cast<std::size_t>(width) * height, Visibility::kBackground);
    for (Eigen::Index i = 0; i < pixels.cols(); ++i)
      if (pixels.col(i).allFinite())
        depths[i] = static_cast<float>((T_camera_object * pixels.col(i).cast<double>()).z());
    return Visibility(projection, width, height, std::move(depths));
  }
};

/// \param viewpoint outside of every block; the camera looks at the origin with a random roll.
inline Scan scan(const BlockObject& object, const Eigen::Vector3d& viewpoint, double roll = 0.3, int width = 160,
                 int height = 120) {
  Scan result{width, height, Points(3, width * height), viewpoint, Eigen::Isometry3d::Identity(), 0.0, object.planes};
  Eigen::Matrix3d R_object_camera = viewingFrame(-viewpoint.normalized()).transpose();
  R_object_camera = R_object_camera * Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  double reach = 0.0;  // of the object as seen from the origin
  for (const Block& block : object.blocks) reach = std::max(reach, (block.center.cwiseAbs() + block.half).norm());
  const double distance = viewpoint.norm();
  result.focal = 0.48 * height * std::sqrt(distance * distance - reach * reach) / reach;
  result.T_camera_object.linear() = R_object_camera.transpose();
  result.T_camera_object.translation() = -R_object_camera.transpose() * viewpoint;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const Eigen::Vector3d ray((u - 0.5 * (width - 1)) / result.focal, (v - 0.5 * (height - 1)) / result.focal, 1.0);
      const Eigen::Vector3d direction = R_object_camera * ray;
      double nearest = std::numeric_limits<double>::infinity();
      for (const Block& block : object.blocks) nearest = std::min(nearest, block.hit(viewpoint, direction));
      const Eigen::Vector3d point = viewpoint + nearest * direction;
      result.pixels.col(v * width + u) =
          std::isfinite(nearest) ? Eigen::Vector3f(point.cast<float>())
                                 : Eigen::Vector3f(Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
    }
  }
  return result;
}

/// The part of the unit sphere that faces a viewpoint.
inline Points facing(const Points& sphere, const Eigen::Vector3d& viewpoint) {
  return pointsWhere(sphere, [&](const Eigen::Vector3f& x) { return x.dot(viewpoint.cast<float>() - x) > 0.0f; });
}

/// The points that no others hide from a viewpoint by more than a distance.
inline Points visiblePoints(const Points& all, const Eigen::Vector3d& viewpoint, double distance) {
  const auto seen = Visibility::fromPoints(all, viewpoint);
  return pointsWhere(all, [&](const Eigen::Vector3f& x) { return seen->depthBehind(x.cast<double>()) < distance; });
}

/// The table is the first block; its top is z = 0. The second box hides half of the first from the viewpoint.
struct Table {
  BlockObject blocks;
  Scan scan;
  std::vector<int> ids;  ///< of each pixel, the block; -1 where the ray met none

  Table() : Table({{0.0, 0.1, 0.0}, {0.0, 0.0, 0.0}}) {}

  /// \param shifts of the two boxes.
  explicit Table(const std::vector<Eigen::Vector3d>& shifts)
      : blocks{{{{0.0, 0.0, -0.02}, {0.7, 0.7, 0.02}},
                {shifts[0] + Eigen::Vector3d(0.0, 0.1, 0.12), {0.2, 0.1, 0.12}},
                {shifts[1] + Eigen::Vector3d(0.15, -0.25, 0.1), {0.12, 0.08, 0.1}}},
               {}},
        scan(test::scan(blocks, {0.1, -1.6, 1.0}, 0.0, 320, 240)) {
    for (Eigen::Index i = 0; i < scan.pixels.cols(); ++i) ids.push_back(blockAt(scan.pixels.col(i).cast<double>()));
  }

  /// Indices of the pixels that show a block.
  std::vector<int> pixelsOf(int block) const {
    std::vector<int> found;
    for (std::size_t i = 0; i < ids.size(); ++i)
      if (ids[i] == block) found.push_back(static_cast<int>(i));
    return found;
  }

private:
  int blockAt(const Eigen::Vector3d& x) const {
    constexpr double kRounding = 1e-5;
    for (int k = static_cast<int>(blocks.blocks.size()) - 1; k >= 0 && x.allFinite(); --k) {
      const Block& block = blocks.blocks[static_cast<std::size_t>(k)];
      if (((x - block.center).cwiseAbs() - block.half).maxCoeff() < kRounding) return k;
    }
    return -1;
  }
};

}  // namespace pcl_symmetry::test
