#include "core/evidence/point_density.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/base/symmetric_solvers.h"
#include "core/evidence/surface_samples.h"
#include "core/geometry/plane_chart.h"
#include "core/geometry/point_samples.h"
#include "pcl_symmetry/core/gaussian_edt.h"

namespace pcl_symmetry {

namespace {

/// The three ways to combine quarters into two halves.
constexpr std::array<std::array<int, 4>, 3> kPairings{{{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}}};

/// Two halves of points, drawn at random.
std::pair<Points, Points> halvesOf(const Points& points, std::uint64_t seed) {
  const Eigen::Index size = points.cols();
  std::vector<int> second = drawSamples(size, static_cast<int>(size / 2), seed), first;
  std::sort(second.begin(), second.end());
  const std::vector<int> all = allIndices(size);
  std::set_difference(all.begin(), all.end(), second.begin(), second.end(), std::back_inserter(first));
  return {pointsAt(points, first), pointsAt(points, second)};
}

Points joined(const Points& a, const Points& b) {
  Points all(3, a.cols() + b.cols());
  all << a, b;
  return all;
}

/// \return 1 minus the correlation of two distance transforms, in [0, 1].
double lost(const GaussianEdt& a, const GaussianEdt& b) {
  const double product = std::inner_product(a.values().begin(), a.values().end(), b.values().begin(), 0.0);
  return 1.0 - std::clamp(product / std::sqrt(a.sqNorm() * b.sqNorm()), 0.0, 1.0);
}

/// A cell, and the weights of its lower and upper corner along each axis.
struct CellPosition {
  Eigen::Array3i cell;
  Eigen::Array3f t;  ///< in [0, 1), from the lower corner to the upper one

  explicit CellPosition(const Eigen::Array3f& cells) : cell(cells.cast<int>()), t(cells - cell.cast<float>()) {}
};

std::vector<float> gaussianKernel(double deviation, int reach) {
  std::vector<float> kernel(2 * reach + 1);
  double sum = 0.0;
  for (int k = -reach; k <= reach; ++k) sum += std::exp(-0.5 * k * k / (deviation * deviation));
  for (int k = -reach; k <= reach; ++k)
    kernel[k + reach] = static_cast<float>(std::exp(-0.5 * k * k / (deviation * deviation)) / sum);
  return kernel;
}

/// A function of three numbers near 0: value, slopes and curvatures, from differences.
struct Quadric {
  Eigen::Vector3d gradient;
  Eigen::Matrix3d hessian;

  template <typename Function>
  Quadric(const Function& function, double at_zero, double step) {
    for (int a = 0; a < 3; ++a) {
      const Eigen::Vector3d e = step * Eigen::Vector3d::Unit(a);
      const double up = function(e), down = function(-e);
      gradient[a] = (up - down) / (2.0 * step);
      hessian(a, a) = (up + down - 2.0 * at_zero) / (step * step);
    }
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < a; ++b) {
        const Eigen::Vector3d e = step * Eigen::Vector3d::Unit(a), f = step * Eigen::Vector3d::Unit(b);
        hessian(a, b) = hessian(b, a) =
            (function(e + f) - function(e - f) - function(f - e) + function(-e - f)) / (4.0 * step * step);
      }
    }
  }

  /// A Newton step upwards along every axis, also where the density curves upwards.
  Eigen::Vector3d stepUp() const {
    const SymmetricEigen<Eigen::Matrix3d> solver(hessian);
    Eigen::Vector3d step = Eigen::Vector3d::Zero();
    const double min_curvature = kEvidence.min_curvature * solver.eigenvalues().cwiseAbs().maxCoeff();
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d axis = solver.eigenvectors().col(k);
      step += axis * axis.dot(gradient) / std::max(std::abs(solver.eigenvalues()[k]), min_curvature);
    }
    return step;
  }
};

}  // namespace

SplitSurface::SplitSurface(const Points& points, std::uint64_t seed, int num_threads) : seed_(seed) {
  std::tie(first_, second_) = halvesOf(points, seed);
  search_ = makeFlannSearch(second_);
  samples_ = surfaceSamples(second_, localGeometry(second_, *search_, num_threads));
}

