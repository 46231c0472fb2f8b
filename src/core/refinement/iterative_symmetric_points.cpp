#include "core/refinement/iterative_symmetric_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/check.h"
#include "core/base/symmetric_solvers.h"
#include "core/geometry/plane_chart.h"
#include "core/geometry/point_samples.h"
#include "core/refinement/refinement_rules.h"

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

/// Weight of a pair by the visibility of the reflection, in [0, 1].
///
/// Departure from the paper: its pairs all have full weight, but many partners of a scan's points are hidden. The
/// closest points, used instead, would draw a plane away from the symmetry, to where more of the visible surface
/// overlaps.
double seenWeight(const Visibility* visibility, const Eigen::Vector3d& reflection, double sigma) {
  if (!visibility) return 1.0;
  const double depth = std::max(0.0, visibility->depthBehind(reflection)) / (kRefinement.hidden_depth * sigma);
  return std::exp(-depth * depth);
}

/// Pairs of samples and the closest points to their reflections, before the plane moves.
struct WeightedPairs {
  Points x, y;  ///< y is 0, with no weight, if a sample has no partner
  std::vector<double> weights;
  IspStep step;  ///< step that leaves the plane as it is

  WeightedPairs(const IspSurface& surface, const std::vector<int>& samples, const ReflectionPlane& plane, double sigma,
                const std::vector<int>* guesses)
      : x(pointsAt(surface.points, samples)), y(Points::Zero(3, x.cols())), weights(samples.size()) {
    Landing landing = land(surface, reflectedPoints(x, plane), kRefinement.reach_sigmas * sigma, guesses, true);
    step.plane = plane;
    step.closest = std::move(landing.closest);
    step.sq_distances = std::move(landing.sq_distances);
    double sum = 0.0, sq_sum = 0.0;
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      if (step.closest[i] < 0) continue;
      y.col(i) = surface.points.col(step.closest[i]);
      if (surface.at_border && (*surface.at_border)[step.closest[i]]) continue;
      weights[i] = std::exp(-step.sq_distances[i] / (sigma * sigma)) *
                   seenWeight(surface.visibility, landing.images.col(i).cast<double>(), sigma);
      sum += weights[i];
      sq_sum += weights[i] * step.sq_distances[i];
    }
    step.residual = sum > 0.0 ? std::sqrt(sq_sum / sum) : 0.0;
    step.weight = x.cols() > 0 ? sum / static_cast<double>(x.cols()) : 0.0;
  }
};

/// Normal equations of a plane's step, in the parameters of its chart.
struct StepEquations {
  PlaneChart at;
  Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
  Eigen::Vector3d g = Eigen::Vector3d::Zero();

  /// Adds w (m . (x' - y))^2 of a pair, where m is the mean direction of the normal at y and the reflected normal at x.
  void addPointToPlane(const Eigen::Vector3d& x, const Eigen::Vector3d& y, const Eigen::Vector3d& x_normal,
                       const Eigen::Vector3d& y_normal, double pair_weight) {
    const Eigen::Vector3d p = x - at.pivot, q = y - at.pivot;
    const double height = at.n.dot(p) - at.offset;
    const Eigen::Vector3d reflected = x_normal - 2.0 * at.n.dot(x_normal) * at.n;
    const double cosine = reflected.dot(y_normal);
    const Eigen::Vector3d m = (y_normal + (cosine < 0.0 ? -reflected : reflected)).normalized();
    const Eigen::Vector3d slope = at.slope(p, height, m);
    const double weight = pair_weight * cosine * cosine;
    h += slope * (weight * slope).transpose();
    g += weight * m.dot(p - 2.0 * height * at.n - q) * slope;
  }

  /// Adds w |x' - y|^2 of a pair.
  void addPointToPoint(const Eigen::Vector3d& x, const Eigen::Vector3d& y, double weight) {
    const Eigen::Vector3d p = x - at.pivot, q = y - at.pivot;
    const double height = at.n.dot(p) - at.offset;
    const Eigen::Vector3d miss = p - 2.0 * height * at.n - q;
    const std::array<Eigen::Vector3d, 3> slopes{-2.0 * (at.u.dot(p) * at.n + height * at.u),
                                                -2.0 * (at.v.dot(p) * at.n + height * at.v), 2.0 * at.extent * at.n};
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d weighted = weight * slopes[i];
      for (int j = 0; j < 3; ++j) h(i, j) += weighted.dot(slopes[j]);
      g[i] += weighted.dot(miss);
    }
  }
};

