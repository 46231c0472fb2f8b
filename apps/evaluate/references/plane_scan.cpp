#include "evaluate/references/plane_scan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "evaluate/mesh/closeness_grid.h"
#include "evaluate/references/plane_families.h"

namespace pcl_symmetry::apps {

namespace {

/// Normals on the half sphere. derived: 2 pi / (0.866 s^2) of spacing s = two degrees.
constexpr int kNumNormals = 5955;
constexpr double kOffsetStep = 0.01;  // diagonals; chosen: the tolerance; half takes twice the time and finds the same
constexpr int kNumOffsets = 101;      // derived: from -0.5 to 0.5 diagonals
/// Diagonals at which closeness ends. derived: three times the mean distance that the grid's nearest plane leaves (1.2
/// degrees at 0.2 diagonals and 0.5 %, twice each).
constexpr double kReach = 0.04;
/// Samples that are reflected in each plane. chosen: the standard error of a closeness is 0.03; half doubles the number
/// of local maxima, twice the time.
constexpr int kNumSamples = 256;
/// Samples that are reflected first, and the closeness below which no more are. chosen: two and a half standard errors
/// (0.06) below what candidates need; with half of the samples near planes are dropped, with twice as many it takes
/// longer.
constexpr std::size_t kFirstSamples = 64;
constexpr double kLeastFirst = 0.35;
/// Planes cut off at least this share of the samples. derived: a near plane maps 90 % of the area onto the mesh, and
/// where one side has less than a twentieth, the other would have to be folded onto itself.
constexpr double kLeastSide = 0.05;
/// Neighbours among the normals. derived: the first ring of a hexagonal grid of two degrees, with room to the second.
constexpr double kNeighbourAngle = 3.0 * kDegree;
/// Steps of the offset between neighbours. derived: half a diagonal times two degrees, in steps.
constexpr int kNeighbourOffsets = 2;

struct Neighbour {
  int index;
  bool flipped;  ///< the neighbour is close to the opposite normal
};

/// The grid of all planes and its closeness.
class PlaneScan {
public:
  PlaneScan(const TriangleScene& scene, const Points& samples, int num_threads)
      : grid_(scene, kReach, num_threads),
        num_threads_(num_threads),
        closeness_(static_cast<std::size_t>(kNumNormals) * kNumOffsets, -1.0f) {
    for (const ReflectionPlane& plane : planesThrough(Eigen::Vector3d(Eigen::Vector3d::Zero()), kNumNormals))
      normals_.push_back(plane.normal().cast<float>());
    const Eigen::Index size = std::min<Eigen::Index>(kNumSamples, samples.cols());
    // Samples lie in the order of the triangles: a golden step spreads the first ones as evenly as all.
    constexpr double kGoldenRatio = 0.61803398874989485;  // derived: (sqrt(5) - 1) / 2
    for (Eigen::Index i = 0; i < size; ++i) {
      const double place = kGoldenRatio * static_cast<double>(i), share = place - std::floor(place);
      samples_.push_back(samples.col(static_cast<Eigen::Index>(share * static_cast<double>(samples.cols()))));
    }
  }

  std::vector<ScannedPlane> run() {
    constexpr std::size_t kBlock = 64;  // normals; chosen: enough blocks for all threads
    parallelRanges(normals_.size(), kBlock, num_threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) scanNormal(static_cast<int>(i));
    });
    return localMaxima();
  }

private:
  float& closenessAt(int normal, int offset) {
    return closeness_[static_cast<std::size_t>(normal) * kNumOffsets + static_cast<std::size_t>(offset)];
  }
  static float offsetOf(int index) { return static_cast<float>(kOffsetStep * (index - kNumOffsets / 2)); }

