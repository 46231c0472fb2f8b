#include "core/matching/depth_picture.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/matching/matching_rules.h"

namespace pcl_symmetry {

namespace {

template <typename Visit>
void forEachSeenCell(const DepthPicture& picture, const Visit& visit) {
  for (int v = 0; v < picture.side(); ++v) {
    for (int u = 0; u < picture.side(); ++u) {
      const float depth = picture.depth(u, v);
      if (depth != DepthPicture::kNothing) visit(picture.center(u, v).cast<double>().matrix(), depth);
    }
  }
}

}  // namespace

void DepthPicture::add(const PointColumns& points) {
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const float u = (points(i, 0) - corner_.x()) / cell_, v = (points(i, 1) - corner_.y()) / cell_;
    const auto side = static_cast<float>(side_);
    if (!(u >= 0.0f && v >= 0.0f && u < side && v < side)) continue;
    float& depth = depths_[static_cast<std::size_t>(static_cast<int>(v) * side_ + static_cast<int>(u))];
    depth = std::min(depth, points(i, 2));
  }
}

ViewOutline outlineOf(const PointColumns& in_view) {
  const Eigen::Array2f low = in_view.leftCols<2>().colwise().minCoeff().transpose();
  const Eigen::Array2f high = in_view.leftCols<2>().colwise().maxCoeff().transpose();
  const float extent = (high - low).maxCoeff();
  check(extent > 0.0f, "extent of the points across the view", extent, "> 0");
  const int cells = kMatching.outline_cells;
  DepthPicture picture(cells + 1, low, extent / cells);
  picture.add(in_view);

  ViewOutline outline;
  double count = 0.0, sq_radius = 0.0;
  forEachSeenCell(picture, [&](const Eigen::Vector2d& at, float depth) {
    outline.middle += Eigen::Vector3d(at.x(), at.y(), depth);
    count += 1.0;
  });
  outline.middle /= count;
  forEachSeenCell(
      picture, [&](const Eigen::Vector2d& at, float) { sq_radius += (at - outline.middle.head<2>()).squaredNorm(); });
  // The mean square distance from the center of a square cell is 1/6 of its squared side.
  outline.radius = std::sqrt(sq_radius / count + extent * extent / (6.0 * cells * cells));
  return outline;
}

SmoothPicture::SmoothPicture(const DepthPicture& picture, float middle, float unit) : side_(picture.side()) {
  const float weights[3] = {0.25f, 0.5f, 0.25f};
  const float deepest = kMatching.deepest;
  values_.resize(static_cast<std::size_t>(side_) * side_);
  for (int v = 0; v < side_; ++v) {
    for (int u = 0; u < side_; ++u) {
      Eigen::Array2f& value = values_[static_cast<std::size_t>(v * side_ + u)];
      value.setZero();
      for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
          const float depth = picture.depth(u + i, v + j);
          if (depth == DepthPicture::kNothing) continue;
          value += weights[i + 1] * weights[j + 1] *
                   Eigen::Array2f(1.0f, std::clamp((depth - middle) / unit, -deepest, deepest));
        }
      }
    }
  }
}

}  // namespace pcl_symmetry
