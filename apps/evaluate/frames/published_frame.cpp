#include "evaluate/frames/published_frame.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/frame/plane_profiles.h"
#include "pcl_symmetry/core/detection/local_maxima.h"
#include "pcl_symmetry/core/neighbours/closest_point_search.h"
#include "pcl_symmetry/core/refinement/iterative_symmetric_points.h"
#include "pcl_symmetry/core/transform/planar_transform.h"

namespace pcl_symmetry::apps {

namespace {

constexpr int kBins = 64;  // over theta, phi and r; derived: the paper's grid
// Angles of the second plane over the half-turn. derived: as far apart as the bins of theta, pi / 2 over 64.
constexpr int kPublishedAngles = 128;
// Samples of D where a plane is none of the map. chosen: half raises the error by sqrt(2), twice takes twice the time.
constexpr int kProfileSamples = 2048;
// Maxima that are refined. chosen: half may leave out the plane that is strongest once it is refined, twice takes twice
// the time.
constexpr std::size_t kMostRefined = 8;
// Points that an iteration reflects. chosen: the paper takes 10 000, in five times the time; half makes planes less
// exact.
constexpr std::size_t kReflected = 2000;
// Steps of the refinement, and the motion at which it ends, radians and radii. chosen: half of the steps may leave a
// plane on its way; the motion is far below the 5 degrees that count, twice of it as well.
constexpr int kMostSteps = 50;
constexpr double kAtRest = 1e-4;

/// Planes through the points and what D says of them.
class PublishedSearch {
public:
  PublishedSearch(const Points& points, const PublishedFrameOptions& options)
      : points_(points),
        options_(options),
        edt_(points, edtOptions(options)),
        middle_(edt_.origin() + Eigen::Vector3d::Constant(0.5 * (edt_.numCells() - 1) * edt_.cellSize())),
        profiles_(edt_, {}, kProfileSamples, options.seed, options.num_threads),
        search_(makeTreeSearch(points)) {
    const std::size_t stride = std::max<std::size_t>(1, static_cast<std::size_t>(points.cols()) / kReflected);
    for (std::size_t i = 0; i < static_cast<std::size_t>(points.cols()); i += stride)
      reflected_.push_back(static_cast<int>(i));
  }

  /// The plane of greatest D.
  ReflectionPlane first() const {
    const PlaneGrid grid(kBins, kBins, kBins, edt_.center(), edt_.radius());
    ConvolutionTransformOptions exact;
    exact.num_threads = options_.num_threads;
    SymmetryMap map = convolutionTransform(edt_, grid, exact);
    const PlaneGrid::Bin strongest = grid.bin(map.strongest());
    const ReflectionPlane best = grid.plane(strongest);
    if (!options_.refined) return best;
    map.center_of_mass = centerOfMass(points_);
    std::vector<ReflectionPlane> starts{best};
    for (const LocalMaximum& maximum : findLocalMaxima(map))
      if (starts.size() < kMostRefined) starts.push_back(maximum.plane);
    return strongestOf(starts, Eigen::Matrix3d::Identity());
  }

  /// The plane of greatest D among those whose normals lie in the span of the columns of \p basis, one or two.
  ReflectionPlane within(const Eigen::Matrix3Xd& basis) const {
    const int num_angles = basis.cols() == 1 ? 1 : kPublishedAngles;
    std::vector<ReflectionPlane> planes(static_cast<std::size_t>(num_angles));
    std::vector<float> values(planes.size());
    parallelBlocks(planes.size(), options_.num_threads, [&](std::size_t i) {
      const double angle = kPi * static_cast<double>(i) / kPublishedAngles;
      Eigen::Vector3d normal = basis.col(0);
      if (num_angles > 1) normal = std::cos(angle) * basis.col(0) + std::sin(angle) * basis.col(1);
      const int half = static_cast<int>(edt_.radius() / edt_.cellSize());
      const std::vector<float> s =
          profiles_.scores(normal.cast<float>(), static_cast<float>(-half), 1.0f, 2 * half + 1);
      const auto at = std::max_element(s.begin(), s.end()) - s.begin();
      planes[i] = ReflectionPlane(normal, normal.dot(middle_) + static_cast<double>(at - half) * edt_.cellSize());
      values[i] = s[static_cast<std::size_t>(at)];
    });
    const auto best = static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
    return options_.refined ? strongestOf({planes[best]}, basis) : planes[best];
  }

private:
  static GaussianEdtOptions edtOptions(const PublishedFrameOptions& options) {
    GaussianEdtOptions edt;
    edt.num_threads = options.num_threads;
    return edt;
  }

