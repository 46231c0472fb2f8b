#include "pcl_symmetry/core/iterative_symmetric_points.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/base/simd.h"
#include "core/detection/detection_rules.h"
#include "core/detection/far_test.h"
#include "core/detection/plane_fit.h"
#include "core/detection/step_equations.h"
#include "core/geometry/point_samples.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

namespace {

/// Mean and extent of weighted points.
struct WeightedExtent {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double extent = 0.0;  ///< root mean square distance from the middle; 0 where all weights are 0

  WeightedExtent(const PointsRef& x, const std::vector<double>& weights) {
    double sum = 0.0, sq_extent = 0.0;
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      middle += weights[i] * x.col(i).cast<double>();
      sum += weights[i];
    }
    if (!(sum > 0.0)) return;
    middle /= sum;
    for (Eigen::Index i = 0; i < x.cols(); ++i)
      sq_extent += weights[i] * (x.col(i).cast<double>() - middle).squaredNorm() / sum;
    extent = std::sqrt(sq_extent);
  }
};

/// Three coordinates of a point to an index of a block.
template <typename Column>
void put(const Column& from, PairBlock::Coordinates& to, int place) {
  for (int k = 0; k < 3; ++k) to[k][place] = static_cast<double>(from[k]);
}

/// Adds the terms of all pairs with a weight, in their order.
/// \param fill fill(i, block, index) writes the points and normals of pair i to an index of a block.
/// \param terms_of terms_of(block, terms) works out what the pairs of a block add.
template <typename Fill, typename TermsOf>
void addAll(StepEquations& equations, const std::vector<double>& weights, const Fill& fill, const TermsOf& terms_of) {
  PairBlock block;
  StepTerms terms;
  const auto use = [&] {
    terms_of(block, terms);
    equations.add(terms);
    block.size = 0;
  };
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] == 0.0) continue;
    block.weights[block.size] = weights[i];
    fill(static_cast<Eigen::Index>(i), block, block.size++);
    if (block.size == PairBlock::kMost) use();
  }
  if (block.size > 0) use();
}

/// The plane after one Gauss-Newton step on sum w (m . (x' - y))^2, where m is the mean direction of the normal at y
/// and the reflected normal at x.
///
/// Directions that this leaves free (a flat piece of surface is uninformative about planes across it) move by a step on
/// sum w |x' - y|^2. Departure from the paper, which minimizes the latter alone: it needs many more iterations.
/// \param fill writes the pairs, see addAll().
template <typename Fill>
ReflectionPlane steppedPlane(const PointsRef& x, const std::vector<double>& weights, const ReflectionPlane& plane,
                             const Fill& fill) {
  const WeightedExtent samples(x, weights);
  if (!(samples.extent > 0.0)) return plane;
  StepEquations across(plane, samples.middle, samples.extent);
  addAll(across, weights, fill, [&](const PairBlock& block, StepTerms& terms) { across.pointToPlane(block, terms); });
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(across.h);  // reads the lower half
  const Eigen::Vector3d& stiffness = solver.eigenvalues();                // ascending
  int num_soft = 0;
  while (num_soft < 3 && !(stiffness[num_soft] > kDetection.isp.least_stiffness * stiffness[2])) ++num_soft;
  Eigen::Vector3d step = Eigen::Vector3d::Zero();
  for (int i = num_soft; i < 3; ++i)
    step -= solver.eigenvectors().col(i) * (solver.eigenvectors().col(i).dot(across.g) / stiffness[i]);
  if (num_soft > 0) {
    StepEquations whole(plane, samples.middle, samples.extent);
    addAll(whole, weights, fill, [&](const PairBlock& block, StepTerms& terms) { whole.pointToPoint(block, terms); });
    const Eigen::Matrix3Xd soft = solver.eigenvectors().leftCols(num_soft);
    const Eigen::MatrixXd reduced = soft.transpose() * whole.h * soft;
    step -= soft * reduced.completeOrthogonalDecomposition().solve(soft.transpose() * whole.g);
  }
  const double length = step.norm();
  if (!std::isfinite(length)) return plane;
  if (length > kDetection.isp.longest_step) step *= kDetection.isp.longest_step / length;
  return across.moved(step);
}

