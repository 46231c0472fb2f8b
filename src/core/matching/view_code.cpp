#include "core/matching/view_code.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/check.h"
#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/base/simd.h"
#include "core/base/symmetric_solvers.h"
#include "core/matching/matching_rules.h"

namespace pcl_symmetry {

namespace {

template <typename Integer>
Integer inSteps(double value, double step) {
  const double least = std::numeric_limits<Integer>::min(), greatest = std::numeric_limits<Integer>::max();
  return static_cast<Integer>(std::lround(std::clamp(value / step, least, greatest)));
}

constexpr std::size_t kBytesOfView = kViewCodeSize + 2;  // see packedViewCodes()

/// Squared distances of codes, in squared steps.
/// \param codes codes value by value, \p stride apart.
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

/// The least distance of the views of a shape; infinite if it has none.
float leastDistance(const std::int8_t* codes, std::size_t num_views, const ViewCode& scan, float size_weight) {
  const std::int8_t* sizes = codes + kViewCodeSize * num_views;
  constexpr std::size_t views_at_once = 256;
  std::array<std::int32_t, views_at_once> sums;
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t first = 0; first < num_views; first += views_at_once) {
    const std::size_t count = std::min(views_at_once, num_views - first);
    sqCodeDistances(codes + first, num_views, count, scan.values.data(), sums.data());
    for (std::size_t i = 0; i < count; ++i) {
      const float size = static_cast<float>(std::abs(sizeAt(sizes, first + i) - scan.size));
      least = std::min(least, kViewCodeStep * std::sqrt(static_cast<float>(sums[i])) + size_weight * size);
    }
  }
  return least;
}

struct NearView {
  double distance;
  const View* view;
  double angle;
};

/// The nearest views of one shape, nearest first.
std::vector<NearView> nearestViews(const std::vector<View>& views, const View& scan, const ViewComparison& comparison) {
  std::vector<NearView> nearest;
  for (const View& view : views) {
    const double size = kMatching.size_weight * std::abs(std::log(view.radius / scan.radius));
    const bool full = nearest.size() >= kMatching.num_view_poses;
    const double enough = full ? nearest.back().distance - size : 2.0;  // 2 is the greatest distance of unit vectors
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
  const std::size_t count = std::min<std::size_t>(kMatching.num_mean_views, nearest.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) sum += nearest[i].distance;
  return sum / static_cast<double>(count);
}

}  // namespace

std::string packedViewCodes(const std::vector<ViewCode>& codes) {
  std::string bytes;
  bytes.reserve(kBytesOfView * codes.size());
  for (std::size_t k = 0; k < kViewCodeSize; ++k)
    for (const ViewCode& code : codes) bytes.push_back(static_cast<char>(code.values[k]));
  for (const ViewCode& code : codes) {
    const auto size = static_cast<std::uint16_t>(code.size);
    bytes.push_back(static_cast<char>(size));
    bytes.push_back(static_cast<char>(size >> 8));
  }
  return bytes;
}

ViewCoder ViewCoder::fit(const std::vector<View>& views) {
  check(!views.empty(), "number of views", static_cast<double>(views.size()), ">= 1");
  Eigen::MatrixXd magnitudes(kViewMagnitudes, static_cast<Eigen::Index>(views.size()));
  for (std::size_t i = 0; i < views.size(); ++i) magnitudes.col(i) = magnitudesOf(views[i].values).cast<double>();
  const Eigen::VectorXd mean = magnitudes.rowwise().mean();
  magnitudes.colwise() -= mean;
  const Eigen::MatrixXd products = magnitudes * magnitudes.transpose();
  const SymmetricEigen<Eigen::MatrixXd> solver(products);
  ViewCoder coder;
  coder.mean_ = mean.cast<float>();
  coder.basis_ = solver.eigenvectors().rowwise().reverse().leftCols(kViewCodeSize).cast<float>();
  return coder;
}

ViewCode ViewCoder::codeOf(const View& view) const {
  const Eigen::VectorXf components = basis_.transpose() * (magnitudesOf(view.values) - mean_);
  ViewCode code;
  for (int k = 0; k < kViewCodeSize; ++k)
    code.values[k] = inSteps<std::int8_t>(static_cast<double>(components[k]), static_cast<double>(kViewCodeStep));
  code.size = inSteps<std::int16_t>(std::log(view.radius), static_cast<double>(kViewSizeStep));
  return code;
}

std::string ViewCoder::codesOf(const std::vector<View>& views) const {
  std::vector<ViewCode> codes;
  codes.reserve(views.size());
  for (const View& view : views) codes.push_back(codeOf(view));
  return packedViewCodes(codes);
}

Eigen::MatrixXf ViewCoder::toValues() const {
  Eigen::MatrixXf values(kViewMagnitudes, 1 + kViewCodeSize);
  values << mean_, basis_;
  return values;
}

ViewCoder ViewCoder::fromValues(const Eigen::MatrixXf& values) {
  check(values.rows() == kViewMagnitudes && values.cols() == 1 + kViewCodeSize, "size of a view coder",
        static_cast<double>(values.size()), "that of this library");
  ViewCoder coder;
  coder.mean_ = values.col(0);
  coder.basis_ = values.rightCols(kViewCodeSize);
  return coder;
}

void ViewCodeIndex::add(const std::string& codes) {
  check(codes.size() % kBytesOfView == 0, "bytes of view codes", static_cast<double>(codes.size()),
        "a multiple of those of a view");
  codes_.insert(codes_.end(), codes.begin(), codes.end());
  begins_.push_back(begins_.back() + codes.size() / kBytesOfView);
}

std::vector<int> ViewCodeIndex::nearest(const ViewCode& scan, int count, int num_threads) const {
  check(count >= 0, "count", count, ">= 0");
  const auto weight = static_cast<float>(kMatching.size_weight) * kViewSizeStep;
  std::vector<float> distances(numShapes());
  parallelRanges(numShapes(), 256, num_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      distances[i] =
          leastDistance(codes_.data() + kBytesOfView * begins_[i], begins_[i + 1] - begins_[i], scan, weight);
  });
  std::vector<int> shapes;
  for (std::size_t i = 0; i < distances.size(); ++i)
    if (std::isfinite(distances[i])) shapes.push_back(static_cast<int>(i));
  const std::size_t kept = std::min(shapes.size(), static_cast<std::size_t>(count));
  std::nth_element(shapes.begin(), shapes.begin() + kept, shapes.end(), [&](int a, int b) {
    const float near_a = distances[a], near_b = distances[b];
    return near_a != near_b ? near_a < near_b : a < b;
  });
  shapes.resize(kept);
  std::sort(shapes.begin(), shapes.end());
  return shapes;
}

void ViewIndex::add(const std::vector<View>& views) {
  shapes_.push_back(views);
}

std::vector<ShapeOfView> ViewIndex::nearest(const View& scan, int num_nearest, int num_threads) const {
  const ViewComparison comparison(scan);
  std::vector<std::vector<NearView>> views(shapes_.size());
  parallelRanges(shapes_.size(), 16, num_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) views[i] = nearestViews(shapes_[i], scan, comparison);
  });

  std::vector<int> order;
  for (std::size_t i = 0; i < views.size(); ++i)
    if (!views[i].empty()) order.push_back(static_cast<int>(i));
  const auto distance = [&](int shape) { return meanDistance(views[shape]); };
  sortAscending(order, distance);
  order.resize(std::min(order.size(), static_cast<std::size_t>(num_nearest)));

  std::vector<ShapeOfView> found;
  for (const int shape : order) {
    found.push_back({shape, distance(shape), {}});
    for (const NearView& pose : views[shape])
      found.back().T_shape_scan.push_back(poseOfView(scan, *pose.view, pose.angle));
  }
  return found;
}

}  // namespace pcl_symmetry
