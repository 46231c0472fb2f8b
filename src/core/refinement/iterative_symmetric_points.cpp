#include "pcl_symmetry/core/refinement/iterative_symmetric_points.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/check.h"
#include "core/base/parallel.h"

namespace pcl_symmetry {

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

ReflectionPlane stepReflectionPlane(const PointsRef& x, const PointsRef& y, const PointsRef& x_normals,
                                    const PointsRef& y_normals, const std::vector<double>& weights,
                                    const ReflectionPlane& plane) {
  constexpr double kLeastStiffness = 1e-3;  // of the stiffest direction; the surface leaves softer ones free
  constexpr double kLongestStep = 0.2;      // radians, or times the extent of the samples
  const Eigen::Vector3d n = plane.normal(), u = n.unitOrthogonal(), v = n.cross(u);
  double sum = 0.0, sq_extent = 0.0;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    middle += weights[i] * x.col(i).cast<double>();
    sum += weights[i];
  }
  if (!(sum > 0.0)) return plane;
  middle /= sum;
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    sq_extent += weights[i] * (x.col(i).cast<double>() - middle).squaredNorm() / sum;
  const double extent = std::sqrt(sq_extent);
  if (!(extent > 0.0)) return plane;

  // Unknowns: n moves by (a u + b v), the plane's distance from the middle of the samples by extent * c.
  const double offset = plane.offset() - n.dot(middle);
  Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    if (weights[i] == 0.0) continue;
    const Eigen::Vector3d p = x.col(i).cast<double>() - middle, q = y.col(i).cast<double>() - middle;
    const double height = n.dot(p) - offset;
    const Eigen::Vector3d x_normal = x_normals.col(i).cast<double>(), y_normal = y_normals.col(i).cast<double>();
    const Eigen::Vector3d turned = x_normal - 2.0 * n.dot(x_normal) * n;
    const double cosine = turned.dot(y_normal);
    const Eigen::Vector3d m = (y_normal + (cosine < 0.0 ? -turned : turned)).normalized();
    const double m_n = m.dot(n), weight = weights[i] * cosine * cosine;
    const Eigen::Vector3d slope(-2.0 * (u.dot(p) * m_n + height * m.dot(u)),
                                -2.0 * (v.dot(p) * m_n + height * m.dot(v)), 2.0 * extent * m_n);
    h.selfadjointView<Eigen::Lower>().rankUpdate(slope, weight);
    g += weight * m.dot(p - 2.0 * height * n - q) * slope;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(h);  // reads the lower half
  const Eigen::Vector3d& stiffness = solver.eigenvalues();         // ascending
  int num_soft = 0;
  while (num_soft < 3 && !(stiffness[num_soft] > kLeastStiffness * stiffness[2])) ++num_soft;
  Eigen::Vector3d step = Eigen::Vector3d::Zero();
  for (int i = num_soft; i < 3; ++i)
    step -= solver.eigenvectors().col(i) * (solver.eigenvectors().col(i).dot(g) / stiffness[i]);
  if (num_soft > 0) {
    h.setZero();
    g.setZero();
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      const Eigen::Vector3d p = x.col(i).cast<double>() - middle, q = y.col(i).cast<double>() - middle;
      const double height = n.dot(p) - offset;
      Eigen::Matrix3d slopes;  // of the reflected point
      slopes.col(0) = -2.0 * (u.dot(p) * n + height * u);
      slopes.col(1) = -2.0 * (v.dot(p) * n + height * v);
      slopes.col(2) = 2.0 * extent * n;
      h += weights[i] * slopes.transpose() * slopes;
      g += weights[i] * slopes.transpose() * (p - 2.0 * height * n - q);
    }
    const Eigen::Matrix3Xd soft = solver.eigenvectors().leftCols(num_soft);
    const Eigen::MatrixXd reduced = soft.transpose() * h * soft;
    step -= soft * reduced.completeOrthogonalDecomposition().solve(soft.transpose() * g);
  }
  const double length = step.norm();
  if (!std::isfinite(length)) return plane;
  if (length > kLongestStep) step *= kLongestStep / length;
  const Eigen::Vector3d normal = (n + step[0] * u + step[1] * v).normalized();
  return ReflectionPlane(normal, normal.dot(middle) + offset + step[2] * extent);
}

