#include "evaluate/references/reference_search.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "evaluate/mesh/mesh_reflection.h"
#include "evaluate/references/plane_families.h"
#include "evaluate/references/plane_scan.h"
#include "evaluate/references/transform_candidates.h"
#include "evaluate/shared/plane_difference.h"

namespace pcl_symmetry::apps {

namespace {

// The search, in diagonals and shares.
/// Least closeness of candidates. derived: a near plane leaves at most 10 % of the surface far off, and the grid's
/// plane beside it another third; half only adds candidates.
constexpr double kLeastCloseness = 0.5;
constexpr std::size_t kMinCandidates = 20;   // chosen: asymmetric shapes have a best share too; twice screens 20 more
constexpr std::size_t kMaxCandidates = 300;  // chosen: half misses planes of gears, twice takes twice the time
/// Widths of the weights at the start of a refinement. chosen: half leaves poor candidates behind, twice joins near
/// planes.
constexpr double kCoarseWidth = 0.04, kFineWidth = 0.01;
/// chosen: shares are known to 1 % (screen) and 0.5 % (fine); half doubles the variance, twice the time.
constexpr int kScreenSamples = 1000, kCoarseSamples = 400, kFineSamples = 4000, kFamilySamples = 5000;
/// chosen: climbing by more than the error of a share of these needs no more; half gains by chance, twice takes longer.
constexpr int kClimbSamples = 2000;
constexpr double kFullShare = 0.995;  // derived: what is above is symmetric at any min_share that is asked for
constexpr double kLeastGain =
    0.002;  // of the share; chosen: a standard error of it, smaller gains leave the plane alone
constexpr double kScreenSlack = 0.05;  // derived: five standard errors of a share of 0.9 among kScreenSamples
/// Candidates that reached the same plane. chosen: half refines planes twice, twice joins near ones.
constexpr double kSameAngle = 1.0 * kDegree, kSameOffset = 0.005;
/// Planes that test an axis or a center, and those that fit it. chosen: half misses a handle, twice the time.
constexpr int kNumFamilyPlanes = 24, kNumFitPlanes = 8;
constexpr std::size_t kMaxPlanes = 64;  // chosen: a shape with more planes is a family within tolerance

struct Family {
  Line3d line;
  double share;
};

class ReferenceSearch {
public:
  ReferenceSearch(const TriangleScene& scene, const ReferenceOptions& options)
      : options_(options), scene_(scene), reflection_(scene, options.num_samples, options.seed) {}

  void run() {
    std::vector<ReferencePlane> coarse = screened(candidates());
    findFamilies(coarse);
    removeFamilies(coarse, kScreenSlack);
    planes_ = merged(refined(coarse), mergeAngle(), options_.merge_offset);
    close();
    for (const ReferencePlane& plane : planes_) best_share_ = std::max(best_share_, plane.share);
    findFamilies(planes_);
    removeFamilies(planes_, 0.0);
  }

  /// In the frame of the scene.
  ReferenceSymmetries result() const {
    ReferenceSymmetries result;
    result.best_share = best_share_;
    for (const ReferencePlane& plane : planes_) {
      if (plane.share >= options_.min_share)
        result.planes.push_back(plane);
      else if (plane.share >= options_.near_share)
        result.near_planes.push_back(plane);
    }
    for (const Family& axis : axes_) {
      result.best_share = std::max(result.best_share, axis.share);
      (axis.share >= options_.min_share ? result.axes : result.near_axes)
          .push_back({axis.line.origin(), axis.line.direction(), axis.share});
    }
    for (const ReferenceCenter& center : centers_) {
      result.best_share = std::max(result.best_share, center.share);
      result.centers.push_back(center);
    }
    const bool has_reference = !(result.planes.empty() && result.axes.empty() && result.centers.empty());
    result.kind = has_reference                              ? SymmetryKind::Symmetric
                  : result.best_share >= options_.near_share ? SymmetryKind::NearlySymmetric
                                                             : SymmetryKind::Asymmetric;
    return result;
  }

private:
  int strideFor(int num_samples) const { return std::max(1, options_.num_samples / num_samples); }

  double share(const ReflectionPlane& plane, int num_samples) const {
    return reflection_.share(plane, options_.tolerance, strideFor(num_samples));
  }

  std::vector<ReflectionPlane> candidates() const {
    if (options_.by_transform) return transformCandidates(reflection_.samples(), options_);
    std::vector<ReflectionPlane> planes;
    for (const ScannedPlane& scanned : scanPlanes(scene_, reflection_.samples(), options_.num_threads))
      if (planes.size() < (scanned.closeness >= kLeastCloseness ? kMaxCandidates : kMinCandidates))
        planes.push_back(scanned.plane);
    return planes;
  }

