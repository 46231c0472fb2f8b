#include "core/evidence/surface_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "core/geometry/geometry_rules.h"
#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

namespace {

constexpr float kHalfDiagonal = 0.8660254f;  // cells: sqrt(3) / 2

/// Distance from the nearest of the discs of a sample and its neighbors, without the disc of sample \p self (-1 =
/// none).
float distanceNear(int closest, int self, const Eigen::Vector3f& point, const SurfaceSamples& samples,
                   float sq_across_factor = 1.0f) {
  float least = samples[closest].sqDistance(point, sq_across_factor);
  for (const int j : samples[closest].nearest)
    if (j != self) least = std::min(least, samples[j].sqDistance(point, sq_across_factor));
  return std::sqrt(least);
}

/// Squared deviation of a point with a normal from the surface at a sample, in units of its allowed support.
/// \return \p max_sq_deviation if it is not less.
float sqDeviation(const SurfaceSample& sample, const Eigen::Vector3f& point, const Eigen::Vector3f& point_normal,
                  float max_sq_deviation) {
  const Eigen::Vector3f difference = point - sample.center;
  const float reach = std::max(1e-6f, sample.radius);
  const float sq_length = difference.squaredNorm();
  const float along =
      sq_length < kEvidence.surely * reach * reach ? 0.0f : std::max(0.0f, std::sqrt(sq_length) / reach - 1.0f);
  if (along * along >= max_sq_deviation) return max_sq_deviation;
  const float normal_reach = std::max(kEvidence.normal_reach, kEvidence.rough_reach * sample.roughness);
  const float height = std::abs(sample.normal.dot(difference));
  const float across = height < kEvidence.surely * normal_reach ? 0.0f : std::max(0.0f, height / normal_reach - 1.0f);
  const float sq_distance = along * along + across * across;
  if (sq_distance >= max_sq_deviation) return max_sq_deviation;
  const float cosine = std::min(1.0f, std::abs(sample.normal.dot(point_normal)));
  // Normals count by their reliability, without a jump.
  static const float agreeing = std::cos(kEvidence.normal_angle);
  if (cosine > agreeing || sample.normal_trust == 0.0f) return sq_distance;
  const float excess = sample.normal_trust * std::max(0.0f, std::acos(cosine) / kEvidence.normal_angle - 1.0f);
  return sq_distance + excess * excess;
}

/// Support by the closest sample or one of those next to it, whichever is best, except sample \p self (-1 = none).
float supportNear(int closest, int self, const Eigen::Vector3f& point, const Eigen::Vector3f& point_normal,
                  const SurfaceSamples& samples) {
  float least = sqDeviation(samples[closest], point, point_normal, kEvidence.max_sq_deviation);
  for (const int j : samples[closest].nearest) {
    if (least == 0.0f) return 1.0f;
    if (j != self) least = std::min(least, sqDeviation(samples[j], point, point_normal, least));
  }
  return least < kEvidence.max_sq_deviation ? std::exp(-least) : 0.0f;
}

}  // namespace

SurfaceDiscs::SurfaceDiscs(const Points& samples, const LocalGeometry& geometry, float disc_radius, float reach)
    : reach_(reach) {
  const auto spacing = static_cast<float>(median(geometry.spacing));
  float greatest = 0.0f;
  for (Eigen::Index i = 0; i < samples.cols(); ++i) {
    discs_.push_back({samples.col(i), geometry.normals.col(i),
                      disc_radius * std::min(geometry.spacing[i], kEvidence.max_disc_spacing * spacing)});
    greatest = std::max(greatest, discs_.back().radius);
  }
  const float margin = reach + greatest;
  const Eigen::Vector3f low = samples.rowwise().minCoeff(), high = samples.rowwise().maxCoeff();
  const float extent = (high - low).maxCoeff() + 2.0f * margin;
  cell_size_ = std::max(kEvidence.disc_cell * spacing, extent / kEvidence.max_disc_cells);
  origin_ = low.array() - margin;
  const Eigen::Array3f sides = (high - low).array() + 2.0f * margin;
  size_ = (sides / cell_size_).cast<int>() + 1;
  // Counts, then positions: two passes over the same cells.
  first_.assign(static_cast<std::size_t>(size_.prod()) + 1, 0);
  for (const SurfaceDisc& disc : discs_) visitCells(disc, [&](std::size_t cell) { ++first_[cell + 1]; });
  for (std::size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
  entries_.resize(first_.back());
  std::vector<int> next = first_;
  for (std::size_t i = 0; i < discs_.size(); ++i)
    visitCells(discs_[i], [&](std::size_t cell) { entries_[next[cell]++] = static_cast<int>(i); });
}

/// Calls visit(cell) for the cells that hold points within reach of a disc, and for a few others.
template <typename Visit>
void SurfaceDiscs::visitCells(const SurfaceDisc& disc, const Visit& visit) const {
  const float beside = disc.radius + reach_, slack = kHalfDiagonal * cell_size_;
  const Eigen::Array3f low = (disc.center - origin_).array() - beside, high = low + 2.0f * beside;
  const Eigen::Array3i from = (low / cell_size_).max(0.0f).cast<int>();
  const Eigen::Array3i to = (high / cell_size_).cast<int>().min(size_ - 1);
  for (int z = from.z(); z <= to.z(); ++z)
    for (int y = from.y(); y <= to.y(); ++y)
      for (int x = from.x(); x <= to.x(); ++x) {
        const Eigen::Vector3f center =
            origin_ +
            cell_size_ *
                (Eigen::Vector3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)).array() + 0.5f)
                    .matrix();
        const Eigen::Vector3f difference = center - disc.center;
        if (std::abs(disc.normal.dot(difference)) > reach_ + slack) continue;
        if (difference.squaredNorm() > (beside + slack) * (beside + slack)) continue;
        visit((static_cast<std::size_t>(z) * size_.y() + y) * size_.x() + x);
      }
}

