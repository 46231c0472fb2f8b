#include "pcl_symmetry/core/volume_planes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "core/base/stopwatch.h"
#include "core/base/symmetric_solvers.h"
#include "core/detection/plane_decision.h"
#include "core/geometry/cloud_extent.h"
#include "core/geometry/directions.h"
#include "core/geometry/geometry_rules.h"
#include "core/geometry/plane_chart.h"
#include "pcl_symmetry/core/planar_transform.h"

namespace pcl_symmetry {

namespace {

/// The numbers that change answers.
struct VolumeRules {
  std::size_t fine_voxels = 1u << 22;    ///< voxels of the last refinement: 160 along an edge
  std::size_t coarse_voxels = 1u << 18;  ///< voxels of the map, the candidates and the correlations: 64 along an edge
  int num_samples = 512;                 ///< samples of the map; the inside of a body has less contrast than a surface
  /// Planes in all directions, whose correlations give c0; their quartile has a standard error of 3 %.
  int num_chance_planes = 256;
  double chance_angle = 0.26;     ///< radians; planes closer to a maximum than this do not count for c0
  double chance_quantile = 0.75;  ///< quantile of the correlations of these planes that is c0
  double max_chance = 0.97;       ///< greatest c0; a body with a greater one is round
  double min_seen = 0.25;         ///< least share of the body that a plane compares
  double enough_seen = 0.6;       ///< share of the body that a plane has to compare to keep its confidence
  /// Share of the body, at which the confidence falls to 0: a small piece is symmetric by chance.
  double nothing_seen = 0.1;
  int num_translations = 6;  ///< distances by which a plane translates the body for comparison, each in both directions
  double min_residual = 0.01;  ///< 1 - c that interpolation leaves between equal halves
  /// Squared slope of f per voxel, in squared residuals, from which a pair counts half or more.
  double flat = 2.0;
  /// Voxels reflected in the refinement of all maxima, and of those that may be symmetries.
  double rough_voxels = 30'000.0, precise_voxels = 500'000.0;
  int rough_steps = 15, precise_steps = 10;  ///< greatest number of steps of the two refinements
  /// Last step of the two refinements, radians and tenths of a voxel.
  double rough_tolerance = 2e-3, precise_tolerance = 1e-4;
  double max_level = 0.999;    ///< greatest correlation of chance, because the confidence divides by 1 minus it
  double merge_angle = 0.12;   ///< radians; maxima within this angle and merge_offset are one
  double merge_offset = 0.04;  ///< difference of the offsets, share of the radius
};
constexpr VolumeRules kVolume;

/// What a plane does to a volume.
struct Comparison {
  double correlation = 0.0;                        ///< correlation of f with its reflection inside the body
  double score = 0.0;                              ///< D
  double seen = 0.0;                               ///< share of the body whose reflection lies in the volume
  double residual = 0.0;                           ///< root mean square of f(x) - f(gamma x) inside the body
  Eigen::Vector3d step = Eigen::Vector3d::Zero();  ///< Gauss-Newton step

  /// \return the criterion by which planes are compared.
  double merit() const { return seen < kVolume.min_seen ? -1.0 : correlation; }
};

/// Sums over pairs of a voxel and its reflection.
struct PairSums {
  double n = 0.0, f = 0.0, g = 0.0, ff = 0.0, gg = 0.0, fg = 0.0;  // sums inside the body
  double product = 0.0, square = 0.0, body = 0.0, seen_body = 0.0;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d rhs = Eigen::Vector3d::Zero();

  void operator+=(const PairSums& other) {
    n += other.n, f += other.f, g += other.g, ff += other.ff, gg += other.gg, fg += other.fg;
    product += other.product, square += other.square, body += other.body, seen_body += other.seen_body;
    normal += other.normal;
    rhs += other.rhs;
  }
};

/// A volume that planes are tried on.
class ReflectedVolume {
public:
  ReflectedVolume(const VolumeFunction& volume, const Eigen::Vector3d& pivot, int num_threads)
      : f_(volume.f), body_(volume.body), pivot_(pivot), num_threads_(num_threads) {
    T_index_input_ = f_.T_input_index().inverse();
    // Smoothing has mixed the outermost voxels with values beyond the volume.
    for (int a = 0; a < 3; ++a) margin_[a] = f_.size()[a] >= 16 ? 2.0 : 0.0;
    is_thick_ = f_.spacing().array() > 1.5 * f_.spacing().minCoeff();
  }

