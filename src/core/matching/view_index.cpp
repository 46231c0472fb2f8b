#include "core/matching/view_index.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/parallel.h"
#include "core/matching/matching_rules.h"

namespace pcl_symmetry {

namespace {

struct NearView {
  double distance;
  const View* view;
  double angle;
};

/// The nearest views of one shape, nearest first.
std::vector<NearView> nearestViews(const std::vector<View>& views, const View& scan, const ViewComparison& comparison,
                                   const ViewSearchOptions& options) {
  std::vector<NearView> nearest;
  for (const View& view : views) {
    const double size = options.size_weight * std::abs(std::log(view.radius / scan.radius));
    const bool full = nearest.size() >= static_cast<std::size_t>(options.num_poses);
    const double enough = full ? nearest.back().distance - size : 2.0;  // the greatest distance of unit vectors
    if (enough <= 0.0) continue;
    const ViewAgreement agreement = comparison.compare(view.values.data(), static_cast<float>(enough));
    if (agreement.distance >= enough) continue;
    const NearView pose{agreement.distance + size, &view, agreement.angle};
    if (full) nearest.pop_back();
    nearest.insert(std::upper_bound(nearest.begin(), nearest.end(), pose,
                                    [](const NearView& a, const NearView& b) { return a.distance < b.distance; }),
                   pose);
  }
  return nearest;
}

double meanDistance(const std::vector<NearView>& nearest) {
  const std::size_t count = std::min<std::size_t>(matching_rules.num_mean_views, nearest.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) sum += nearest[i].distance;
  return sum / static_cast<double>(count);
}

}  // namespace

void ViewIndex::add(const std::vector<View>& views) {
  shapes_.push_back(views);
}

std::vector<ShapeOfView> ViewIndex::nearest(const View& scan, const ViewSearchOptions& options) const {
  const ViewComparison comparison(scan);
  std::vector<std::vector<NearView>> views(shapes_.size());
  parallelRanges(shapes_.size(), 16, options.num_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) views[i] = nearestViews(shapes_[i], scan, comparison, options);
  });

  std::vector<int> order;
  for (std::size_t i = 0; i < views.size(); ++i)
    if (!views[i].empty()) order.push_back(static_cast<int>(i));
  const auto distance = [&](int shape) { return meanDistance(views[static_cast<std::size_t>(shape)]); };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return distance(a) < distance(b); });
  order.resize(std::min(order.size(), static_cast<std::size_t>(options.num_nearest)));

  std::vector<ShapeOfView> found;
  for (const int shape : order) {
    found.push_back({shape, distance(shape), {}});
    for (const NearView& pose : views[static_cast<std::size_t>(shape)])
      found.back().T_shape_scan.push_back(poseOfView(scan, *pose.view, pose.angle));
  }
  return found;
}

}  // namespace pcl_symmetry