IspStep iterateSymmetricPoints(const IspSurface& surface, const std::vector<int>& samples, const ReflectionPlane& plane,
                               double sigma, IspUpdate update, const std::vector<int>* guesses) {
  const auto size = static_cast<Eigen::Index>(samples.size());
  IspStep step;
  Points x(3, size), reflected(3, size), y(3, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    x.col(i) = surface.points.col(samples[i]);
    reflected.col(i) = plane.reflect(x.col(i).cast<double>()).cast<float>();
  }
  constexpr std::size_t kBlockSize = 1024;
  constexpr double kReach = 3.0;  // sigmas: beyond, weights are below 1.3e-4
  step.closest.assign(samples.size(), -1);
  step.sq_distances.assign(samples.size(), std::numeric_limits<float>::infinity());
  const float bound = surface.far ? surface.far->bound(kReach * sigma) : 0.0f;
  const auto sq_reach = static_cast<float>(kReach * kReach * sigma * sigma);
  parallelRanges(samples.size(), kBlockSize, surface.num_threads, [&](std::size_t begin, std::size_t end) {
    std::vector<Eigen::Index> near;
    for (std::size_t i = begin; i < end; ++i)
      if (!surface.far || !(*surface.far)(reflected.col(i).cast<double>(), bound)) near.push_back(i);
    Points queries(3, near.size());
    for (std::size_t i = 0; i < near.size(); ++i) queries.col(i) = reflected.col(near[i]);
    std::vector<int> closest(near.size(), -1);
    std::vector<float> sq_distances;
    if (guesses)
      for (std::size_t i = 0; i < near.size(); ++i) closest[i] = (*guesses)[near[i]];
    surface.search.searchWithin(queries, sq_reach, closest, sq_distances);
    for (std::size_t i = 0; i < near.size(); ++i) {
      step.closest[near[i]] = closest[i];
      step.sq_distances[near[i]] = sq_distances[i];
    }
  });
  std::vector<double> weights(samples.size());
  double sum = 0.0, sq_sum = 0.0;
  for (Eigen::Index i = 0; i < size; ++i) {
    const bool matched = step.closest[i] >= 0;
    y.col(i) = reflected.col(i);
    if (!matched) continue;
    y.col(i) = surface.points.col(step.closest[i]);
    if (surface.at_border && (*surface.at_border)[step.closest[i]]) continue;
    weights[i] = std::exp(-step.sq_distances[i] / (sigma * sigma));
    sum += weights[i];
    sq_sum += weights[i] * step.sq_distances[i];
  }
  step.residual = sum > 0.0 ? std::sqrt(sq_sum / sum) : 0.0;
  step.weight = size > 0 ? sum / static_cast<double>(size) : 0.0;
  if (update == IspUpdate::PointToPoint) {
    step.plane = fitReflectionPlane(x, y, weights, plane);
  } else {
    Points x_normals(3, size), y_normals(3, size);
    for (Eigen::Index i = 0; i < size; ++i) {
      x_normals.col(i) = surface.normals.col(samples[i]);
      y_normals.col(i) = surface.normals.col(step.closest[i] >= 0 ? step.closest[i] : samples[i]);
    }
    step.plane = stepReflectionPlane(x, y, x_normals, y_normals, weights, plane);
  }
  return step;
}

IspResult refineSymmetricPoints(const IspSurface& surface, const std::vector<int>& samples,
                                const ReflectionPlane& plane, const IspOptions& options) {
  constexpr double kRest = 0.1;  // sigmas
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
    // Narrower weights only where the plane has come to rest at these: it must not lose what it moves towards.
    if (moved + angle * extent <= kRest * sigma) sigma = std::max(options.final_sigma, 0.5 * sigma);
  }
  return result;
}

}  // namespace pcl_symmetry
