#include "core/scan/ray_gaps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/base/median.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

namespace {

/// A step from pixel to pixel along a line of the picture.
struct PixelStep {
  int du, dv;

  float length() const { return std::hypot(static_cast<float>(du), static_cast<float>(dv)); }
};

/// Calls visit(from, to, count) for each two filled pixels of a line that follow each other, \p count steps apart.
template <typename Visit>
void visitLine(const PartialImage& image, int u, int v, const PixelStep& step, const Visit& visit) {
  std::ptrdiff_t last = -1;
  int count = 0;
  for (; u >= 0 && v >= 0 && u < image.width && v < image.height; u += step.du, v += step.dv, ++count) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(v) * image.width + u;
    if (image.depths[at] == Visibility::kBackground) continue;
    if (last >= 0) visit(last, at, count);
    last = at;
    count = 0;
  }
}

/// The same for all lines along a step.
template <typename Visit>
void visitLines(const PartialImage& image, const PixelStep& step, const Visit& visit) {
  const int side = step.du < 0 ? image.width - 1 : 0;
  if (step.du != 0)
    for (int v = 0; v < image.height; ++v) visitLine(image, side, v, step, visit);
  if (step.dv != 0)
    for (int u = 0; u < image.width; ++u)
      if (step.du == 0 || u != side) visitLine(image, u, 0, step, visit);
}

/// Of each filled pixel, the distance to the next one along a step or against it.
std::vector<float> distancesAlong(const PartialImage& image, const PixelStep& step) {
  std::vector<float> distances(image.depths.size(), std::numeric_limits<float>::infinity());
  visitLines(image, step, [&](std::ptrdiff_t from, std::ptrdiff_t to, int count) {
    for (const std::ptrdiff_t at : {from, to}) distances[at] = std::min(distances[at], static_cast<float>(count));
  });
  return distances;
}

}  // namespace

double typicalGap(const PartialImage& image) {
  const std::vector<float> in_row = distancesAlong(image, {1, 0}), in_column = distancesAlong(image, {0, 1});
  std::vector<double> gaps;
  for (std::size_t i = 0; i < in_row.size(); ++i)
    if (in_row[i] < std::numeric_limits<float>::infinity() && in_column[i] < std::numeric_limits<float>::infinity())
      gaps.push_back(std::max(in_row[i], in_column[i]));
  return gaps.empty() ? 0.0 : median(std::move(gaps));
}

void bridgeGaps(PartialImage image, double longest) {
  std::vector<float> filled = image.depths, shortest(filled.size(), std::numeric_limits<float>::infinity());
  for (const PixelStep& step : {PixelStep{1, 0}, PixelStep{0, 1}, PixelStep{1, 1}, PixelStep{-1, 1}}) {
    visitLines(image, step, [&](std::ptrdiff_t from, std::ptrdiff_t to, int count) {
      const float gap = step.length() * static_cast<float>(count);
      if (gap > static_cast<float>(longest)) return;
      const float nearer = std::min(image.depths[from], image.depths[to]);
      const std::ptrdiff_t stride = (to - from) / count;
      for (std::ptrdiff_t at = from + stride; at != to; at += stride) {
        if (gap > shortest[at]) continue;
        filled[at] = gap < shortest[at] ? nearer : std::min(filled[at], nearer);
        shortest[at] = gap;
      }
    });
  }
  image.depths = std::move(filled);
}

}  // namespace pcl_symmetry