std::vector<float> SplitSurface::reflectedDistances(const ReflectionPlane& plane) const {
  return distances(reflectedPoints(first_, plane));
}

double SplitSurface::ownScore(int num_cells, double sigma, const BoundingBall& ball, int num_threads) const {
  const auto edt = [&](const Points& points) {
    return GaussianEdt(points, {num_cells, sigma, num_threads, ball.radius, ball.center});
  };
  // Quarters are drawn anew, because successive points of a file may be neighbors.
  const auto [a1, a2] = halvesOf(first_, seed_);
  const auto [b1, b2] = halvesOf(second_, seed_);
  const std::array<Points, 4> quarters{a1, a2, b1, b2};
  const std::array<GaussianEdt, 4> edts{edt(quarters[0]), edt(quarters[1]), edt(quarters[2]), edt(quarters[3])};
  double lost_of_quarters = 0.0, lost_of_halves = 0.0;
  for (const auto& [a, b, c, d] : kPairings) {
    lost_of_quarters += lost(edts[a], edts[b]) + lost(edts[c], edts[d]);
    lost_of_halves += lost(edt(joined(quarters[a], quarters[b])), edt(joined(quarters[c], quarters[d])));
  }
  lost_of_quarters *= 0.5;
  const double factor = lost_of_quarters > 0.0 ? std::min(1.0, lost_of_halves / lost_of_quarters) : 0.0;
  return std::max(0.5, 1.0 - lost_of_halves / static_cast<double>(kPairings.size()) * factor);
}

std::vector<float> SplitSurface::distances(const Points& points) const {
  return surfaceDistances(points, search_->closest(points), samples_);
}

PointDensity::PointDensity(const PointsRef& points, double bandwidth, int num_threads)
    : bandwidth_(bandwidth), middle_(centerOfMass(points)) {
  const Eigen::Array3f low = points.rowwise().minCoeff().array() - static_cast<float>(kEvidence.margin * bandwidth);
  const Eigen::Array3f high = points.rowwise().maxCoeff().array() + static_cast<float>(kEvidence.margin * bandwidth);
  cell_size_ =
      std::max(static_cast<float>(kEvidence.cell_size * bandwidth), (high - low).maxCoeff() / kEvidence.max_cells);
  origin_ = low.matrix();
  size_ = ((high - low) / cell_size_).ceil().cast<int>() + 2;
  spread(points);
  const double deviation = blur(bandwidth, num_threads);
  // The contribution of a point to the density at its own position.
  const double own_part = std::pow(2.0 * kPi * (deviation * deviation + kEvidence.cell_variance), -1.5);
  double total = 0.0, sq_extent = 0.0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    total += at(points.col(i));
    sq_extent += (points.col(i).cast<double>() - middle_).squaredNorm();
  }
  const double count = static_cast<double>(points.cols());
  mean_ = std::max(total / count - own_part, 1e-9);
  extent_ = std::max(std::sqrt(sq_extent / count), 1e-9);
}

/// Counts each point in the eight cells around it, trilinearly.
void PointDensity::spread(const PointsRef& points) {
  const std::array<std::size_t, 3> stride{1, static_cast<std::size_t>(size_[0]),
                                          static_cast<std::size_t>(size_[0]) * size_[1]};
  values_.assign(stride[2] * size_[2], 0.0f);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const CellPosition position((points.col(i) - origin_).array() / cell_size_);
    const Eigen::Array3i& c = position.cell;
    float* cell = &values_[c[0] + c[1] * stride[1] + c[2] * stride[2]];
    for (int corner = 0; corner < 8; ++corner) {
      float weight = 1.0f;
      std::size_t offset = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const bool upper = corner >> axis & 1;
        weight *= upper ? position.t[axis] : 1.0f - position.t[axis];
        offset += upper ? stride[axis] : 0;
      }
      cell[offset] += weight;
    }
  }
}