SurfaceDiscs::Range SurfaceDiscs::discsNear(const Eigen::Vector3f& x) const {
  const Eigen::Array3f position = (x - origin_).array() / cell_size_;
  if (!(position >= 0.0f).all()) return {nullptr, nullptr};
  const Eigen::Array3i cell = position.min(static_cast<float>(kEvidence.max_disc_cells) + 2.0f).cast<int>();
  if (!(cell < size_).all()) return {nullptr, nullptr};
  const std::size_t index = (static_cast<std::size_t>(cell.z()) * size_.y() + cell.y()) * size_.x() + cell.x();
  return {entries_.data() + first_[index], entries_.data() + first_[index + 1]};
}

SurfaceDiscs::Nearest SurfaceDiscs::nearest(const Eigen::Vector3f& x) const {
  Nearest result;
  float least = reach_ * reach_;
  const Range range = discsNear(x);
  for (const int* disc = range.begin; disc != range.end; ++disc) {
    const float sq_distance = discs_[*disc].sqDistance(x);
    if (!(sq_distance <= least)) continue;
    least = sq_distance;
    result.disc = *disc;
  }
  if (result.disc >= 0) result.distance = std::sqrt(least);
  return result;
}

bool SurfaceDiscs::isWithin(const Eigen::Vector3f& x, float distance) const {
  const float sq_limit = distance * distance;
  const Range range = discsNear(x);
  for (const int* disc = range.begin; disc != range.end; ++disc) {
    const SurfaceDisc& d = discs_[*disc];
    const Eigen::Vector3f difference = x - d.center;
    const float across = d.normal.dot(difference), sq_room = sq_limit - across * across;
    if (sq_room < 0.0f) continue;
    const float sq_along = difference.squaredNorm() - across * across;
    if (sq_along <= d.radius * d.radius) return true;
    const float reach = d.radius + distance;
    if (sq_along > reach * reach) continue;
    const float beside = std::sqrt(sq_along) - d.radius;
    if (beside * beside <= sq_room) return true;
  }
  return false;
}

float SurfaceDiscs::ownDistance(int i, float across_factor) const {
  const Eigen::Vector3f& x = discs_[i].center;
  float least = std::numeric_limits<float>::infinity();
  const Range range = discsNear(x);
  for (const int* disc = range.begin; disc != range.end; ++disc)
    if (*disc != i) least = std::min(least, discs_[*disc].sqDistance(x, across_factor * across_factor));
  return std::sqrt(least);
}

SurfaceSamples surfaceSamples(const Points& points, const LocalGeometry& geometry, int num_threads) {
  SurfaceSamples samples(points.cols());
  parallelPoints(samples.size(), num_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const float spacing = geometry.spacing[i], rough = geometry.roughness[i] / std::max(spacing, 1e-6f);
      samples[i] = {{points.col(i), geometry.normals.col(i), kEvidence.disc_radius * spacing},
                    geometry.roughness[i],
                    std::clamp((kEvidence.max_roughness - rough) / kEvidence.trust_width, 0.0f, 1.0f),
                    geometry.nearest[i]};
    }
  });
  return samples;
}