/// The closest points to the reflections, where there are any within reach of the weights: FLANN's, unless the caller
/// has a search of its own.
IspStep matchReflections(const IspSurface& surface, const Points& reflected, double sigma,
                         const std::vector<int>* guesses) {
  IspStep step;
  ClosestPoints found = closestWithin(surface, reflected, kDetection.isp.reach_sigmas * sigma, guesses, true);
  step.closest = std::move(found.indices);
  step.sq_distances = std::move(found.sq_distances);
  return step;
}

/// Reflects points, as ReflectionPlane::reflect() does.
/// \param points,reflected three coordinates each.
PCL_SYMMETRY_MULTIVERSION
void reflectAll(const float* points, Eigen::Index size, const double* normal, double offset, float* reflected) {
  const double n0 = normal[0], n1 = normal[1], n2 = normal[2];
#pragma GCC ivdep
  for (Eigen::Index i = 0; i < size; ++i) {
    const double x0 = points[3 * i], x1 = points[3 * i + 1], x2 = points[3 * i + 2];
    const double twice = 2.0 * (n0 * x0 + n1 * x1 + n2 * x2 - offset);
    reflected[3 * i] = static_cast<float>(x0 - twice * n0);
    reflected[3 * i + 1] = static_cast<float>(x1 - twice * n1);
    reflected[3 * i + 2] = static_cast<float>(x2 - twice * n2);
  }
}

Points reflections(const Points& points, const ReflectionPlane& plane) {
  Points reflected(3, points.cols());
  reflectAll(points.data(), points.cols(), plane.normal().data(), plane.offset(), reflected.data());
  return reflected;
}

/// Weight of a pair by what the scanner saw where the reflection lies, in [0, 1].
///
/// A departure from the paper, whose pairs all pull: many partners of a scan's points are hidden. The closest points,
/// taken instead, draw a plane away from the symmetry, to where more of what was seen overlaps.
double seenWeight(const Visibility* visibility, const Eigen::Vector3d& reflection, double sigma) {
  if (!visibility) return 1.0;
  const double depth = std::max(0.0, visibility->depthBehind(reflection)) / (kDetection.isp.hidden_depth * sigma);
  return std::exp(-depth * depth);
}

/// The pairs of samples and closest points to their reflections, before the plane moves.
struct WeightedPairs {
  Points x, y;
  std::vector<double> weights;
  IspStep step;  ///< of the plane itself

  WeightedPairs(const IspSurface& surface, const std::vector<int>& samples, const ReflectionPlane& plane, double sigma,
                const std::vector<int>* guesses)
      : x(pointsAt(surface.points, samples)), y(reflections(x, plane)), weights(samples.size()) {
    step = matchReflections(surface, y, sigma, guesses);
    step.plane = plane;
    double sum = 0.0, sq_sum = 0.0;
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      if (step.closest[i] < 0) continue;
      const Eigen::Vector3d reflection = y.col(i).cast<double>();
      y.col(i) = surface.points.col(step.closest[i]);
      if (surface.at_border && (*surface.at_border)[step.closest[i]]) continue;
      weights[i] =
          std::exp(-step.sq_distances[i] / (sigma * sigma)) * seenWeight(surface.visibility, reflection, sigma);
      sum += weights[i];
      sq_sum += weights[i] * step.sq_distances[i];
    }
    step.residual = sum > 0.0 ? std::sqrt(sq_sum / sum) : 0.0;
    step.weight = x.cols() > 0 ? sum / static_cast<double>(x.cols()) : 0.0;
  }
};

}  // namespace

void IspOptions::validate() const {
  check(std::isfinite(sigma) && sigma > 0.0, "sigma", sigma, "finite and > 0");
  check(final_sigma > 0.0 && final_sigma <= sigma, "final_sigma", final_sigma, "in (0, sigma]");
  check(max_iterations >= 1, "max_iterations", max_iterations, ">= 1");
  check(tolerance >= 0.0, "tolerance", tolerance, ">= 0");
  check(error_share >= 0.0, "error_share", error_share, ">= 0");
}