  /// \param heights of the samples along the normal.
  float meanCloseness(const Eigen::Vector3f& normal, float offset, const std::vector<float>& heights,
                      std::size_t num_samples) const {
    int sum = 0;
    for (std::size_t i = 0; i < num_samples; ++i) sum += grid_.at(samples_[i] - 2.0f * (heights[i] - offset) * normal);
    return static_cast<float>(sum) / (255.0f * static_cast<float>(num_samples));
  }

  void scanNormal(int normal) {
    const Eigen::Vector3f& n = normals_[static_cast<std::size_t>(normal)];
    std::vector<float> heights;
    for (const Eigen::Vector3f& x : samples_) heights.push_back(n.dot(x));
    std::vector<float> sorted = heights;
    std::sort(sorted.begin(), sorted.end());
    const auto margin = static_cast<std::size_t>(kLeastSide * static_cast<double>(sorted.size()));
    const float low = sorted[margin], high = sorted[sorted.size() - 1 - margin];
    for (int k = 0; k < kNumOffsets; ++k) {
      const float offset = offsetOf(k);
      // A flat shape lies within one step: the plane in it is tried too.
      if (offset < low - kOffsetStep || offset > high + kOffsetStep) continue;
      const std::size_t first = std::min(kFirstSamples, samples_.size());
      closenessAt(normal, k) = meanCloseness(n, offset, heights, first);
      if (closenessAt(normal, k) >= kLeastFirst)
        closenessAt(normal, k) = meanCloseness(n, offset, heights, samples_.size());
    }
  }

  std::vector<Neighbour> neighboursOf(int normal) const {
    const auto least = static_cast<float>(std::cos(kNeighbourAngle));
    std::vector<Neighbour> neighbours;
    for (int i = 0; i < kNumNormals; ++i) {
      const float cosine = normals_[static_cast<std::size_t>(i)].dot(normals_[static_cast<std::size_t>(normal)]);
      if (std::abs(cosine) > least) neighbours.push_back({i, cosine < 0.0f});
    }
    return neighbours;
  }

  /// Among equal values the first is the maximum.
  bool isMaximum(int normal, int offset, const std::vector<Neighbour>& neighbours) {
    const float value = closenessAt(normal, offset);
    for (const Neighbour& neighbour : neighbours) {
      const int middle = neighbour.flipped ? kNumOffsets - 1 - offset : offset;
      const int begin = std::max(0, middle - kNeighbourOffsets),
                end = std::min(kNumOffsets - 1, middle + kNeighbourOffsets);
      for (int k = begin; k <= end; ++k) {
        const float other = closenessAt(neighbour.index, k);
        const bool is_before = std::make_pair(neighbour.index, k) < std::make_pair(normal, offset);
        if (other > value || (other == value && is_before)) return false;
      }
    }
    return true;
  }

  std::vector<ScannedPlane> localMaxima() {
    std::vector<std::vector<ScannedPlane>> found(normals_.size());
    parallelBlocks(normals_.size(), num_threads_, [&](std::size_t i) {
      const int normal = static_cast<int>(i);
      const std::vector<Neighbour> neighbours = neighboursOf(normal);
      for (int k = 0; k < kNumOffsets; ++k) {
        if (closenessAt(normal, k) < 0.0f || !isMaximum(normal, k, neighbours)) continue;
        found[i].push_back({ReflectionPlane(normals_[i].cast<double>(), offsetOf(k)), closenessAt(normal, k)});
      }
    });
    std::vector<ScannedPlane> all;
    for (const std::vector<ScannedPlane>& some : found) all.insert(all.end(), some.begin(), some.end());
    std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.closeness > b.closeness; });
    return all;
  }

  ClosenessGrid grid_;
  int num_threads_;
  std::vector<Eigen::Vector3f> normals_, samples_;
  std::vector<float> closeness_;  ///< by normal, then offset; negative where it was not tried
};

}  // namespace

std::vector<ScannedPlane> scanPlanes(const TriangleScene& scene, const Points& samples, int num_threads) {
  return PlaneScan(scene, samples, num_threads).run();
}

}  // namespace pcl_symmetry::apps
