#include "core/matching/depth_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/check.h"
#include "core/base/simd.h"

namespace pcl_symmetry {

namespace {

// Cells across the larger side of the outline. chosen: half gives a coarser middle and radius, twice leaves cells
// without points inside the outline of sparse clouds.
constexpr int kOutlineCells = 48;
// Radii of the outline. A depth farther from the mean counts as this. chosen: half flattens deep shapes, twice lets one
// far point weigh as much as the outline.
constexpr float kDeepest = 2.0f;
// derived: binomial weights of a cell and its two neighbours.
constexpr float kSmoothing[3] = {0.25f, 0.5f, 0.25f};
// Points whose cells are found at a time. chosen: they stay in the first cache; half and twice are as fast.
constexpr std::size_t kPointsAtATime = 1024;

/// Index of the cell of each point; side * side beyond the picture.
PCL_SYMMETRY_MULTIVERSION
void findCells(const float* x, const float* y, std::size_t count, float left, float top, float cell, int side,
               int* cells) {
  const auto end = static_cast<float>(side);
  for (std::size_t i = 0; i < count; ++i) {
    const float u = (x[i] - left) / cell, v = (y[i] - top) / cell;
    const bool inside = (u >= 0.0f) & (v >= 0.0f) & (u < end) & (v < end);
    const int at = static_cast<int>(inside ? v : 0.0f) * side + static_cast<int>(inside ? u : 0.0f);
    cells[i] = inside ? at : side * side;
  }
}

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
  std::array<int, kPointsAtATime> cells;
  const auto size = static_cast<std::size_t>(points.rows());
  const float* depths = points.col(2).data();
  for (std::size_t first = 0; first < size; first += kPointsAtATime) {
    const std::size_t count = std::min(kPointsAtATime, size - first);
    findCells(points.col(0).data() + first, points.col(1).data() + first, count, corner_.x(), corner_.y(), cell_, side_,
              cells.data());
    for (std::size_t i = 0; i < count; ++i) {
      float& depth = depths_[static_cast<std::size_t>(cells[i])];
      depth = std::min(depth, depths[first + i]);
    }
  }
}

Outline outlineOf(const PointColumns& in_view) {
  const Eigen::Array2f low = in_view.leftCols<2>().colwise().minCoeff().transpose();
  const Eigen::Array2f high = in_view.leftCols<2>().colwise().maxCoeff().transpose();
  const float extent = (high - low).maxCoeff();
  check(extent > 0.0f, "extent of the points across the view", extent, "> 0");
  DepthPicture picture(kOutlineCells + 1, low, extent / kOutlineCells);
  picture.add(in_view);

  Outline outline;
  double count = 0.0, sq_radius = 0.0;
  forEachSeenCell(picture, [&](const Eigen::Vector2d& at, float depth) {
    outline.middle += Eigen::Vector3d(at.x(), at.y(), depth);
    count += 1.0;
  });
  outline.middle /= count;
  forEachSeenCell(
      picture, [&](const Eigen::Vector2d& at, float) { sq_radius += (at - outline.middle.head<2>()).squaredNorm(); });
  // The mean square distance from the center of a square cell is 1/6 of its squared side.
  outline.radius = std::sqrt(sq_radius / count + extent * extent / (6.0 * kOutlineCells * kOutlineCells));
  return outline;
}

SmoothPicture::SmoothPicture(const DepthPicture& picture, float middle, float unit) : side_(picture.side()) {
  values_.resize(static_cast<std::size_t>(side_) * side_);
  for (int v = 0; v < side_; ++v) {
    for (int u = 0; u < side_; ++u) {
      Eigen::Array2f& value = values_[static_cast<std::size_t>(v * side_ + u)];
      value.setZero();
      for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
          const float depth = picture.depth(u + i, v + j);
          if (depth == DepthPicture::kNothing) continue;
          value += kSmoothing[i + 1] * kSmoothing[j + 1] *
                   Eigen::Array2f(1.0f, std::clamp((depth - middle) / unit, -kDeepest, kDeepest));
        }
      }
    }
  }
}

}  // namespace pcl_symmetry
