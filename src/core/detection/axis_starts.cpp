#include "core/detection/axis_starts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/revolution_of_normals.h"
#include "pcl_symmetry/core/axial_transform.h"

namespace pcl_symmetry {

namespace {

constexpr int kNormalSamples = 600;  // chosen: half shifts the axis by noise, twice takes twice the time
// Draws of normals, and normals in each. derived: six numbers fix a motion but for its size; chosen: at 60 draws one is
// free of a handle of a fifth of the surface with probability 1 - 1e-8.
constexpr int kNormalDraws = 60, kNormalsInDraw = 8;
constexpr std::size_t kDrawsPerBlock = 4;  // chosen: large enough that threads start seldom
constexpr int kFromNormals = 3;            // lines kept; chosen: more repeat the best
constexpr double kMeets = 0.1;             // radians; chosen: as for the weights of axisOfNormals()
constexpr double kLeastLever = 0.05;       // radii; chosen: as there
// Radians, radii: lines are one within these. chosen: a fit comes to the same line from either.
constexpr double kSameStartAngle = 0.1, kSameStartOffset = 0.06;
constexpr double kAngleOfFold = 3.0 * kDegree;  // chosen: planes of scans are off by this much in one of ten
constexpr double kLeastPlaneAngle = 0.13;       // radians; chosen: lines of planes at less are too far off
// The coarse transform: cells, bins, samples and folds. chosen: it takes a tenth of the time of a scan; half of the
// bins misses axes, twice takes 16 times as long. measured: 64, 32 and 24 samples find 122, 123 and 122 of 124 axes
// (scans of shapes made by code, tuning half, 160 scans).
constexpr int kCoarseCells = 24, kCoarseTheta = 8, kCoarsePhi = 32, kCoarseOffset = 12, kCoarseSamples = 32;
constexpr std::size_t kCoarseMaxima = 10;  // chosen: half misses axes of folds, twice takes twice the time
constexpr double kCoarseAngle = 0.3, kCoarseDistance = 0.3;  // radians, radii; derived: one and a half bins
constexpr double kCoarseEqual = 0.05;                        // D; chosen: coarse maxima are this far from their peaks

bool isOne(const Line3d& a, const Line3d& b, double angle, double offset) {
  return std::abs(a.direction().dot(b.direction())) > std::cos(angle) &&
         a.distance(b.projection(Eigen::Vector3d::Zero())) < offset;
}

double missAt(const Line3d& line, const Eigen::Vector3d& x, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d velocity = line.direction().cross(x - line.origin());
  return std::abs(velocity.dot(normal)) / std::max(kLeastLever, velocity.norm());
}

}  // namespace

std::vector<AxisStart> startsFromNormals(const NormalizedCloud& cloud, std::uint64_t seed, int num_threads) {
  const std::vector<int> samples = drawSamples(cloud.points.cols(), kNormalSamples, seed);
  const Points& normals = cloud.geometry.normals;
  const auto inliersOf = [&](const Line3d& line) {
    std::vector<int> inliers;
    for (const int i : samples)
      if (missAt(line, cloud.points.col(i).cast<double>(), normals.col(i).cast<double>()) < kMeets)
        inliers.push_back(i);
    return inliers;
  };
  std::vector<std::vector<int>> draws(1, samples);
  RandomStream random(seed);
  for (int draw = 0; draw < kNormalDraws; ++draw) {
    std::vector<int> few;
    for (int k = 0; k < kNormalsInDraw; ++k) few.push_back(samples[random.below(samples.size())]);
    draws.push_back(std::move(few));
  }
  std::vector<std::pair<double, Line3d>> found(draws.size());
  parallelRanges(draws.size(), kDrawsPerBlock, num_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Line3d line = axisOfNormals(cloud.points, normals, draws[i]);
      const bool is_line = line.direction().allFinite() && line.origin().allFinite();
      found[i] = {is_line ? -static_cast<double>(inliersOf(line).size()) : 1.0, line};
    }
  });
  found.erase(std::remove_if(found.begin(), found.end(), [](const auto& one) { return one.first > 0.0; }), found.end());
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<AxisStart> starts;
  for (const auto& [unused, line] : found) {
    if (starts.size() == kFromNormals) break;
    const std::vector<int> inliers = inliersOf(line);
    if (inliers.empty()) break;
    const Line3d fitted = axisOfNormals(cloud.points, normals, inliers);
    const bool is_known = std::any_of(starts.begin(), starts.end(), [&](const AxisStart& other) {
      return isOne(other.line, fitted, kSameStartAngle, kSameStartOffset);
    });
    if (!is_known && fitted.origin().norm() < 2.0) starts.push_back({fitted, 0});
  }
  return starts;
}

