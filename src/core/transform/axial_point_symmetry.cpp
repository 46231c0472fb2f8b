#include <algorithm>

#include "core/base/parallel.h"
#include "pcl_symmetry/core/axial_transform.h"

namespace pcl_symmetry {

namespace {

constexpr std::size_t points_at_a_time = 1024;  // their values stay in the first cache

/// Values of one direction, bilinear between their bins and 0 beyond.
class DirectionValues {
public:
  DirectionValues(const AxisMap& map, std::size_t direction)
      : num_(map.grid.numOffset()),
        values_(map.greatest.data() + direction * num_ * num_),
        per_unit_(static_cast<float>(1.0 / map.grid.offsetStep())),
        // moves offset(0) to 0
        shift_(0.5f * static_cast<float>(num_) - 0.5f) {}

  float operator()(float u, float v) const {
    // A point in the outer half of a bin at the border has the value of that bin.
    const float most = static_cast<float>(num_) - 1.0f;
    const float x = u * per_unit_ + shift_, y = v * per_unit_ + shift_;
    if (!(x >= -0.5f && y >= -0.5f && x <= most + 0.5f && y <= most + 0.5f)) return 0.0f;
    const float in_x = std::clamp(x, 0.0f, most), in_y = std::clamp(y, 0.0f, most);
    const int i = std::min(static_cast<int>(in_x), std::max(0, num_ - 2));
    const int j = std::min(static_cast<int>(in_y), std::max(0, num_ - 2));
    const int right = num_ > 1, up = num_ > 1 ? num_ : 0;
    const float s = in_x - static_cast<float>(i), t = in_y - static_cast<float>(j);
    const float* at = values_ + static_cast<std::size_t>(j) * num_ + i;
    return (1.0f - t) * ((1.0f - s) * at[0] + s * at[right]) + t * ((1.0f - s) * at[up] + s * at[up + right]);
  }

private:
  int num_;
  const float* values_;
  float per_unit_, shift_;
};

}  // namespace

std::vector<float> axialPointSymmetry(const AxisMap& map, const PointsRef& points, int num_threads) {
  std::vector<float> greatest(points.cols(), 0.0f);
  if (map.empty()) return greatest;
  const Points centered = normalizePoints(points, map.grid.center(), 1.0);
  parallelRanges(greatest.size(), points_at_a_time, num_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t direction = 0; direction < map.grid.numDirections(); ++direction) {
      const DirectionValues values(map, direction);
      const Eigen::Matrix3f frame = map.grid.frame(direction).cast<float>();
      for (std::size_t i = begin; i < end; ++i) {
        const auto x = centered.col(static_cast<Eigen::Index>(i));
        greatest[i] = std::max(greatest[i], values(frame.col(0).dot(x), frame.col(1).dot(x)));
      }
    }
  });
  return greatest;
}

}  // namespace pcl_symmetry
