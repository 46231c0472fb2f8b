#include "core/detection/plane_families.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "core/base/constants.h"
#include "core/base/lists.h"
#include "core/base/symmetric_solvers.h"
#include "core/detection/plane_search.h"
#include "core/geometry/cloud_extent.h"
#include "core/geometry/directions.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/surface_normals.h"

namespace pcl_symmetry {

namespace {

constexpr MergeTolerance kSameAxisOfFamily{kDetection.families.contained_angle, kDetection.families.contained_offset};

/// Plane \p k of a sequence of planes through a line at angles that occur in no regular polygon.
ReflectionPlane planeOfFamily(const Line3d& line, int k, int) {
  return planeThrough(line, kPi * goldenFraction(k + 1));
}

/// Plane \p k of \p count planes through a point, their normals spread over the half sphere.
ReflectionPlane planeOfFamily(const Eigen::Vector3d& point, int k, int count) {
  const Eigen::Vector3d n = spiralDirection(k, count, 2.0 * kPi * goldenFraction(k + 1));
  return ReflectionPlane(n, n.dot(point));
}

/// Sum of n n^T over the normals.
Eigen::Matrix3d normalProducts(const std::vector<ReflectionPlane>& planes) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const ReflectionPlane& plane : planes) sum += plane.normal() * plane.normal().transpose();
  return sum;
}

/// The point closest to all planes or, if there are many, the one of them closest to \p start.
Eigen::Vector3d commonPoint(const std::vector<ReflectionPlane>& planes, const Eigen::Vector3d& start) {
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();
  for (const ReflectionPlane& plane : planes) pull += plane.normal() * plane.signedDistance(start);
  const double coplanar = kDetection.families.coplanar;
  return start - SymmetricEigen<Eigen::Matrix3d>(normalProducts(planes)).solve(pull, coplanar * coplanar);
}

/// Mean share of the planes of a family.
/// \return 0 if the mean cannot reach \p min_share.
template <typename PlaneAt>
double meanShare(const PlaneAt& plane_at, int count, double min_share,
                 const std::function<double(const ReflectionPlane&)>& share) {
  double sum = 0.0;
  for (int k = 0; k < count; ++k) {
    sum += share(plane_at(k));
    if (sum + (count - k - 1) < min_share * count) return 0.0;
  }
  return sum / count;
}

template <typename PlaneAt>
std::vector<ReflectionPlane> planesAt(const PlaneAt& plane_at) {
  std::vector<ReflectionPlane> planes;
  for (int k = 0; k < kDetection.families.tested_planes; ++k) planes.push_back(plane_at(k));
  return planes;
}

/// The family of all planes through a point or a line, or through a similar one nearby.
template <typename Common>
std::optional<PlaneFamily<Common>> familyAt(const Common& start, double min_share, const FamilyTest& test) {
  const int num_tested = kDetection.families.tested_planes, num_fitted = kDetection.families.fitted_planes;
  constexpr bool kIsLine = std::is_same_v<Common, Line3d>;
  Common common = start;
  const auto at = [&](int k) { return planeOfFamily(common, k, num_tested); };
  const auto tested = [&] { return meanShare(at, num_tested, min_share, test.share); };
  // The line through two rough planes may be off by a little: the refined line has to pass the full test.
  if (meanShare(at, kDetection.families.screening_planes, min_share - kDetection.families.rough_factor * test.allowance,
                test.rough_share) == 0.0)
    return std::nullopt;
  std::vector<ReflectionPlane> refined;
  for (int k = 0; k < num_fitted; ++k) refined.push_back(test.refine(planeOfFamily(common, k, num_fitted)));
  if constexpr (kIsLine)
    common = commonLine(refined);
  else
    common = commonPoint(refined, start);
  double share = tested();
  if (share < min_share && kIsLine) {
    // Planes that map a scan to unknown space drift when they are refined.
    common = start;
    share = tested();
  }
  if (share < min_share) return std::nullopt;
  return PlaneFamily<Common>{common, share, planesAt(at)};
}

