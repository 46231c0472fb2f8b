#include "core/scan/scan_density.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/lists.h"
#include "core/base/statistics.h"
#include "core/base/symmetric_solvers.h"
#include "core/geometry/directions.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/surface_normals.h"
#include "core/scan/scan_rules.h"
#include "pcl_symmetry/core/closest_point_search.h"

namespace pcl_symmetry {

namespace {

/// The ellipse that the neighbors of a point cover.
struct Patch {
  Eigen::Vector3f normal;
  float log_density;  ///< up to a constant of all patches
  bool is_surface;
};

Patch fitPatch(const Points& points, const int* neighbors, int count) {
  const Eigen::Vector3f first = points.col(neighbors[0]);
  Moments offsets;
  for (int k = 0; k < count; ++k) offsets.add(points.col(neighbors[k]) - first);
  const SymmetricEigen<Eigen::Matrix3f> axes(offsets.scatter());
  const Eigen::Vector3f& moments = axes.eigenvalues();
  // The area of the ellipse: unlike the distance to the last neighbor, the moments about the mean are hardly larger at
  // a border.
  const float area = std::sqrt(moments[1] * moments[2]);
  Patch patch{axes.eigenvectors().col(0), -std::log(area), false};
  patch.is_surface = patch.normal.allFinite() && std::isfinite(patch.log_density) &&
                     moments[1] > kScan.thinnest * kScan.thinnest * moments[2] &&
                     std::max(moments[0], 0.0f) < kScan.thickest * kScan.thickest * area;
  return patch;
}

}  // namespace

/// A viewpoint, in radii about the center.
struct ScanDensity::Candidate {
  Eigen::Vector3d direction;
  double log_distance;
  double unexplained;