/// Blurs the counts along each axis in turn.
/// \return standard deviation of the blur, cells: smaller than the bandwidth, as spreading and interpolation also blur.
double PointDensity::blur(double bandwidth, int num_threads) {
  const std::array<std::size_t, 3> stride{1, static_cast<std::size_t>(size_[0]),
                                          static_cast<std::size_t>(size_[0]) * size_[1]};
  const double sq_cells = std::pow(bandwidth / cell_size_, 2);
  const double deviation = std::sqrt(std::max(kEvidence.min_variance, sq_cells - kEvidence.cell_variance));
  const int reach = static_cast<int>(std::ceil(kEvidence.kernel_reach * deviation));
  const std::vector<float> kernel = gaussianKernel(deviation, reach);
  for (int axis = 0; axis < 3; ++axis) {
    const int along = size_[axis], across = size_[(axis + 1) % 3], deep = size_[(axis + 2) % 3];
    parallelBlocks(deep, num_threads, [&](std::size_t d) {
      std::vector<float> line(along + 2 * reach, 0.0f);
      for (int a = 0; a < across; ++a) {
        float* first = &values_[a * stride[(axis + 1) % 3] + d * stride[(axis + 2) % 3]];
        for (int k = 0; k < along; ++k) line[k + reach] = first[k * stride[axis]];
        for (int k = 0; k < along; ++k) {
          float value = 0.0f;
          for (int j = 0; j <= 2 * reach; ++j) value += kernel[j] * line[k + j];
          first[k * stride[axis]] = value;
        }
      }
    });
  }
  return deviation;
}

float PointDensity::at(const Eigen::Vector3f& x) const {
  const Eigen::Array3f p = (x - origin_).array() / cell_size_;
  if (!(p >= 0.0f).all() || !(p < (size_ - 1).cast<float>()).all()) return 0.0f;
  const CellPosition position(p);
  const Eigen::Array3i& c = position.cell;
  const Eigen::Array3f& t = position.t;
  const std::size_t row = size_[0], slice = row * size_[1];
  const float* v = &values_[c[0] + c[1] * row + c[2] * slice];
  const auto along = [&](std::size_t i) { return v[i] + t[0] * (v[i + 1] - v[i]); };
  const auto face = [&](std::size_t i) { return along(i) + t[1] * (along(i + row) - along(i)); };
  return face(0) + t[2] * (face(slice) - face(0));
}

double PointDensity::overlap(const PointsRef& samples, const ReflectionPlane& plane) const {
  const Eigen::Vector3f n = plane.normal().cast<float>();
  const float r = static_cast<float>(plane.offset());
  double sum = 0.0;
  for (Eigen::Index i = 0; i < samples.cols(); ++i) {
    const Eigen::Vector3f x = samples.col(i);
    sum += at(x - 2.0f * (n.dot(x) - r) * n);
  }
  return sum / (mean_ * static_cast<double>(samples.cols()));
}

PointDensity::Refined PointDensity::refine(const PointsRef& samples, const ReflectionPlane& plane,
                                           int max_iterations) const {
  Refined best{plane, 0};
  double best_value = overlap(samples, best.plane);
  const double step = kEvidence.step * bandwidth_ / extent_;  // radians; times the extent in offset
  for (; best.iterations < max_iterations; ++best.iterations) {
    const PlaneChart chart(best.plane, middle_, extent_);
    const auto value = [&](const Eigen::Vector3d& by) { return overlap(samples, chart.moved(by)); };
    Eigen::Vector3d by = Quadric(value, best_value, step).stepUp();
    if (!by.allFinite()) break;
    if (by.norm() > kEvidence.longest_step * step) by *= kEvidence.longest_step * step / by.norm();
    double next = value(by);
    while (next < best_value && by.norm() * extent_ > kEvidence.settled * bandwidth_) {
      by *= 0.5;
      next = value(by);
    }
    if (next < best_value) break;
    best.plane = chart.moved(by);
    best_value = next;
    if (by.norm() * extent_ < kEvidence.settled * bandwidth_) break;
  }
  return best;
}

}  // namespace pcl_symmetry