  /// \return what might be near planes, and the best in any case; merged, best first.
  std::vector<ReferencePlane> screened(const std::vector<ReflectionPlane>& candidates) const {
    std::vector<ReferencePlane> planes(candidates.size());
    parallelBlocks(planes.size(), options_.num_threads, [&](std::size_t i) {
      planes[i].plane = reflection_.refine(candidates[i], kCoarseWidth, options_.tolerance, strideFor(kCoarseSamples));
      planes[i].share = share(planes[i].plane, kScreenSamples);
    });
    sortBestFirst(planes);
    planes = merged(planes, kSameAngle, kSameOffset);
    const double least = options_.near_share - kScreenSlack;
    std::size_t size = 1;
    while (size < planes.size() && planes[size].share >= least) ++size;
    planes.resize(std::min(planes.size(), size));
    return planes;
  }

  /// \return the same planes refined on more samples, with their shares; best first.
  std::vector<ReferencePlane> refined(std::vector<ReferencePlane> planes) const {
    parallelBlocks(planes.size(), options_.num_threads, [&](std::size_t i) {
      planes[i].plane =
          reflection_.refine(planes[i].plane, kFineWidth, 0.1 * options_.tolerance, strideFor(kFineSamples));
      planes[i].share = share(planes[i].plane, options_.num_samples);
      climb(planes[i]);
    });
    sortBestFirst(planes);
    return planes;
  }

  /// A plane of least distances leaves out area that another beside it maps to within the tolerance: what counts is the
  /// greatest share near by.
  void climb(ReferencePlane& plane) const {
    if (plane.share >= kFullShare) return;
    const ReflectionPlane higher = reflection_.climb(plane.plane, options_.tolerance, strideFor(kClimbSamples));
    const double higher_share = share(higher, options_.num_samples);
    if (higher_share > plane.share + kLeastGain) plane = {higher, higher_share};
  }

  static void sortBestFirst(std::vector<ReferencePlane>& planes) {
    std::stable_sort(planes.begin(), planes.end(), [](const auto& a, const auto& b) { return a.share > b.share; });
  }

  static bool holds(const std::vector<ReferencePlane>& planes, const ReflectionPlane& plane, double angle,
                    double offset) {
    return std::any_of(planes.begin(), planes.end(), [&](const auto& p) {
      return difference(p.plane, plane, Eigen::Vector3d::Zero()).within(angle, offset);
    });
  }

  /// \param planes best first.
  /// \return those that are not close to a better one.
  static std::vector<ReferencePlane> merged(const std::vector<ReferencePlane>& planes, double angle, double offset) {
    std::vector<ReferencePlane> kept;
    for (const ReferencePlane& plane : planes)
      if (!holds(kept, plane.plane, angle, offset)) kept.push_back(plane);
    return kept;
  }

  bool known(const ReflectionPlane& plane, double plane_share) const {
    return holds(planes_, plane, mergeAngle(), options_.merge_offset) || inFamily(plane, plane_share);
  }

  double mergeAngle() const { return options_.merge_angle * kDegree; }

  /// Adds the planes that reflecting one symmetry in another gives, until there are no new ones.
  void close() {
    bool changed = true;
    while (changed && planes_.size() < kMaxPlanes) {
      std::vector<ReferencePlane> images;
      for (const ReferencePlane& a : planes_) {
        if (a.share < options_.min_share) break;
        for (const ReferencePlane& b : planes_) {
          if (b.share < options_.min_share) break;
          const Eigen::Vector3d n = a.plane.reflection().linear() * b.plane.normal();
          const ReflectionPlane image(n, n.dot(a.plane.reflect(b.plane.offset() * b.plane.normal())));
          if (!known(image, 1.0) && !holds(images, image, kSameAngle, kSameOffset)) images.push_back({image, 0.0});
        }
      }
      if (images.size() > kMaxPlanes) images.resize(kMaxPlanes);
      changed = false;
      for (const ReferencePlane& image : refined(images)) {
        if (image.share < options_.near_share || known(image.plane, image.share)) continue;
        planes_.push_back(image);
        changed = true;
      }
      sortBestFirst(planes_);
    }
  }

  /// \return whether the plane is counted by an axis or a center. A near axis leaves out what is better than near: a
  /// cup is nearly round, and has one plane through its handle.
  bool inFamily(const ReflectionPlane& plane, double plane_share) const {
    return std::any_of(axes_.begin(), axes_.end(),
                       [&](const Family& axis) {
                         return (axis.share >= options_.min_share || plane_share < options_.min_share) &&
                                difference(plane, axis.line, Eigen::Vector3d::Zero())
                                    .within(mergeAngle(), options_.merge_offset);
                       }) ||
           std::any_of(centers_.begin(), centers_.end(), [&](const ReferenceCenter& center) {
             return std::abs(plane.signedDistance(center.point)) <= options_.merge_offset;
           });
  }