  Eigen::Vector3d eye() const { return std::exp(log_distance) * direction; }
};

ScanDensity::ScanDensity(const PointsRef& points) : ball_(boundingBall(points)) {
  if (points.cols() < static_cast<Eigen::Index>(kScan.fewest_density_samples) || !(ball_.radius > 0.0)) return;
  const std::vector<int> indices = shuffled(points.cols(), 0, static_cast<Eigen::Index>(kScan.density_points));
  Points used(3, indices.size());
  for (Eigen::Index i = 0; i < used.cols(); ++i)
    used.col(i) = ((points.col(indices[i]).cast<double>() - ball_.center) / ball_.radius).cast<float>();
  num_points_ = used.cols();
  const auto num_samples = static_cast<Eigen::Index>(std::min(indices.size(), kScan.density_samples));
  const int count = static_cast<int>(
      std::min(indices.size(), 1 + std::clamp(indices.size() / kScan.neighborhoods, kScan.fewest_density_neighbors,
                                              kScan.max_density_neighbors)));
  num_neighbors_ = count - 1;
  std::vector<int> neighbors;
  std::vector<float> sq_distances;
  makeFlannSearch(used)->search(used.leftCols(num_samples), count, neighbors, sq_distances);

  samples_.resize(3, num_samples);
  normals_.resize(3, num_samples);
  for (Eigen::Index i = 0; i < num_samples; ++i) {
    const Patch patch = fitPatch(used, neighbors.data() + i * count, count);
    if (!patch.is_surface) continue;
    const auto slot = static_cast<Eigen::Index>(log_density_.size());
    samples_.col(slot) = used.col(i);
    normals_.col(slot) = patch.normal;
    log_density_.push_back(patch.log_density);
  }
  samples_.conservativeResize(3, log_density_.size());
  normals_.conservativeResize(3, log_density_.size());
}

template <typename Value>
double ScanDensity::trimmedVariance(Eigen::Index num_samples, const Value& value) const {
  const auto size = static_cast<std::size_t>(std::min(num_samples, samples_.cols()));
  if (size < kScan.fewest_density_samples) return std::numeric_limits<double>::infinity();
  std::vector<float> values(size);
  for (std::size_t i = 0; i < size; ++i) values[i] = value(static_cast<Eigen::Index>(i));
  const auto trimmed = static_cast<std::ptrdiff_t>(kScan.trimmed * static_cast<double>(size));
  const auto begin = values.begin() + trimmed, end = values.end() - trimmed;
  std::nth_element(values.begin(), begin, values.end());
  std::nth_element(begin, end - 1, values.end());
  double sum = 0.0, sq_sum = 0.0;
  for (auto at = begin; at != end; ++at) {
    const double d = *at - *begin;
    sum += d;
    sq_sum += d * d;
  }
  const auto count = static_cast<double>(end - begin);
  return std::max(0.0, sq_sum / count - sum * sum / (count * count));
}

float ScanDensity::residual(Eigen::Index i, const Eigen::Vector3f& eye) const {
  const Eigen::Vector3f ray = samples_.col(i) - eye;
  const float sq_distance = ray.squaredNorm(), along = ray.dot(normals_.col(i));
  const float sq_projected = std::max(along * along, kScan.min_sq_cosine * sq_distance);  // (d cos a)^2
  // log(density d^2 / cos a) with cos a = sqrt(sq_projected) / d
  return log_density_[i] - 0.5f * std::log(sq_projected / (sq_distance * sq_distance * sq_distance));
}

double ScanDensity::unexplainedFrom(const Eigen::Vector3d& eye, Eigen::Index num_samples) const {
  const Eigen::Vector3f from = eye.cast<float>();
  return trimmedVariance(num_samples, [&](Eigen::Index i) { return residual(i, from); });
}

double ScanDensity::unexplained(const Eigen::Vector3d& viewpoint) const {
  if (!(ball_.radius > 0.0)) return std::numeric_limits<double>::infinity();
  return unexplainedFrom((viewpoint - ball_.center) / ball_.radius, samples_.cols());
}

double ScanDensity::unexplainedByPatches(const Eigen::Vector3d& viewpoint) const {
  const auto num_patches = std::min(kScan.density_patches, samples_.cols());
  const Eigen::Vector3f eye = ((viewpoint - ball_.center) / ball_.radius).cast<float>();
  std::vector<double> sums(num_patches, 0.0), counts(sums), means;
  std::vector<float> residuals;
  for (Eigen::Index i = 0; i < samples_.cols(); ++i) residuals.push_back(residual(i, eye));
  if (residuals.size() < kScan.fewest_density_samples) return std::numeric_limits<double>::infinity();
  const float middle = median(residuals);
  for (Eigen::Index i = 0; i < samples_.cols(); ++i) {
    Eigen::Index patch = 0;
    (samples_.leftCols(num_patches).colwise() - samples_.col(i)).colwise().squaredNorm().minCoeff(&patch);
    sums[patch] += std::clamp(residuals[i] - middle, -kScan.largest_residual, kScan.largest_residual);
    counts[patch] += 1.0;
  }
  double weight = 0.0, sum = 0.0, sq_sum = 0.0;
  for (std::size_t patch = 0; patch < sums.size(); ++patch) {
    weight += counts[patch];
    sum += sums[patch];
    sq_sum += sums[patch] * sums[patch] / counts[patch];
  }
  const double variance = sq_sum / weight - sum * sum / (weight * weight);
  return std::max(0.0, variance - static_cast<double>(num_patches) / static_cast<double>(num_points_));
}

bool ScanDensity::bulgesToward(const Eigen::Vector3d& viewpoint) const {
  const Eigen::Vector3f eye = ((viewpoint - ball_.center) / ball_.radius).cast<float>();
  Points toward = normalsToward(normals_, samples_, eye);
  toward.colwise() -= toward.rowwise().mean().eval();
  return toward.cwiseProduct(samples_).sum() > 0.0f;
}

double ScanDensity::varianceOf(Eigen::Index num_samples) const {
  return trimmedVariance(num_samples, [&](Eigen::Index i) { return log_density_[i]; });
}

ScanDensity::Candidate ScanDensity::refine(Candidate best, double first_step, double last_step,
                                           Eigen::Index num_samples) const {
  const auto rated = [&](const Eigen::Vector3d& direction, double log_distance) {
    Candidate candidate{direction.normalized(),
                        std::clamp(log_distance, std::log(kScan.min_distance), std::log(kScan.greatest_distance)), 0.0};
    candidate.unexplained = unexplainedFrom(candidate.eye(), num_samples);
    return candidate;
  };
  best = rated(best.direction, best.log_distance);
  for (double step = first_step; step >= last_step; step *= 0.5) {
    for (int move = 0; move < kScan.max_moves; ++move) {
      const Candidate start = best;
      const Eigen::Vector3d u = start.direction.unitOrthogonal(), v = start.direction.cross(u);
      for (const double sign : {-step, step}) {
        for (const Candidate& next : {rated(start.direction + sign * u, start.log_distance),
                                      rated(start.direction + sign * v, start.log_distance),
                                      rated(start.direction, start.log_distance + 2.0 * sign)})
          if (next.unexplained < best.unexplained) best = next;
      }
      if (best.unexplained == start.unexplained) break;
    }
  }
  return best;
}

/// Of the directions that leave the least variance unexplained, refines those that are not close to each other by the
/// coarse samples; none if all are hopeless.
std::vector<ScanDensity::Candidate> ScanDensity::coarseMinima(std::size_t max_count) const {
  std::vector<Candidate> coarse;
  for (const Eigen::Vector3d& direction : evenDirections(kScan.num_directions))
    coarse.push_back({direction, std::log(kScan.first_distance),
                      unexplainedFrom(kScan.first_distance * direction, kScan.coarse_density_samples)});
  sortAscending(coarse, &Candidate::unexplained);
  std::vector<Candidate> minima;
  if (!(coarse.front().unexplained < kScan.hopeless * (varianceOf(kScan.coarse_density_samples) + kScan.min_variance)))
    return minima;
  for (const Candidate& candidate : coarse) {
    const bool apart = std::all_of(minima.begin(), minima.end(), [&](const Candidate& start) {
      return start.direction.dot(candidate.direction) < kScan.min_apart;
    });
    if (apart) minima.push_back(candidate);
    if (minima.size() == max_count) break;
  }
  for (Candidate& start : minima)
    start = refine(start, kScan.first_step, kScan.middle_step, kScan.coarse_density_samples);
  return minima;
}

std::optional<Eigen::Vector3d> ScanDensity::bestViewpoint() const {
  if (samples_.cols() < static_cast<Eigen::Index>(kScan.fewest_density_samples)) return std::nullopt;
  const std::vector<Candidate> starts = coarseMinima(kScan.num_viewpoint_starts);
  if (starts.empty()) return std::nullopt;
  const auto best = std::min_element(starts.begin(), starts.end(), [](const Candidate& a, const Candidate& b) {
    return a.unexplained < b.unexplained;
  });
  const Eigen::Vector3d eye = refine(*best, kScan.middle_step, kScan.last_step, samples_.cols()).eye();
  return Eigen::Vector3d(ball_.center + ball_.radius * eye);
}

std::vector<Eigen::Vector3d> ScanDensity::viewpoints(double max_unexplained) const {
  std::vector<Eigen::Vector3d> found;
  if (samples_.cols() < static_cast<Eigen::Index>(kScan.fewest_density_samples)) return found;
  for (const Candidate& start : coarseMinima(kScan.max_viewpoints)) {
    const Candidate minimum = refine(start, kScan.middle_step, kScan.last_step, samples_.cols());
    if (minimum.unexplained <= max_unexplained) found.push_back(ball_.center + ball_.radius * minimum.eye());
  }
  return found;
}

}  // namespace pcl_symmetry