  /// \param stride every stride-th voxel along each axis is reflected.
  /// \param residual residual of the plane, if known: where f is as flat as its noise, pairs are uninformative about
  /// the step and count little. Without these weights, the noise of the whole inside of a body adds up.
  Comparison compare(const ReflectionPlane& plane, int stride, bool with_step, double residual = 0.0) const {
    return compare(plane.reflection(), plane, stride, with_step, residual);
  }

  /// The correlation with the body translated along the normal of a plane as far as the plane moves its points: if f
  /// changes slowly in that direction, as along a thin slab, every plane perpendicular to it seems to be a symmetry.
  /// \param distances distances of the body's points from the plane.
  double translated(const ReflectionPlane& plane, std::vector<double> distances, int stride) const {
    double sum = 0.0, num = 0.0;
    for (int k = 0; k < kVolume.num_translations && !distances.empty(); ++k) {
      const auto at =
          distances.begin() + static_cast<std::ptrdiff_t>((k + 0.5) / kVolume.num_translations * distances.size());
      std::nth_element(distances.begin(), at, distances.end());
      for (const double way : {2.0 * *at, -2.0 * *at}) {
        const Eigen::Affine3d motion(Eigen::Translation3d(way * plane.normal()));
        const Comparison comparison = compare(motion, plane, stride, false, 0.0);
        if (comparison.seen < kVolume.min_seen) continue;
        sum += comparison.correlation;
        num += 1.0;
      }
    }
    return num > 0.0 ? sum / num : 0.0;
  }

  /// Gauss-Newton from a plane to the nearest maximum of D.
  /// \param tolerance last step: radians, and tenths of a voxel.
  /// \return the plane, with iterations and converged.
  SymmetryPlane refinePlane(const ReflectionPlane& start, int stride, int max_iterations, double tolerance) const {
    const double spacing = f_.spacing().minCoeff(), max_step = 4.0 * stride * spacing;
    SymmetryPlane result(start);
    double residual = compare(start, stride, false).residual;
    for (; result.iterations < max_iterations && !result.converged; ++result.iterations) {
      const PlaneChart chart(result, pivot_);
      const Comparison comparison = compare(result, stride, true, residual);
      Eigen::Vector3d step = comparison.step;
      step *=
          std::min({1.0, 0.1 / std::max(1e-12, step.head<2>().norm()), max_step / std::max(1e-12, std::abs(step[2]))});
      const int iterations = result.iterations;
      result = SymmetryPlane(chart.moved(step));
      result.iterations = iterations;
      residual = comparison.residual;
      result.converged = step.head<2>().norm() < tolerance && std::abs(step[2]) < 10.0 * tolerance * spacing;
    }
    return result;
  }

private:
  Comparison compare(const Eigen::Affine3d& motion, const ReflectionPlane& plane, int stride, bool with_step,
                     double residual) const {
    const int nz = f_.size()[2], num_slices = (nz + stride - 1) / stride;
    std::vector<PairSums> slices(num_slices);
    parallelBlocks(num_slices, num_threads_, [&](std::size_t k) {
      slices[k] = ofSlice(motion, plane, static_cast<int>(k) * stride, stride, with_step, residual);
    });
    PairSums sum;
    for (const PairSums& slice : slices) sum += slice;
    Comparison result;
    if (sum.n < 1.0 || sum.square == 0.0) return result;
    const double var_f = sum.ff - sum.f * sum.f / sum.n, var_g = sum.gg - sum.g * sum.g / sum.n;
    if (var_f > 0.0 && var_g > 0.0) result.correlation = (sum.fg - sum.f * sum.g / sum.n) / std::sqrt(var_f * var_g);
    result.score = std::clamp(sum.product / sum.square, 0.0, 1.0);
    result.seen = sum.seen_body / std::max(1.0, sum.body);
    result.residual = std::sqrt(std::max(0.0, sum.ff + sum.gg - 2.0 * sum.fg) / sum.n);
    if (with_step) {
      // Nearly round bodies leave an angle undetermined: a small multiple of the trace keeps its step short.
      Eigen::Matrix3d normal = sum.normal;
      normal.diagonal() *= 1.0 + 1e-6;
      result.step = -solveSymmetric(normal, sum.rhs);
      if (!result.step.allFinite()) result.step.setZero();
    }
    return result;
  }