/// The plane after one Gauss-Newton step on sum w (m . (x' - y))^2.
///
/// Directions that this leaves unconstrained (a flat piece of surface is uninformative about planes perpendicular to
/// it) move by a step on sum w |x' - y|^2. Departure from the paper: it minimizes only the latter, which needs many
/// more iterations.
ReflectionPlane steppedPlane(const IspSurface& surface, const std::vector<int>& samples, const WeightedPairs& pairs) {
  const ReflectionPlane& plane = pairs.step.plane;
  const WeightedExtent extent(pairs.x, pairs.weights);
  if (!(extent.extent > 0.0)) return plane;
  const PlaneChart chart(plane, extent.middle, extent.extent);
  StepEquations across{chart};
  for (Eigen::Index i = 0; i < pairs.x.cols(); ++i) {
    if (pairs.weights[i] == 0.0) continue;
    const Eigen::Vector3d x_normal = surface.normals.col(samples[i]).cast<double>(),
                          y_normal = surface.normals.col(pairs.step.closest[i]).cast<double>();
    across.addPointToPlane(pairs.x.col(i).cast<double>(), pairs.y.col(i).cast<double>(), x_normal, y_normal,
                           pairs.weights[i]);
  }
  const SymmetricEigen<Eigen::Matrix3d> solver(across.h);
  const Eigen::Vector3d& stiffness = solver.eigenvalues();  // ascending
  int num_soft = 0;
  while (num_soft < 3 && !(stiffness[num_soft] > kRefinement.min_stiffness * stiffness[2])) ++num_soft;
  Eigen::Vector3d step = -solver.solve(across.g, kRefinement.min_stiffness);
  if (num_soft > 0) {
    StepEquations whole{chart};
    for (Eigen::Index i = 0; i < pairs.x.cols(); ++i)
      if (pairs.weights[i] != 0.0)
        whole.addPointToPoint(pairs.x.col(i).cast<double>(), pairs.y.col(i).cast<double>(), pairs.weights[i]);
    Eigen::Matrix3d soft = Eigen::Matrix3d::Zero();  // projects onto the directions that \p across leaves unconstrained
    for (int i = 0; i < num_soft; ++i) soft += solver.eigenvectors().col(i) * solver.eigenvectors().col(i).transpose();
    step -= SymmetricEigen<Eigen::Matrix3d>(soft * whole.h * soft).solve(soft * whole.g, 1e-12);
  }
  const double length = step.norm();
  if (!std::isfinite(length)) return plane;
  if (length > kRefinement.longest_step) step *= kRefinement.longest_step / length;
  return chart.moved(step);
}

}  // namespace

void IspOptions::validate() const {
  check(std::isfinite(sigma) && sigma > 0.0, "sigma", sigma, "finite and > 0");
  check(final_sigma > 0.0 && final_sigma <= sigma, "final_sigma", final_sigma, "in (0, sigma]");
  check(max_iterations >= 1, "max_iterations", max_iterations, ">= 1");
  check(settled_errors >= 0.0, "settled_errors", settled_errors, ">= 0");
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
  const SymmetricEigen<Eigen::Matrix3d> solver(0.5 * (a + a.transpose()));
  const Eigen::Vector3d normal = solver.eigenvectors().col(0);
  return ReflectionPlane(normal, normal.dot(middle));
}

IspStep iterateSymmetricPoints(const IspSurface& surface, const std::vector<int>& samples, const ReflectionPlane& plane,
                               double sigma, IspUpdate update, const std::vector<int>* guesses) {
  WeightedPairs pairs(surface, samples, plane, sigma, guesses);
  pairs.step.plane = update == IspUpdate::PointToPoint ? fitReflectionPlane(pairs.x, pairs.y, pairs.weights, plane)
                                                       : steppedPlane(surface, samples, pairs);
  return std::move(pairs.step);
}

IspStep matchSymmetricPoints(const IspSurface& surface, const std::vector<int>& samples, const ReflectionPlane& plane,
                             double sigma, const std::vector<int>* guesses) {
  return WeightedPairs(surface, samples, plane, sigma, guesses).step;
}

IspResult refineSymmetricPoints(const IspSurface& surface, const std::vector<int>& samples,
                                const ReflectionPlane& plane, const IspOptions& options,
                                const std::function<bool(const ReflectionPlane&)>& stays) {
  options.validate();
  const WeightedExtent whole(pointsAt(surface.points, samples), std::vector<double>(samples.size(), 1.0));
  const double root_size = std::sqrt(static_cast<double>(samples.size()));
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
        std::abs(std::abs(next.signedDistance(whole.middle)) - std::abs(result.plane.signedDistance(whole.middle)));
    const double angle = next.angleTo(result.plane);
    const double tolerance =
        kRefinement.stands_still * whole.extent + options.settled_errors * result.last.residual / root_size;
    result.converged = sigma == options.final_sigma && moved <= tolerance && angle * whole.extent <= tolerance;
    result.plane = next;
    if (stays && !stays(next)) break;
    // The weights become narrower only when the plane is at rest at the current width: it must not lose its target.
    if (moved + angle * whole.extent <= kRefinement.rest_sigmas * sigma)
      sigma = std::max(options.final_sigma, 0.5 * sigma);
  }
  return result;
}

}  // namespace pcl_symmetry