  double symmetryOf(const ReflectionPlane& plane) const {
    const double offset = -plane.signedDistance(middle_) / edt_.cellSize();
    return profiles_.score({plane.normal().cast<float>(), static_cast<float>(offset)});
  }

  /// The plane of greatest D among some and what they become when they are refined.
  ReflectionPlane strongestOf(const std::vector<ReflectionPlane>& starts, const Eigen::Matrix3Xd& basis) const {
    std::vector<ReflectionPlane> ends(starts.size());
    std::vector<double> values(starts.size());
    parallelBlocks(starts.size(), options_.num_threads, [&](std::size_t i) {
      const ReflectionPlane end = refined(starts[i], basis);
      const double at_start = symmetryOf(starts[i]), at_end = symmetryOf(end);
      ends[i] = at_end >= at_start ? end : starts[i];
      values[i] = std::max(at_start, at_end);
    });
    return ends[static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin())];
  }

  /// Iterative Symmetric Points with the normal in the span of \p basis (Section 4.4).
  ReflectionPlane refined(ReflectionPlane plane, const Eigen::Matrix3Xd& basis) const {
    const Points no_normals;
    const IspSurface surface{points_, no_normals, *search_};
    for (int step = 0; step < kMostSteps; ++step) {
      const IspStep found = iterateSymmetricPoints(surface, reflected_, plane, edt_.sigma(), IspUpdate::PointToPoint);
      const ReflectionPlane next = basis.cols() == 3 ? found.plane : fitted(found, basis, plane);
      const double moved = std::abs(next.signedDistance(edt_.center())) - std::abs(plane.signedDistance(edt_.center()));
      const bool rests = next.angleTo(plane) < kAtRest && std::abs(moved) < kAtRest * edt_.radius();
      plane = next;
      if (rests) break;
    }
    return plane;
  }

  /// The closed form of fitReflectionPlane() for normals in a subspace: the smallest eigenvalue there.
  ReflectionPlane fitted(const IspStep& step, const Eigen::Matrix3Xd& basis, const ReflectionPlane& fallback) const {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    double sum = 0.0;
    const auto eachPair = [&](const auto& use) {
      for (std::size_t i = 0; i < reflected_.size(); ++i) {
        if (step.closest[i] < 0) continue;
        const double weight = std::exp(-step.sq_distances[i] / (edt_.sigma() * edt_.sigma()));
        use(points_.col(reflected_[i]).cast<double>(), points_.col(step.closest[i]).cast<double>(), weight);
      }
    };
    eachPair([&](const Eigen::Vector3d& x, const Eigen::Vector3d& y, double weight) {
      middle += weight * 0.5 * (x + y);
      sum += weight;
    });
    if (!(sum > 0.0)) return fallback;
    middle /= sum;
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    eachPair([&](const Eigen::Vector3d& x, const Eigen::Vector3d& y, double weight) {
      const Eigen::Matrix3d product = (x - middle) * (y - middle).transpose();
      a += 0.5 * weight * (product + product.transpose());
    });
    Eigen::Vector3d normal = basis.col(0);
    if (basis.cols() == 2) {
      const Eigen::Matrix2d small = basis.transpose() * a * basis;
      normal = basis * Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(small).eigenvectors().col(0);
    }
    return ReflectionPlane(normal, normal.dot(middle));
  }

  const Points& points_;
  const PublishedFrameOptions options_;
  const GaussianEdt edt_;
  const Eigen::Vector3d middle_;  // of the grid, input frame
  const PlaneProfiles profiles_;
  const ClosestPointSearch::Ptr search_;
  std::vector<int> reflected_;
};

}  // namespace

PublishedFrame publishedFrame(const Points& points, const PublishedFrameOptions& options) {
  const PublishedSearch search(points, options);
  const ReflectionPlane first = search.first();
  const Eigen::Vector3d u = first.normal().unitOrthogonal();
  Eigen::Matrix3Xd across(3, 2);
  across << u, first.normal().cross(u);
  const ReflectionPlane second = search.within(across);
  PublishedFrame frame;
  frame.axes << first.normal(), second.normal(), first.normal().cross(second.normal()).normalized();
  const ReflectionPlane third = search.within(frame.axes.col(2));
  const Eigen::Vector3d offsets(first.offset(), second.offset(), third.offset());
  frame.center = frame.axes.transpose().fullPivLu().solve(offsets);
  return frame;
}

}  // namespace pcl_symmetry::apps