  /// The gradient per voxel and f, with the voxels as coefficients of a cubic B-spline, which is smooth everywhere. The
  /// kinks of trilinear look-ups would draw planes to where voxels fall on voxels, by up to a degree. Along an axis of
  /// thick slices, which must not be blurred further, f passes through the voxels (cubic convolution, Keys 1981).
  Eigen::Vector4d splineAt(const Eigen::Vector3d& p) const {
    static const Eigen::Matrix4d spline =
        (Eigen::Matrix4d() << 1, -3, 3, -1, 4, 0, -6, 3, 1, 3, 3, -3, 0, 0, 0, 1).finished() / 6;
    static const Eigen::Matrix4d convolution =
        (Eigen::Matrix4d() << 0, -1, 2, -1, 2, 0, -5, 3, 0, 1, 4, -3, 0, 0, -1, 1).finished() / 2;
    Eigen::Array4d weights[3], slopes[3];
    std::ptrdiff_t offsets[3][4], step = 1;
    for (int a = 0; a < 3; step *= f_.size()[a++]) {
      const double whole = std::floor(p[a]), t = p[a] - whole;
      const Eigen::Matrix4d& basis = is_thick_[a] ? convolution : spline;
      weights[a] = basis * Eigen::Vector4d(1.0, t, t * t, t * t * t);
      slopes[a] = basis * Eigen::Vector4d(0.0, 1.0, 2.0 * t, 3.0 * t * t);
      for (int k = 0; k < 4; ++k)
        offsets[a][k] = step * std::clamp(static_cast<int>(whole) + k - 1, 0, f_.size()[a] - 1);
    }
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (int z = 0; z < 4; ++z)
      for (int y = 0; y < 4; ++y) {
        const float* const row = f_.values().data() + offsets[2][z] + offsets[1][y];
        const Eigen::Array4d v(row[offsets[0][0]], row[offsets[0][1]], row[offsets[0][2]], row[offsets[0][3]]);
        const double along_x = (weights[0] * v).sum();
        const double weight = weights[2][z] * weights[1][y];
        sum += Eigen::Vector4d(weight * (slopes[0] * v).sum(), weights[2][z] * slopes[1][y] * along_x,
                               slopes[2][z] * weights[1][y] * along_x, weight * along_x);
      }
    return sum;
  }

  PairSums ofSlice(const Eigen::Affine3d& motion, const ReflectionPlane& plane, int z, int stride, bool with_step,
                   double residual) const {
    const PlaneChart chart(plane, pivot_);
    const Eigen::Affine3d& T = f_.T_input_index();
    const Eigen::Affine3d image = T_index_input_ * motion * T;             // from indices to indices
    const Eigen::Matrix3d to_input = T_index_input_.linear().transpose();  // for gradients
    const float* const values = f_.values().data();
    const auto [nx, ny, nz] = f_.size();
    const float body = static_cast<float>(body_);
    PairSums sum;
    for (int y = 0; y < ny; y += stride) {
      const float* const row = values + (static_cast<std::size_t>(z) * ny + y) * nx;
      for (int x = 0; x < nx; x += stride) {
        const double own = row[x];
        const bool in_body = own > body;
        sum.square += own * own;
        const Eigen::Vector3d index(x, y, z), p = image * index;
        if (!f_.contains(index, margin_)) continue;
        sum.body += in_body;
        if (!f_.contains(p, margin_)) continue;
        const double other = f_.at(p);
        sum.product += own * other;
        sum.seen_body += in_body;
        if (!in_body && other <= body) continue;
        sum.n += 1.0;
        sum.f += own, sum.g += other, sum.ff += own * own, sum.gg += other * other, sum.fg += own * other;
        if (!with_step) continue;
        // The derivatives of f(x) - f(x - 2 (n.x - r) n) by angles about v and u and by r.
        const Eigen::Vector4d here = splineAt(index), there = splineAt(p);
        const Eigen::Vector3d g = to_input * there.head<3>(), from_pivot = T * index - pivot_;
        const Eigen::Vector3d j = -chart.slope(from_pivot, chart.n.dot(from_pivot) - chart.offset, g);
        const Eigen::Vector3d slope = 0.5 * (here.head<3>() + image.linear().transpose() * there.head<3>());
        const double sq_slope = slope.squaredNorm(), sq_noise = kVolume.flat * residual * residual;
        const double weight = sq_noise > 0.0 ? sq_slope / (sq_slope + sq_noise) : 1.0;
        sum.normal += weight * j * j.transpose();
        sum.rhs += weight * (here[3] - there[3]) * j;
      }
    }
    return sum;
  }

