#include "core/scan/scan_density.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/median.h"
#include "core/base/random.h"
#include "core/geometry/directions.h"
#include "pcl_symmetry/core/closest_point_search.h"

namespace pcl_symmetry {

namespace {

// points; chosen: bounds the time of the search tree to 5 ms. Half thins clouds that could be used whole, which adds
// noise to the density; twice takes twice the time.
constexpr std::size_t kMostPoints = 20'000;
// samples of the surface; chosen: half makes the angle of the viewpoint less certain, twice takes twice the time
constexpr std::size_t kNumSamples = 1500;
// samples that compare directions; chosen: half misses the best direction now and then, twice takes twice the time
constexpr Eigen::Index kNumCoarseSamples = 300;
// samples; chosen: fewer leave direction and distance to chance
constexpr std::size_t kFewestSamples = 20;

// Neighbours that give density and normal: a 600th of the points, within bounds. chosen: the log of the density has a
// variance of 1 over the number, so that half doubles its noise; twice rounds edges off and takes longer.
constexpr std::size_t kNeighbourhoods = 600;
constexpr std::size_t kFewestNeighbours = 12;  // chosen: see above
constexpr std::size_t kMostNeighbours = 32;    // chosen: see above
// thickness over width of a neighbourhood; chosen: beyond it there is no surface. Half leaves out noisy surfaces, twice
// keeps the points at which sheets meet.
constexpr float kThickest = 0.5f;

// width over length of a neighbourhood; chosen: below it there is a line. Half takes lines of few points for surfaces,
// twice leaves out surfaces that slant by 80 degrees.
constexpr float kThinnest = 0.05f;

// share of the samples at either end; chosen: edges and gaps, where the density means little, are fewer in most clouds.
// Half lets them in, twice hides a second view.
constexpr double kTrimmed = 0.1;
// square of the cosine of the steepest slant, 82 degrees; chosen: normals are not surer than that
constexpr float kLeastSqCosine = 0.02f;

// patches of the surface; chosen: of 23 samples each. Half joins surfaces of different directions, twice leaves more of
// the noise.
constexpr Eigen::Index kNumPatches = 64;
// of the log of the density; chosen: edges have more. Half hides a second view, twice lets edges decide.
constexpr float kLargestResidual = 1.0f;

// directions; chosen: 18 degrees apart, a quarter of the width of the minimum. Half misses narrow ones, twice takes
// twice the time.
constexpr int kNumDirections = 128;
// Share of the variance of the density. chosen: the search lowers what the best direction leaves by half at most. Half
// loses noisy scans, twice searches in vain in most whole clouds.
constexpr double kHopeless = 1.5;
constexpr int kNumStarts = 3;  // chosen: two miss a scan in fifty, more take more time
// chosen: minima are apart by 37 degrees, so that a dozen covers half of all directions; other numbers were not tried
constexpr std::size_t kMostViewpoints = 12;
// cosine between starts; chosen: those of one minimum are closer than 37 degrees
constexpr double kLeastApart = 0.8;
// radii; chosen: about where a camera stands that the object fills. The distance is searched from there.
constexpr double kFirstDistance = 4.0;
constexpr double kLeastDistance = 1.3;  // radii; derived: points lie within 75 degrees from 1.04 radii on, and room
// radii; chosen: rays from there differ by 2 degrees from parallel ones, less than the direction is certain by
constexpr double kGreatestDistance = 30.0;

// radians, and halves of the log of the distance: the steps of the search. chosen: from the distance between directions
// to half a degree, less than the error of the result
constexpr double kFirstStep = 0.2, kMiddleStep = 0.05, kLastStep = 0.0125;
constexpr int kMostMoves = 4;  // of one size; chosen: as many reach every place that the next size up has left open

/// \return \p size different numbers in [0, count), in random order.
std::vector<std::size_t> drawn(std::size_t count, std::size_t size) {
  std::vector<std::size_t> indices(count);
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  RandomStream random(0);
  for (std::size_t i = 0; i < size; ++i) std::swap(indices[i], indices[i + random.below(count - i)]);
  indices.resize(size);
  return indices;
}

/// The ellipse that the neighbours of a point cover.
struct Patch {
  Eigen::Vector3f normal;
  float log_density;  ///< less a constant of all patches
  bool is_surface;
};

Patch fitPatch(const Points& points, const int* neighbours, int count) {
  const Eigen::Vector3f first = points.col(neighbours[0]);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
  for (int k = 0; k < count; ++k) {
    const Eigen::Vector3f d = points.col(neighbours[k]) - first;
    sum += d;
    squares += d * d.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(squares - sum * sum.transpose() / static_cast<float>(count));
  const Eigen::Vector3f moments = solver.eigenvalues();
  // The area of the ellipse: unlike the distance to the last neighbour, the moments about the mean are hardly larger at
  // a border.
  const float area = std::sqrt(moments[1] * moments[2]);
  Patch patch{solver.eigenvectors().col(0), -std::log(area), false};
  patch.is_surface = patch.normal.allFinite() && std::isfinite(patch.log_density) &&
                     moments[1] > kThinnest * kThinnest * moments[2] &&
                     std::max(moments[0], 0.0f) < kThickest * kThickest * area;
  return patch;
}

}  // namespace

/// A viewpoint in radii about the center.
struct ScanDensity::Candidate {
  Eigen::Vector3d direction;
  double log_distance;
  double unexplained;

