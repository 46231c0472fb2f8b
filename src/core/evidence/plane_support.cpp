#include "core/evidence/plane_support.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/evidence/evidence_rules.h"

namespace pcl_symmetry {

namespace {

/// How far a point with a normal lies off the surface at a sample, squared, in units of what its support allows.
/// \return \p most where it is not less.
float sqDeviation(const SurfaceSample& sample, const Eigen::Vector3f& point, const Eigen::Vector3f& point_normal,
                  float most) {
  const Eigen::Vector3f difference = point - sample.point;
  const float reach = std::max(1e-6f, sample.disc_radius);
  const float sq_length = difference.squaredNorm();
  const float along =
      sq_length < kEvidence.surely * reach * reach ? 0.0f : std::max(0.0f, std::sqrt(sq_length) / reach - 1.0f);
  if (along * along >= most) return most;
  const float normal_reach = std::max(kEvidence.normal_reach, kEvidence.rough_reach * sample.roughness);
  const float height = std::abs(sample.normal.dot(difference));
  const float across = height < kEvidence.surely * normal_reach ? 0.0f : std::max(0.0f, height / normal_reach - 1.0f);
  const float sq_distance = along * along + across * across;
  if (sq_distance >= most) return most;
  const float cosine = std::min(1.0f, std::abs(sample.normal.dot(point_normal)));
  // Normals count as far as they can be trusted, without a jump.
  static const float agreeing = std::cos(kEvidence.normal_angle);
  if (cosine > agreeing || sample.normal_trust == 0.0f) return sq_distance;
  const float turned = sample.normal_trust * std::max(0.0f, std::acos(cosine) / kEvidence.normal_angle - 1.0f);
  return sq_distance + turned * turned;
}

/// Support by the closest sample or one of those next to it, whichever is best, but not by sample \p self (-1 = none).
float supportNear(int closest, int self, const Eigen::Vector3f& point, const Eigen::Vector3f& point_normal,
                  const SurfaceSamples& samples) {
  float least = sqDeviation(samples[closest], point, point_normal, kEvidence.most);
  for (const int j : samples[closest].nearest) {
    if (least == 0.0f) return 1.0f;
    if (j != self) least = std::min(least, sqDeviation(samples[j], point, point_normal, least));
  }
  return least < kEvidence.most ? std::exp(-least) : 0.0f;
}

}  // namespace

float emptiness(const Visibility& visibility, const Eigen::Vector3d& x) {
  const double behind = visibility.depthBehind(x);
  if (behind >= 0.0) return 0.0f;
  const bool is_exact = visibility.depthError(x) < kEvidence.exact_depth;
  return std::isfinite(behind) || is_exact ? 1.0f : kEvidence.empty_without_depth;
}

PointEvidence pointEvidence(const Points& reflected, const Points& reflected_normals, const std::vector<int>& closest,
                            const SurfaceSamples& samples, const Visibility* visibility) {
  const std::size_t size = closest.size();
  PointEvidence evidence{std::vector<float>(size), std::vector<float>(size)};
  for (std::size_t i = 0; i < size; ++i) {
    if (closest[i] >= 0)
      evidence.support[i] = supportNear(closest[i], -1, reflected.col(i), reflected_normals.col(i), samples);
    // Full support leaves no conflict.
    if (evidence.support[i] == 1.0f) continue;
    const float empty = visibility ? emptiness(*visibility, reflected.col(i).cast<double>()) : 1.0f;
    evidence.conflict[i] = empty * (1.0f - evidence.support[i]);
  }
  return evidence;
}

std::vector<float> ownSupport(const SurfaceSamples& samples, int num_threads) {
  constexpr std::size_t kBlockSize = 2048;  // points. Large enough that threads start seldom
  std::vector<float> support(static_cast<std::size_t>(samples.size()));
  parallelRanges(support.size(), kBlockSize, num_threads, [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<int>(begin); i < static_cast<int>(end); ++i)
      support[i] = supportNear(samples[i].nearest[0], i, samples[i].point, samples[i].normal, samples);
  });
  return support;
}

double meanSupport(const std::vector<float>& support) {
  return std::accumulate(support.begin(), support.end(), 0.0) / static_cast<double>(support.size());
}

std::vector<std::vector<float>> planeSupport(const PointsRef& points, const PointsRef& samples,
                                             const std::vector<ReflectionPlane>& planes, int num_threads) {
  constexpr std::size_t kBlockSize = 4096;  // points. Large enough that threads start seldom
  const BoundingBall ball = boundingBall(samples);
  check(ball.radius > 0.0, "extent of the samples", ball.radius, "> 0");
  const Points surface = normalizePoints(samples, ball.center, ball.radius);
  const auto search = makeFlannSearch(surface);
  const SurfaceSamples described(surface, localGeometry(surface, *search, kNumSupportNeighbors, num_threads));
  std::vector<std::vector<float>> support(planes.size(), std::vector<float>(points.cols()));
  parallelRanges(points.cols(), kBlockSize, num_threads, [&](std::size_t begin, std::size_t end) {
    const auto size = static_cast<Eigen::Index>(end - begin);
    const std::vector<int> own =
        search->closest(normalizePoints(points.middleCols(begin, size), ball.center, ball.radius));
    Points reflected(3, size), normals(3, size);
    for (std::size_t k = 0; k < planes.size(); ++k) {
      const Eigen::Vector3f n = planes[k].normal().cast<float>();
      for (Eigen::Index i = 0; i < size; ++i) {
        const Eigen::Vector3d x = points.col(begin + i).cast<double>();
        reflected.col(i) = ((planes[k].reflect(x) - ball.center) / ball.radius).cast<float>();
        const Eigen::Vector3f normal = described[own[i]].normal;
        normals.col(i) = normal - 2.0f * n.dot(normal) * n;
      }
      const PointEvidence part = pointEvidence(reflected, normals, search->closest(reflected), described, nullptr);
      std::copy(part.support.begin(), part.support.end(), support[k].begin() + static_cast<std::ptrdiff_t>(begin));
    }
  });
  return support;
}

}  // namespace pcl_symmetry