  const ScalarGrid& f_;
  double body_;
  Eigen::Vector3d pivot_;
  int num_threads_;
  Eigen::Affine3d T_index_input_;
  Eigen::Vector3d margin_;
  Eigen::Array<bool, 3, 1> is_thick_;
};

/// A stride that reflects about this number of voxels.
int strideFor(const ScalarGrid& grid, double num_voxels) {
  return std::max(1, static_cast<int>(std::lround(std::cbrt(static_cast<double>(grid.numVoxels()) / num_voxels))));
}

/// The search for planes of a volume at two resolutions.
struct VolumeSearch {
  const DetectionOptions& options;
  const VolumeFunction fine, coarse;
  const Points body = coarse.bodyPoints(false);
  const GaussianEdt edt{coarse, options.edtOptions()};
  const Eigen::Vector3d center = centerOfMass(body);
  const ReflectedVolume few{coarse, center, 1}, all{fine, center, options.num_threads};
  const int stride = strideFor(coarse.f, kVolume.rough_voxels);

  VolumeSearch(const ScalarGrid& input, const VolumeLevels& levels, const DetectionOptions& given_options)
      : options(given_options),
        fine(input, levels, kVolume.fine_voxels, options.num_threads),
        coarse(fine, kVolume.coarse_voxels, options.num_threads) {}

  /// Of the planes that ended at the same plane only the best one, best first.
  std::vector<SymmetryPlane> distinct(std::vector<SymmetryPlane> planes) const {
    const MergeTolerance same_maximum{kVolume.merge_angle, kVolume.merge_offset * edt.radius()};
    sortDescending(planes, &SymmetryPlane::support);
    eraseIf(planes, [](const SymmetryPlane& plane) { return !(plane.support > 0.0); });
    return same_maximum.distinct(
        std::move(planes), [&](const SymmetryPlane& plane) { return plane.normalized(center); }, options.max_planes);
  }

  /// The strongest maxima of a map and the principal planes, refined on few voxels.
  std::vector<SymmetryPlane> maxima(const SymmetryMap& map) const {
    std::vector<ReflectionPlane> starts = principalPlanes(principalAxes(body));
    for (const LocalMaximum& maximum : findLocalMaxima(map, {}, options.num_threads))
      if (static_cast<int>(starts.size()) < options.expert.max_candidates) starts.push_back(maximum.plane);
    std::vector<SymmetryPlane> refined(starts.size());
    parallelBlocks(starts.size(), options.num_threads, [&](std::size_t i) {
      refined[i] = few.refinePlane(starts[i], stride, kVolume.rough_steps, kVolume.rough_tolerance);
      refined[i].support = few.compare(refined[i], 1, false).merit();
    });
    return distinct(std::move(refined));
  }

  /// c0: the correlation that a plane reaches in any direction.
  double chanceLevel(const std::vector<SymmetryPlane>& maxima) const {
    std::vector<ReflectionPlane> planes;
    for (int k = 0; k < kVolume.num_chance_planes; ++k) {
      const Eigen::Vector3d n = spiralDirection(k, kVolume.num_chance_planes, k * kGoldenAngle);
      const ReflectionPlane plane(n, n.dot(center));
      const bool is_near = std::any_of(maxima.begin(), maxima.end(), [&](const SymmetryPlane& maximum) {
        return maximum.angleTo(plane) < kVolume.chance_angle;
      });
      if (!is_near) planes.push_back(plane);
    }
    if (planes.empty()) return 1.0;
    std::vector<double> reached(planes.size());
    parallelBlocks(planes.size(), options.num_threads,
                   [&](std::size_t i) { reached[i] = few.compare(planes[i], stride, false).correlation; });
    return std::max(0.0, quantile(std::move(reached), kVolume.chance_quantile));
  }