  Eigen::Vector3d eye() const { return std::exp(log_distance) * direction; }
};

ScanDensity::ScanDensity(const PointsRef& points) : ball_(boundingBall(points)) {
  if (points.cols() < static_cast<Eigen::Index>(kFewestSamples) || !(ball_.radius > 0.0)) return;
  const auto size = static_cast<std::size_t>(points.cols());
  const std::vector<std::size_t> indices = drawn(size, std::min(size, kMostPoints));
  Points used(3, static_cast<Eigen::Index>(indices.size()));
  for (Eigen::Index i = 0; i < used.cols(); ++i)
    used.col(i) = ((points.col(static_cast<Eigen::Index>(indices[i])).cast<double>() - ball_.center) / ball_.radius)
                      .cast<float>();
  num_points_ = used.cols();
  const auto num_samples = static_cast<Eigen::Index>(std::min(indices.size(), kNumSamples));
  const int count = static_cast<int>(
      std::min(indices.size(), 1 + std::clamp(indices.size() / kNeighbourhoods, kFewestNeighbours, kMostNeighbours)));
  std::vector<int> neighbours;
  std::vector<float> sq_distances;
  makeFlannSearch(used)->search(used.leftCols(num_samples), count, neighbours, sq_distances);

  samples_.resize(3, num_samples);
  normals_.resize(3, num_samples);
  for (Eigen::Index i = 0; i < num_samples; ++i) {
    const Patch patch = fitPatch(used, neighbours.data() + i * count, count);
    if (!patch.is_surface) continue;
    const auto slot = static_cast<Eigen::Index>(log_density_.size());
    samples_.col(slot) = used.col(i);
    normals_.col(slot) = patch.normal;
    log_density_.push_back(patch.log_density);
  }
  samples_.conservativeResize(3, static_cast<Eigen::Index>(log_density_.size()));
  normals_.conservativeResize(3, static_cast<Eigen::Index>(log_density_.size()));
}

template <typename Value>
double ScanDensity::trimmedVariance(Eigen::Index num_samples, const Value& value) const {
  const auto size = static_cast<std::size_t>(std::min(num_samples, samples_.cols()));
  if (size < kFewestSamples) return std::numeric_limits<double>::infinity();
  std::vector<float> values(size);
  for (std::size_t i = 0; i < size; ++i) values[i] = value(static_cast<Eigen::Index>(i));
  const auto trimmed = static_cast<std::ptrdiff_t>(kTrimmed * static_cast<double>(size));
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
  const float sq_projected = std::max(along * along, kLeastSqCosine * sq_distance);  // (d cos a)^2
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
  const auto num_patches = std::min(kNumPatches, samples_.cols());
  const Eigen::Vector3f eye = ((viewpoint - ball_.center) / ball_.radius).cast<float>();
  std::vector<double> sums(static_cast<std::size_t>(num_patches), 0.0), counts(sums), means;
  std::vector<float> residuals;
  for (Eigen::Index i = 0; i < samples_.cols(); ++i) residuals.push_back(residual(i, eye));
  if (residuals.size() < kFewestSamples) return std::numeric_limits<double>::infinity();
  const float middle = median(residuals);
  for (Eigen::Index i = 0; i < samples_.cols(); ++i) {
    Eigen::Index patch = 0;
    (samples_.leftCols(num_patches).colwise() - samples_.col(i)).colwise().squaredNorm().minCoeff(&patch);
    sums[patch] += std::clamp(residuals[i] - middle, -kLargestResidual, kLargestResidual);
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

double ScanDensity::variance() const {
  return varianceOf(samples_.cols());
}

double ScanDensity::varianceOf(Eigen::Index num_samples) const {
  return trimmedVariance(num_samples, [&](Eigen::Index i) { return log_density_[i]; });
}

ScanDensity::Candidate ScanDensity::climbed(Candidate best, double first_step, double last_step,
                                            Eigen::Index num_samples) const {
  const auto rated = [&](const Eigen::Vector3d& direction, double log_distance) {
    Candidate candidate{direction.normalized(),
                        std::clamp(log_distance, std::log(kLeastDistance), std::log(kGreatestDistance)), 0.0};
    candidate.unexplained = unexplainedFrom(candidate.eye(), num_samples);
    return candidate;
  };
  best = rated(best.direction, best.log_distance);
  for (double step = first_step; step >= last_step; step *= 0.5) {
    for (int move = 0; move < kMostMoves; ++move) {
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

/// Directions apart from each other that leave least, each climbed from by the coarse samples; none where all are
/// hopeless.
std::vector<ScanDensity::Candidate> ScanDensity::coarseMinima(std::size_t most) const {
  std::vector<Candidate> coarse;
  for (const Eigen::Vector3d& direction : evenDirections(kNumDirections))
    coarse.push_back(
        {direction, std::log(kFirstDistance), unexplainedFrom(kFirstDistance * direction, kNumCoarseSamples)});
  std::stable_sort(coarse.begin(), coarse.end(),
                   [](const Candidate& a, const Candidate& b) { return a.unexplained < b.unexplained; });
  std::vector<Candidate> minima;
  if (!(coarse.front().unexplained < kHopeless * (varianceOf(kNumCoarseSamples) + kLeastVariance))) return minima;
  for (const Candidate& candidate : coarse) {
    const bool apart = std::all_of(minima.begin(), minima.end(), [&](const Candidate& start) {
      return start.direction.dot(candidate.direction) < kLeastApart;
    });
    if (apart) minima.push_back(candidate);
    if (minima.size() == most) break;
  }
  for (Candidate& start : minima) start = climbed(start, kFirstStep, kMiddleStep, kNumCoarseSamples);
  return minima;
}

std::optional<Eigen::Vector3d> ScanDensity::bestViewpoint() const {
  if (samples_.cols() < static_cast<Eigen::Index>(kFewestSamples)) return std::nullopt;
  const std::vector<Candidate> starts = coarseMinima(kNumStarts);
  if (starts.empty()) return std::nullopt;
  const auto best = std::min_element(starts.begin(), starts.end(), [](const Candidate& a, const Candidate& b) {
    return a.unexplained < b.unexplained;
  });
  const Eigen::Vector3d eye = climbed(*best, kMiddleStep, kLastStep, samples_.cols()).eye();
  return Eigen::Vector3d(ball_.center + ball_.radius * eye);
}

std::vector<Eigen::Vector3d> ScanDensity::viewpoints(double most_unexplained) const {
  std::vector<Eigen::Vector3d> found;
  if (samples_.cols() < static_cast<Eigen::Index>(kFewestSamples)) return found;
  for (const Candidate& start : coarseMinima(kMostViewpoints)) {
    const Candidate minimum = climbed(start, kMiddleStep, kLastStep, samples_.cols());
    if (minimum.unexplained <= most_unexplained) found.push_back(ball_.center + ball_.radius * minimum.eye());
  }
  return found;
}

}  // namespace pcl_symmetry