  /// \param slack by which the shares of the planes may be too low.
  void removeFamilies(std::vector<ReferencePlane>& planes, double slack) const {
    planes.erase(
        std::remove_if(planes.begin(), planes.end(), [&](const auto& p) { return inFamily(p.plane, p.share + slack); }),
        planes.end());
  }

  /// Least share of the planes; stops where it falls below \p enough.
  double leastShare(const std::vector<ReflectionPlane>& planes, int num_samples, double enough) const {
    constexpr std::size_t kGroup = 4;  // planes; chosen: one for each thread, twice computes in vain
    double least = 1.0;
    for (std::size_t first = 0; first < planes.size() && least >= enough; first += kGroup) {
      std::vector<double> shares(std::min(kGroup, planes.size() - first));
      parallelBlocks(shares.size(), options_.num_threads,
                     [&](std::size_t i) { shares[i] = share(planes[first + i], num_samples); });
      least = std::min(least, *std::min_element(shares.begin(), shares.end()));
    }
    return least;
  }

  /// \return the axis near the line if all planes through it are at least near planes.
  std::optional<Family> testAxis(Line3d line) const {
    const double least = options_.near_share - kScreenSlack;
    if (leastShare(planesThrough(line, kNumFamilyPlanes), kScreenSamples, least) < least) return std::nullopt;
    std::vector<ReflectionPlane> planes = planesThrough(line, kNumFitPlanes);
    parallelBlocks(planes.size(), options_.num_threads, [&](std::size_t i) {
      planes[i] = reflection_.refine(planes[i], kFineWidth, options_.tolerance, strideFor(kScreenSamples));
    });
    line = commonLine(planes, line);
    const double axis_share = leastShare(planesThrough(line, kNumFamilyPlanes), kFamilySamples, options_.near_share);
    if (axis_share < options_.near_share) return std::nullopt;
    return Family{line, axis_share};
  }

  /// Axes are looked for where two planes meet.
  void findFamilies(const std::vector<ReferencePlane>& planes) {
    // chosen: 276 lines; half misses axes, twice takes four times as long.
    constexpr std::size_t kMaxMeetingPlanes = 24;
    constexpr double kLeastSine = 0.17;  // derived: of ten degrees; closer planes meet in an uncertain line
    std::vector<Line3d> tested;
    const auto consider = [&](const Line3d& line) {
      const auto known = [&](const Line3d& other) {
        return difference(other, line, Eigen::Vector3d::Zero()).within(2.0 * kDegree, 0.01);
      };
      if (!centers_.empty() || std::any_of(tested.begin(), tested.end(), known)) return;
      tested.push_back(line);
      if (std::any_of(axes_.begin(), axes_.end(), [&](const Family& axis) { return known(axis.line); })) return;
      if (const auto axis = testAxis(line)) {
        axes_.push_back(*axis);
        if (axes_.size() >= 3) findCenter();
      }
    };
    const std::size_t size = std::min(planes.size(), kMaxMeetingPlanes);
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const ReflectionPlane &a = planes[i].plane, &b = planes[j].plane;
        if (inFamily(a, planes[i].share) || inFamily(b, planes[j].share)) continue;
        const Eigen::Vector3d direction = a.normal().cross(b.normal());
        if (direction.norm() < kLeastSine) continue;
        const Line3d along(Eigen::Vector3d::Zero(), direction.normalized());
        consider(commonLine({a, b}, along));
      }
    }
  }

  /// Three axes that do not lie in a plane make a sphere.
  void findCenter() {
    constexpr double kLeastVolume = 0.2;  // spanned by the directions; chosen: half makes uncertain centers
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        for (std::size_t k = 0; k < j; ++k) {
          const Line3d &a = axes_[i].line, &b = axes_[j].line, &c = axes_[k].line;
          if (std::abs(a.direction().cross(b.direction()).dot(c.direction())) < kLeastVolume) continue;
          const Eigen::Vector3d point = commonPoint({a, b, c});
          const double center_share =
              leastShare(planesThrough(point, kNumFamilyPlanes), kFamilySamples, options_.min_share);
          if (center_share < options_.min_share) continue;
          centers_.push_back({point, center_share});
          axes_.clear();
          return;
        }
      }
    }
  }

  ReferenceOptions options_;
  const TriangleScene& scene_;
  MeshReflection reflection_;
  double best_share_ = 0.0;             ///< of planes that were refined, in families or not
  std::vector<ReferencePlane> planes_;  ///< best first
  std::vector<Family> axes_;
  std::vector<ReferenceCenter> centers_;
};

}  // namespace

ReferenceSymmetries searchReferences(const TriangleScene& scene, const ReferenceOptions& options) {
  ReferenceSearch search(scene, options);
  search.run();
  return search.result();
}

}  // namespace pcl_symmetry::apps