  static double confidence(const SymmetryPlane& plane, double level) {
    const double beyond_chance = std::clamp((plane.support - level) / (1.0 - level), 0.0, 1.0);
    return beyond_chance * beyond_chance;
  }

  /// Refines the maxima that may be symmetries on many voxels.
  std::vector<SymmetryPlane> refinePlanes(std::vector<SymmetryPlane> maxima, double chance) const {
    for (SymmetryPlane& plane : maxima) {
      if (!options.approximate && &plane != &maxima.front() && confidence(plane, chance) < options.min_possible)
        continue;
      const int before = plane.iterations;
      plane = all.refinePlane(plane, strideFor(fine.f, kVolume.precise_voxels), kVolume.precise_steps,
                              kVolume.precise_tolerance);
      const Comparison comparison = few.compare(plane, 1, false);
      plane.iterations += before;
      plane.support = std::max(0.0, comparison.merit());
      plane.score = comparison.score;
      plane.seen = comparison.seen;
      plane.residual = comparison.residual;
    }
    return distinct(std::move(maxima));
  }

  /// Sets the confidence of a plane.
  /// \param best_support greatest support of any plane: it shows how alike halves are at this noise. A body that is
  /// nearly an ellipsoid has other planes, with larger differences.
  void judge(SymmetryPlane& plane, double chance, double best_support) const {
    double level = chance;
    if (confidence(plane, level) >= options.min_possible) {
      std::vector<double> distances(body.cols());
      for (std::size_t i = 0; i < distances.size(); ++i)
        distances[i] = std::abs(plane.signedDistance(body.col(i).cast<double>()));
      level = std::clamp(few.translated(plane, std::move(distances), stride), chance, kVolume.max_level);
    }
    const double min_left = 1.0 - best_support + kVolume.min_residual,
                 left = 1.0 - plane.support + kVolume.min_residual,
                 shown = (plane.seen - kVolume.nothing_seen) / (kVolume.enough_seen - kVolume.nothing_seen);
    setConfidence(plane,
                  confidence(plane, level) * std::pow(std::min(1.0, min_left / left), 2) * std::clamp(shown, 0.0, 1.0),
                  "the correlation beyond that of planes in any direction", options);
    // The share and the deviation of a surface do not apply to a volume.
    plane.share = plane.share_low = plane.share_high = plane.deviation = std::numeric_limits<double>::quiet_NaN();
  }
};

}  // namespace

Detection detectVolumePlanes(const ScalarGrid& input, const DetectionOptions& options, const VolumeLevels& levels) {
  options.validate();
  levels.validate();
  Detection found;
  StageTimes done(found.timing_ms);
  try {
    const VolumeSearch search(input, levels, options);
    const GaussianEdt& edt = search.edt;
    done("volume");
    found.map = sampledTransform(edt, PlaneGrid(options.expert, edt.center(), edt.radius()),
                                 {kVolume.num_samples, options.seed, options.num_threads});
    found.map.center_of_mass = search.center;
    found.diameter = 2.0 * edt.radius();
    done("transform");
    std::vector<SymmetryPlane> planes = search.maxima(found.map);
    done("maxima");
    const double chance = search.chanceLevel(planes);
    if (chance > kVolume.max_chance) {
      found.reason = "volume: the body is round, planes in all directions map it onto itself";
      return found;
    }
    planes = search.refinePlanes(std::move(planes), chance);
    for (SymmetryPlane& plane : planes) search.judge(plane, chance, planes.front().support);
    if (std::none_of(planes.begin(), planes.end(), isDecided) && !planes.empty()) found.best = planes.front();
    found.planes = sortPlanes(std::move(planes), options);
    done("refinement");
  } catch (const VolumeWithoutAnswer& error) {
    found.reason = error.what();
  }
  return found;
}

}  // namespace pcl_symmetry