ReflectionPlane fitReflectionPlane(const PointsRef& x, const PointsRef& y, const std::vector<double>& weights,
                                   const ReflectionPlane& fallback) {
  double sum = 0.0;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    middle += 0.5 * weights[i] * (x.col(i) + y.col(i)).cast<double>();
    sum += weights[i];
  }
  if (!(sum > 0.0)) return fallback;
  middle /= sum;
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const Eigen::Vector3d p = x.col(i).cast<double>() - middle, q = y.col(i).cast<double>() - middle;
    a += weights[i] * p * q.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(0.5 * (a + a.transpose()));
  const Eigen::Vector3d normal = solver.eigenvectors().col(0);
  return ReflectionPlane(normal, normal.dot(middle));
}

IspStep iterateSymmetricPoints(const IspSurface& surface, const std::vector<int>& samples, const ReflectionPlane& plane,
                               double sigma, IspUpdate update, const std::vector<int>* guesses) {
  WeightedPairs pairs(surface, samples, plane, sigma, guesses);
  IspStep& step = pairs.step;
  if (update == IspUpdate::PointToPoint) {
    step.plane = fitReflectionPlane(pairs.x, pairs.y, pairs.weights, plane);
    return std::move(step);
  }
  const auto fill = [&](Eigen::Index i, PairBlock& block, int place) {
    put(pairs.x.col(i), block.x, place);
    put(pairs.y.col(i), block.y, place);
    put(surface.normals.col(samples[i]), block.x_normals, place);
    put(surface.normals.col(step.closest[i]), block.y_normals, place);
  };
  step.plane = steppedPlane(pairs.x, pairs.weights, plane, fill);
  return std::move(step);
}

IspStep matchReflectionsOnly(const IspSurface& surface, const std::vector<int>& samples, const ReflectionPlane& plane,
                             double sigma, const std::vector<int>* guesses) {
  const Points reflected = reflections(pointsAt(surface.points, samples), plane);
  return matchReflections(surface, reflected, sigma, guesses);
}

IspStep matchSymmetricPoints(const IspSurface& surface, const std::vector<int>& samples, const ReflectionPlane& plane,
                             double sigma, const std::vector<int>* guesses) {
  return WeightedPairs(surface, samples, plane, sigma, guesses).step;
}

IspResult refineSymmetricPoints(const IspSurface& surface, const std::vector<int>& samples,
                                const ReflectionPlane& plane, const IspOptions& options) {
  options.validate();
  const double size = static_cast<double>(samples.size());
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const int i : samples) middle += surface.points.col(i).cast<double>() / size;
  double sq_extent = 0.0;
  for (const int i : samples) sq_extent += (surface.points.col(i).cast<double>() - middle).squaredNorm() / size;
  const double extent = std::sqrt(sq_extent);

  IspResult result;
  result.plane = plane;
  double sigma = options.sigma;
  while (result.iterations < options.max_iterations && !result.converged) {
    const std::vector<int> before = std::move(result.last.closest);
    result.last = iterateSymmetricPoints(surface, samples, result.plane, sigma, options.update,
                                         before.empty() ? nullptr : &before);
    ++result.iterations;
    const ReflectionPlane& next = result.last.plane;
    const double moved =
        std::abs(std::abs(next.signedDistance(middle)) - std::abs(result.plane.signedDistance(middle)));
    const double angle = next.angleTo(result.plane);
    const double tolerance = options.tolerance * extent + options.error_share * result.last.residual / std::sqrt(size);
    result.converged = sigma == options.final_sigma && moved <= tolerance && angle * extent <= tolerance;
    result.plane = next;
    // Narrower weights only where the plane has come to rest at these: it must not lose what it moves toward.
    if (moved + angle * extent <= kDetection.isp.rest_sigmas * sigma)
      sigma = std::max(options.final_sigma, 0.5 * sigma);
  }
  return result;
}

}  // namespace pcl_symmetry