std::vector<float> surfaceDistances(const Points& points, const std::vector<int>& closest,
                                    const SurfaceSamples& samples, int num_threads) {
  std::vector<float> distances(closest.size(), std::numeric_limits<float>::infinity());
  parallelPoints(closest.size(), num_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (closest[i] >= 0) distances[i] = distanceNear(closest[i], -1, points.col(i), samples);
  });
  return distances;
}

std::vector<float> ownSurfaceDistances(const SurfaceSamples& samples, int num_threads) {
  std::vector<float> distances(samples.size());
  parallelPoints(distances.size(), num_threads, [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<int>(begin); i < static_cast<int>(end); ++i)
      distances[i] = distanceNear(samples[i].nearest[0], i, samples[i].center, samples,
                                  kEvidence.new_point_factor * kEvidence.new_point_factor);
  });
  return distances;
}

double shareWithin(const std::vector<float>& distances, double tolerance) {
  const auto limit = static_cast<float>(tolerance);
  const auto count =
      std::count_if(distances.begin(), distances.end(), [&](float distance) { return distance <= limit; });
  return static_cast<double>(count) / static_cast<double>(distances.size());
}

float freeConfidence(const Visibility& visibility, const Eigen::Vector3d& x) {
  const double behind = visibility.depthBehind(x);
  if (behind >= 0.0) return 0.0f;
  const bool is_exact = visibility.depthError(x) < kEvidence.exact_depth;
  return std::isfinite(behind) || is_exact ? 1.0f : kEvidence.free_without_depth;
}

PointEvidence pointEvidence(const Points& reflected, const Points& reflected_normals, const std::vector<int>& closest,
                            const SurfaceSamples& samples, const Visibility* visibility, int num_threads) {
  const std::size_t size = closest.size();
  PointEvidence evidence{std::vector<float>(size), std::vector<float>(size)};
  parallelPoints(size, num_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (closest[i] >= 0)
        evidence.support[i] = supportNear(closest[i], -1, reflected.col(i), reflected_normals.col(i), samples);
      // Full support leaves no conflict.
      if (evidence.support[i] == 1.0f) continue;
      const float certainty = visibility ? freeConfidence(*visibility, reflected.col(i).cast<double>()) : 1.0f;
      evidence.conflict[i] = certainty * (1.0f - evidence.support[i]);
    }
  });
  return evidence;
}

std::vector<float> ownSupport(const SurfaceSamples& samples, int num_threads) {
  std::vector<float> support(samples.size());
  parallelPoints(support.size(), num_threads, [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<int>(begin); i < static_cast<int>(end); ++i)
      support[i] = supportNear(samples[i].nearest[0], i, samples[i].center, samples[i].normal, samples);
  });
  return support;
}

std::vector<float> PointEvidence::seenSupport() const {
  std::vector<float> seen = support;
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (support[i] + conflict[i] < 0.5f) seen[i] = std::numeric_limits<float>::quiet_NaN();
  return seen;
}

std::vector<std::vector<float>> planeSupport(const PointsRef& points, const PointsRef& samples,
                                             const std::vector<ReflectionPlane>& planes, const Visibility* seen,
                                             int num_threads) {
  const BoundingBall ball = boundingBall(samples);
  check(ball.radius > 0.0, "extent of the samples", ball.radius, "> 0");
  const Points surface = normalizePoints(samples, ball.center, ball.radius);
  const auto search = makeFlannSearch(surface);
  const SurfaceSamples described = surfaceSamples(surface, localGeometry(surface, *search, num_threads));
  std::optional<Visibility> visibility;
  if (seen) visibility = seen->normalized(ball.center, ball.radius);
  std::vector<std::vector<float>> support(planes.size(), std::vector<float>(points.cols()));
  parallelPoints(points.cols(), num_threads, [&](std::size_t begin, std::size_t end) {
    const auto size = static_cast<Eigen::Index>(end - begin);
    const std::vector<int> own =
        search->closest(normalizePoints(points.middleCols(begin, size), ball.center, ball.radius));
    Points normals(3, size), reflected(3, size);
    for (Eigen::Index i = 0; i < size; ++i) normals.col(i) = described[own[i]].normal;
    for (std::size_t k = 0; k < planes.size(); ++k) {
      for (Eigen::Index i = 0; i < size; ++i)
        reflected.col(i) =
            ((planes[k].reflect(points.col(begin + i).cast<double>()) - ball.center) / ball.radius).cast<float>();
      const std::vector<float> part =
          pointEvidence(reflected, reflectedNormals(normals, planes[k]), search->closest(reflected), described,
                        visibility ? &*visibility : nullptr)
              .seenSupport();
      std::copy(part.begin(), part.end(), support[k].begin() + begin);
    }
  });
  return support;
}

}  // namespace pcl_symmetry