FamilyTest familyTest(const PlaneSearch& search, const std::vector<int>& samples) {
  const NormalizedCloud& cloud = search.cloud;
  const PlaneFit& fit = search.fit;
  const DetectionOptions& options = search.options;
  // If the tolerance is greater than the default one, points within it may lie beyond the support of all samples.
  const double usual = DetectionOptions().tolerance * cloud.diameter;
  const bool is_coarse = cloud.isSurface() &&
                         std::max(options.tolerance * cloud.diameter, options.absolute_tolerance / cloud.scale) > usual;
  // A plane that maps most of a scan to unknown space is uninformative: only contradictions count.
  const auto shareOf = [&, is_coarse, is_scan = cloud.isScan()](const std::vector<int>& used) {
    return [&, used, is_coarse, is_scan](const ReflectionPlane& plane) {
      if (is_coarse) return search.judge(plane, used).evidence.share;
      const PlaneShares shares = fit.shares(plane, used);
      const double support = fit.relativeSupport(shares);
      return is_scan ? 1.0 - shares.conflict : support / std::max(0.01, std::min(1.0, support + shares.conflict));
    };
  };
  FamilyTest test;
  test.share = shareOf(samples);
  // Samples may be all points in the order of the file, whose first fifth may be one end of the shape.
  std::vector<int> fewer;
  const auto num_samples = static_cast<Eigen::Index>(samples.size());
  for (const int i :
       drawSamples(num_samples, static_cast<int>(num_samples) / kDetection.families.rough_sample_share, options.seed))
    fewer.push_back(samples[i]);
  test.rough_share = shareOf(fewer);
  test.refine = [&fit, samples](const ReflectionPlane& plane) { return fit.refinePlane(plane, samples); };
  const CloudKind kind = cloud.kind();
  const double few_points = kKindRules.points_of_allowance[kind] / static_cast<double>(cloud.points.cols());
  test.min_share = kKindRules.family_share[kind];
  test.allowance = kKindRules.family_allowance[kind] * std::sqrt(std::max(1.0, few_points));
  return test;
}

/// Different symmetries among planes, most confident first, normalized frame.
std::vector<ReflectionPlane> symmetriesOf(std::vector<SymmetryPlane> planes, const NormalizedCloud& cloud) {
  sortDescending(planes, &SymmetryPlane::confidence);
  return kSamePlane.distinct(planesOf(planes, {PlaneKind::Symmetry}, cloud));
}

/// Planes through the axis of a body that is round but for a part, such as a bottle with its nozzle, map the body onto
/// itself. If one maps the part onto itself, too, those that do not are possible at most.
/// \param symmetries those among \p planes, normalized frame.
void limitByPart(const NormalizedCloud& cloud, const std::vector<ReflectionPlane>& symmetries, const FamilyTest& test,
                 std::vector<SymmetryPlane>& planes) {
  const auto byShare = [&](const ReflectionPlane& a, const ReflectionPlane& b) {
    return test.share(a) < test.share(b);
  };
  const ReflectionPlane best = *std::max_element(symmetries.begin(), symmetries.end(), byShare);
  const double best_share = test.share(best);
  std::vector<Line3d> tried;
  for (const ReflectionPlane& other : symmetries) {
    if (best.angleTo(other) < kDetection.families.min_angle) continue;
    const Line3d line = commonLine({best, other});
    if (kSameAxisOfFamily.anySame(tried, line)) continue;
    tried.push_back(line);
    const std::optional<AxisFamily> body = familyAt(line, test.min_share, test);
    if (!body || body->share > best_share - test.allowance) continue;
    for (SymmetryPlane& plane : planes)
      if (test.share(cloud.toNormalized(plane)) < 0.5 * (body->share + best_share))
        limitToPossible(plane, kPartOffRoundBody);
  }
}

/// The longest principal axis.
Line3d longestAxis(const PrincipalAxes& axes) {
  const Eigen::Vector3d direction = axes.axes.col(0);
  return Line3d(axes.center - direction.dot(axes.center) * direction, direction);
}

}  // namespace

bool contains(const ReflectionPlane& plane, const Line3d& line) {
  return std::abs(plane.normal().dot(line.direction())) <= std::sin(kDetection.families.contained_angle) &&
         std::abs(plane.signedDistance(line.origin())) <= kDetection.families.contained_offset;
}

Line3d commonLine(const std::vector<ReflectionPlane>& planes) {
  const SymmetricEigen<Eigen::Matrix3d> solver(normalProducts(planes));
  const Eigen::Vector3d direction = solver.eigenvectors().col(0);
  const Eigen::Vector3d point = commonPoint(planes, Eigen::Vector3d::Zero());
  return Line3d(point - direction.dot(point) * direction, direction);
}

std::optional<CenterFamily> findCenter(const std::vector<ReflectionPlane>& planes, const FamilyTest& test,
                                       const std::vector<Eigen::Vector3d>& guesses) {
  if (planes.empty()) return std::nullopt;
  std::vector<Eigen::Vector3d> points;
  const SymmetricEigen<Eigen::Matrix3d> solver(normalProducts(planes) / static_cast<double>(planes.size()));
  const bool has_point =
      planes.size() >= 3 &&
      solver.eigenvalues()[0] >= kDetection.families.min_spread;  // otherwise all planes contain one line
  if (has_point) points.push_back(commonPoint(planes, Eigen::Vector3d::Zero()));
  append(points, guesses);
  const double min_share = std::max(test.min_share, test.share(planes[0]) - test.allowance);
  for (const Eigen::Vector3d& point : points)
    if (std::optional<CenterFamily> center = familyAt(point, min_share, test)) return center;
  return std::nullopt;
}

