#include "core/matching/view_code_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/base/simd.h"

namespace pcl_symmetry {

namespace {

constexpr std::size_t kBytesOfView = kViewCodeSize + 2;  // derived: see packedViewCodes()
// Views that are compared at once. chosen: their sums stay in the first cache; half and twice take the same time.
constexpr std::size_t kViewsAtOnce = 256;
// Shapes per block of work. chosen: a block takes tens of microseconds; half costs overhead, twice leaves threads idle.
constexpr std::size_t kShapesOfBlock = 256;

/// Squared distances of codes, in squares of the step.
/// \param codes value by value, \p stride apart.
PCL_SYMMETRY_MULTIVERSION
void sqCodeDistances(const std::int8_t* codes, std::size_t stride, std::size_t count, const std::int8_t* scan,
                     std::int32_t* sums) {
  for (std::size_t i = 0; i < count; ++i) sums[i] = 0;
  for (std::size_t k = 0; k < kViewCodeSize; ++k) {
    const std::int8_t* values = codes + k * stride;
    const auto own = static_cast<std::int16_t>(scan[k]);
    for (std::size_t i = 0; i < count; ++i) {
      const auto difference = static_cast<std::int16_t>(values[i] - own);
      sums[i] += difference * difference;
    }
  }
}

std::int16_t sizeAt(const std::int8_t* sizes, std::size_t i) {
  const auto low = static_cast<std::uint8_t>(sizes[2 * i]), high = static_cast<std::uint8_t>(sizes[2 * i + 1]);
  return static_cast<std::int16_t>(low | high << 8);
}

/// The least distance of the views of a shape; infinite without views.
float leastDistance(const std::int8_t* codes, std::size_t num_views, const ViewCode& scan, float size_weight) {
  const std::int8_t* sizes = codes + kViewCodeSize * num_views;
  std::array<std::int32_t, kViewsAtOnce> sums;
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t first = 0; first < num_views; first += kViewsAtOnce) {
    const std::size_t count = std::min(kViewsAtOnce, num_views - first);
    sqCodeDistances(codes + first, num_views, count, scan.values.data(), sums.data());
    for (std::size_t i = 0; i < count; ++i) {
      const float size = static_cast<float>(std::abs(sizeAt(sizes, first + i) - scan.size));
      least = std::min(least, kViewCodeStep * std::sqrt(static_cast<float>(sums[i])) + size_weight * size);
    }
  }
  return least;
}

}  // namespace

void ViewCodeIndex::reserve(std::size_t num_shapes, std::size_t num_views) {
  begins_.reserve(num_shapes + 1);
  codes_.reserve(kBytesOfView * num_views);
}

void ViewCodeIndex::add(const std::string& codes) {
  check(codes.size() % kBytesOfView == 0, "bytes of view codes", static_cast<double>(codes.size()),
        "a multiple of those of a view");
  codes_.insert(codes_.end(), codes.begin(), codes.end());
  begins_.push_back(begins_.back() + codes.size() / kBytesOfView);
}

std::vector<int> ViewCodeIndex::nearest(const ViewCode& scan, double size_weight, int count, int num_threads) const {
  check(count >= 0, "count", count, ">= 0");
  const auto weight = static_cast<float>(size_weight) * kViewSizeStep;
  std::vector<float> distances(numShapes());
  parallelRanges(numShapes(), kShapesOfBlock, num_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      distances[i] =
          leastDistance(codes_.data() + kBytesOfView * begins_[i], begins_[i + 1] - begins_[i], scan, weight);
  });
  std::vector<int> shapes;
  for (std::size_t i = 0; i < distances.size(); ++i)
    if (std::isfinite(distances[i])) shapes.push_back(static_cast<int>(i));
  const std::size_t kept = std::min(shapes.size(), static_cast<std::size_t>(count));
  std::nth_element(shapes.begin(), shapes.begin() + static_cast<std::ptrdiff_t>(kept), shapes.end(), [&](int a, int b) {
    const float near_a = distances[static_cast<std::size_t>(a)], near_b = distances[static_cast<std::size_t>(b)];
    return near_a != near_b ? near_a < near_b : a < b;
  });
  shapes.resize(kept);
  std::sort(shapes.begin(), shapes.end());
  return shapes;
}

}  // namespace pcl_symmetry