std::vector<AxisStart> startsFromPlanes(const std::vector<ReflectionPlane>& planes, int max_fold) {
  std::vector<AxisStart> starts;
  for (std::size_t i = 0; i < planes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double angle = planes[i].angleTo(planes[j]);
      if (angle < kLeastPlaneAngle) continue;
      const Eigen::Vector3d& a = planes[i].normal();
      const Eigen::Vector3d& b = planes[j].normal();
      const double cosine = a.dot(b), sq_sine = 1.0 - cosine * cosine;
      const double s = (planes[i].offset() - cosine * planes[j].offset()) / sq_sine,
                   t = (planes[j].offset() - cosine * planes[i].offset()) / sq_sine;
      const Line3d line(s * a + t * b, a.cross(b).normalized());
      // The least fold whose planes have this angle: two planes at k pi / n turn by 2 k pi / n.
      for (int n = 2; n <= max_fold; ++n) {
        const double step = kPi / n, off = std::abs(angle - step * std::round(angle / step));
        if (off > kAngleOfFold * std::min(1.0, 6.0 / n)) continue;
        starts.push_back({line, n});
        break;
      }
    }
  return starts;
}

std::vector<AxisStart> startsFromTransform(const NormalizedCloud& cloud, std::uint64_t seed, int num_threads) {
  GaussianEdtOptions coarse;
  coarse.num_cells = kCoarseCells;
  coarse.num_threads = num_threads;
  const GaussianEdt edt(cloud.points, coarse);
  AxialTransformOptions options;
  options.folds = {2, 3, 4, 5, 6};
  options.num_samples = kCoarseSamples;
  options.seed = seed;
  options.num_threads = num_threads;
  const AxisGrid grid(kCoarseTheta, kCoarsePhi, kCoarseOffset, edt.center(), edt.radius());
  const AxisMap map = axialTransform(edt, grid, options, &*cloud.visibility);
  std::vector<std::size_t> bins;  // a heap: the greatest first, of equal ones the one with the least index
  for (std::size_t i = 0; i < map.greatest.size(); ++i)
    if (map.greatest[i] > 0.0f) bins.push_back(i);
  const auto isBehind = [&](std::size_t a, std::size_t b) {
    return map.greatest[a] < map.greatest[b] || (map.greatest[a] == map.greatest[b] && a > b);
  };
  std::make_heap(bins.begin(), bins.end(), isBehind);
  std::vector<AxisStart> starts;
  while (!bins.empty() && starts.size() < kCoarseMaxima) {
    const std::size_t bin = bins.front();
    std::pop_heap(bins.begin(), bins.end(), isBehind);
    bins.pop_back();
    const Line3d line = grid.axis(grid.bin(bin));
    const bool is_known = std::any_of(starts.begin(), starts.end(), [&](const AxisStart& other) {
      return isOne(other.line, line, kCoarseAngle, kCoarseDistance);
    });
    if (is_known) continue;
    int fold = 2;
    for (std::size_t i = 0; i < map.folds.size(); ++i)
      if (map.values[i][bin] >= map.greatest[bin] - kCoarseEqual) fold = std::max(fold, map.folds[i]);
    starts.push_back({line, fold});
  }
  return starts;
}

}  // namespace pcl_symmetry