std::vector<AxisFamily> findAxes(const std::vector<ReflectionPlane>& planes, const FamilyTest& test,
                                 const std::vector<Line3d>& guesses) {
  std::vector<AxisFamily> axes;
  std::vector<Line3d> tried;
  const auto attempt = [&](const Line3d& line, double best_share) {
    if (kSameAxisOfFamily.anySame(tried, line)) return;
    tried.push_back(line);
    std::optional<AxisFamily> axis = familyAt(line, std::max(test.min_share, best_share - test.allowance), test);
    if (!axis) return;
    tried.push_back(axis->common);
    axes.push_back(std::move(*axis));
  };
  if (!planes.empty())
    for (const Line3d& guess : guesses) attempt(guess, test.share(planes[0]));
  const std::size_t size = std::min(planes.size(), kDetection.families.max_planes);
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (planes[i].angleTo(planes[j]) < kDetection.families.min_angle) continue;
      attempt(commonLine({planes[i], planes[j]}), std::max(test.share(planes[i]), test.share(planes[j])));
    }
  }
  sortDescending(axes, &AxisFamily::share);
  return axes;
}

void findFamilies(const PlaneSearch& search, DetectionState& state) {
  Detection& answer = state.answer;
  const NormalizedCloud& cloud = search.cloud;
  const DetectionOptions& options = search.options;
  const CloudLimits& limits = search.measure.limits();
  if (limits.isCutOff() || (state.polygon && cloud.isSurface())) return;
  const std::vector<ReflectionPlane> symmetries = symmetriesOf(answer.planes, cloud);
  const bool is_line = limits.thinness() == Thinness::Line;
  if (symmetries.empty() && !is_line) return;
  const std::vector<int> samples =
      drawSamples(cloud.points.cols(), kKindRules.family_samples[cloud.kind()], options.seed);
  if (is_line) {
    const Line3d line = longestAxis(cloud.principal_axes);
    const JudgedFamily family = search.judgeFamily(planesAt([&](int k) { return planeOfFamily(line, k, 0); }), samples);
    if (family.confidence >= options.min_confidence)
      answer.axes.push_back(
          {cloud.toInput(line.origin()), line.direction(), family.confidence, family.score, family.support});
    return;
  }
  const FamilyTest test = familyTest(search, samples);
  std::vector<Line3d> likely_axes;
  std::vector<Eigen::Vector3d> likely_centers;
  if (!cloud.isVolume()) {
    likely_axes.push_back(axisOfNormals(cloud.points, cloud.geometry.normals, samples));
    likely_centers.push_back(centerOfNormals(cloud.points, cloud.geometry.normals, samples));
  }
  // A regular polygon is not symmetric between its planes: the worst plane decides, too. In a scan, some planes are too
  // poorly visible for that.
  const auto isFamily = [&](const JudgedFamily& family) {
    return family.confidence >= options.min_confidence &&
           (cloud.isScan() || family.min_confidence >= kDetection.families.worst_share * options.min_confidence);
  };
  if (const std::optional<CenterFamily> center = findCenter(symmetries, test, likely_centers)) {
    const JudgedFamily family = search.judgeFamily(center->planes, samples);
    if (isFamily(family)) {
      answer.centers.push_back({cloud.toInput(center->common), family.confidence, family.score, family.support});
      answer.planes = withoutPlanesThrough(std::move(answer.planes), answer.centers.back(), cloud);
      return;
    }
  }
  for (const AxisFamily& axis : findAxes(symmetries, test, likely_axes)) {
    // Noise blurs the gaps between the planes of a polygon, but not equally at all of them.
    if (cloud.isVolume() && polygonBySpectrum(search.all_points, axis.common)) continue;
    const JudgedFamily family = search.judgeFamily(axis.planes, samples);
    if (!isFamily(family)) continue;
    // No bounded shape has two parallel axes, but a thin disc seems to within the tolerance: only the best one counts.
    if (!isNearAny(answer.axes, axis.common.direction(), std::cos(kDetection.families.contained_angle),
                   &SymmetryAxis::direction))
      answer.axes.push_back({cloud.toInput(axis.common.origin()), axis.common.direction(), family.confidence,
                             family.score, family.support});
    eraseIf(answer.planes,
            [&](const SymmetryPlane& plane) { return contains(cloud.toNormalized(plane), axis.common); });
  }
  if (cloud.isSurface()) limitByPart(cloud, symmetries, test, answer.planes);
}

std::vector<SymmetryPlane> withoutPlanesThrough(std::vector<SymmetryPlane> planes, const SymmetryCenter& center,
                                                const NormalizedCloud& cloud) {
  eraseIf(planes, [&](const SymmetryPlane& plane) {
    return std::abs(plane.signedDistance(center.point)) <= kDetection.families.contained_offset * cloud.scale;
  });
  return planes;
}

std::vector<SymmetryPlane> withoutPlanesThrough(std::vector<SymmetryPlane> planes,
                                                const std::vector<SymmetryAxis>& axes, const NormalizedCloud& cloud) {
  const auto belongs = [&](const SymmetryPlane& plane) {
    return std::any_of(axes.begin(), axes.end(), [&](const SymmetryAxis& axis) {
      return contains(cloud.toNormalized(plane), cloud.lineOf(axis));
    });
  };
  eraseIf(planes, belongs);
  return planes;
}

}  // namespace pcl_symmetry
