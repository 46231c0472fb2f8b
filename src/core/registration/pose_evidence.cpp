#include "core/registration/pose_evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <sstream>

#include "core/base/statistics.h"
#include "core/geometry/geometry_rules.h"
#include "core/registration/registration_fit.h"
#include "core/registration/registration_rules.h"

namespace pcl_symmetry {

namespace {

/// Whether a depth image shows a surface in front of a point, or slightly beside it.
/// \param margin least distance of that surface from the point.
/// \param beside how far from the ray of the point the surface may be; 0 = only on its ray.
bool isHidden(const Visibility& view, const Eigen::Vector3d& x, const Eigen::Vector3d& ray, double margin,
              double beside) {
  const Eigen::Vector3d u = beside * ray.unitOrthogonal(), v = ray.cross(u);
  const auto isBehind = [&](const Eigen::Vector3d& at) { return view.depthBehind(at) > margin; };
  return isBehind(x) || (beside > 0.0 && (isBehind(x + u) || isBehind(x - u) || isBehind(x + v) || isBehind(x - v)));
}

double diameterOf(const PosedSurface& surface) {
  return 2.0 * boundingBall(surface.points).radius;
}

/// Numbers of points of one surface that are examined, that face the interior of another one, and that lie on it.
struct Overlap {
  double num_points = 0.0, num_facing = 0.0, num_on = 0.0;

  double share() const { return num_on / num_points; }
  /// Laplace's rule: never 0 or 1.
  double agreement() const { return (num_on + 1.0) / (num_facing + 2.0); }
};

Overlap overlapOf(const PosedSurface& from, const Landing& landing, const PosedSurface& to, double tolerance,
                  double size) {
  const auto& rules = kRegistration;
  const Eigen::Index count = landing.images.cols();
  const std::vector<char>& borders = to.borders.get();
  Overlap overlap;
  overlap.num_points = static_cast<double>(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const int j = landing.closest[i];
    const double height = std::abs(to.normals.col(j).dot(landing.images.col(i) - to.points.col(j)));
    const double across = std::sqrt(std::max(0.0, landing.sq_distances[i] - height * height));
    const float cosine = normalCosine(from, to, landing, i);
    if (borders[j] || across > rules.facing_spacings * to.spacing[j] || height > rules.facing_reach * size ||
        cosine < -rules.agreeing_cosine)
      continue;
    overlap.num_facing += 1.0;
    if (cosine > rules.agreeing_cosine && height < tolerance) overlap.num_on += 1.0;
  }
  return overlap;
}

/// The parts of a surface that a scanner should have measured but did not.
struct NotMeasured {
  double contradicted = 0.0, missing = 0.0, aside = 0.0, outside = 0.0;  ///< see PoseEvidence
};

/// The convex outline of a scan as its scanner saw it, a polygon around its rays.
class Outline {
public:
  explicit Outline(const PosedSurface& scan) : viewpoint_(scan.seen->viewpoint()) {
    forward_ = (scan.points.cast<double>().rowwise().mean() - viewpoint_).normalized();
    const Eigen::Vector3d right = forward_.unitOrthogonal(), down = forward_.cross(right);
    for (int k = 0; k < kNumSides; ++k) {
      const double angle = 2.0 * kPi * k / kNumSides;
      outward_.row(k) = std::cos(angle) * right + std::sin(angle) * down;
    }
    reach_.setConstant(-std::numeric_limits<double>::infinity());
    for (Eigen::Index i = 0; i < scan.points.cols(); ++i)
      reach_ = reach_.cwiseMax(slopes(scan.points.col(i).cast<double>()));
  }

  /// \return distance by which a point is outside; negative inside.
  double distance(const Eigen::Vector3d& x) const {
    return (slopes(x) - reach_).maxCoeff() * forward_.dot(x - viewpoint_);
  }

private:
  static constexpr int kNumSides = 32;
  using Slopes = Eigen::Matrix<double, kNumSides, 1>;

  /// Of the ray through a point, toward each side.
  Slopes slopes(const Eigen::Vector3d& x) const { return outward_ * (x - viewpoint_) / forward_.dot(x - viewpoint_); }

  Eigen::Vector3d viewpoint_, forward_;
  Eigen::Matrix<double, kNumSides, 3> outward_;
  Slopes reach_;
};

/// \param on_scan where the points of the surface lie on the scan, as from land().
NotMeasured notMeasured(const PosedSurface& surface, const PosedSurface& scan, const Eigen::Isometry3d& T_scan_surface,
                        const Landing& on_scan, double tolerance, double far) {
  if (!scan.seen) return {};
  NotMeasured area;
  double measured = 0.0;
  int num_judged = 0;
  const Outline outline(scan);
  for (const VisiblePoint& point :
       visiblePoints(surface, scan, T_scan_surface, static_cast<int>(on_scan.images.cols()), true)) {
    const double distance = std::sqrt(scan.sqDiscDistance(on_scan, point.index));
    const bool is_measured = std::min(std::abs(point.height), distance) < tolerance;
    if (!is_measured && point.height < 0.0) continue;  // behind the measured surface: unknown
    if (is_measured) {
      measured += point.cosine;
    } else {
      const bool is_far = distance > far, is_missing = std::isinf(point.height);
      (is_missing ? area.missing : area.contradicted) += point.cosine;
      if (is_far) area.aside += point.cosine;
      if (is_missing)
        area.outside += outline.distance(point.position) > tolerance ? point.cosine : -point.cosine;
      else if (is_far)
        area.outside += point.cosine;
    }
    ++num_judged;
  }
  if (num_judged < kRegistration.min_visible) return {};
  const double all = measured + area.contradicted + area.missing;
  return {area.contradicted / all, area.missing / all, area.aside / all, std::max(0.0, area.outside) / all};
}

/// Share of the points that lie farther than \p far from a whole model, unless it ends there at an open border.
double shareOff(const Landing& landing, const PosedSurface& model, double far) {
  double num_off = 0.0;
  for (Eigen::Index i = 0; i < landing.images.cols(); ++i)
    num_off += model.sqDiscDistance(landing, i) > far * far && !model.borders.get()[landing.closest[i]] ? 1.0 : 0.0;
  return num_off / static_cast<double>(landing.images.cols());
}

/// A lower limit of the share of points that lie on the surface. The width of the weights does not grow with the
/// spacing of the points, so that few points on a wrong object do not count; the discs about the points of the surface
/// are as wide as their spacing, so that their density does not matter. Points on the far side of a thin part do not
/// count.
double shareOnSurface(const PosedSurface& from, const Landing& landing, const PosedSurface& to) {
  const double width = kRegistration.contact;
  const auto size = static_cast<double>(landing.images.cols());
  double sum = 0.0;
  for (Eigen::Index i = 0; i < landing.images.cols(); ++i) {
    if (normalCosine(from, to, landing, i) < -kRegistration.agreeing_cosine) continue;
    sum += std::exp(static_cast<float>(-1.0 / (width * width)) * to.sqDiscDistance(landing, i));
  }
  // Three standard errors of a share, each at most half divided by the root of the number of points.
  return std::max(0.0, sum / size - 1.5 / std::sqrt(size));
}

}  // namespace

std::vector<VisiblePoint> visiblePoints(const PosedSurface& surface, const PosedSurface& scan,
                                        const Eigen::Isometry3d& T_scan_surface, int num_points, bool is_strict) {
  const auto size = std::min<Eigen::Index>(num_points, surface.points.cols());
  const Eigen::Isometry3f pose = T_scan_surface.cast<float>();
  Points positions(3, size);
  for (Eigen::Index i = 0; i < size; ++i) positions.col(i) = pose * surface.points.col(surface.order[i]);
  const Eigen::Vector3d viewpoint = scan.seen->viewpoint();
  const std::optional<Visibility> view = Visibility::fromPoints(positions, viewpoint);
  std::vector<VisiblePoint> visible;
  if (!view) return visible;
  const double margin = kRegistration.hidden_depth * boundingBall(surface.points).radius;
  for (Eigen::Index i = 0; i < size; ++i) {
    const Eigen::Vector3d x = positions.col(i).cast<double>(), ray = (x - viewpoint).normalized();
    const Eigen::Vector3d n = (pose.linear() * surface.normals.col(surface.order[i])).cast<double>();
    const double cosine = std::abs(n.dot(ray));
    if (cosine < kRegistration.min_cosine || isHidden(*view, x, ray, margin, is_strict ? margin : 0.0)) continue;
    visible.push_back({i, x, n, cosine, -scan.seen->depthBehind(x) * cosine});
  }
  return visible;
}

std::vector<float> discDistances(const PosedSurface& from, const PosedSurface& to, const Eigen::Isometry3d& T_to_from,
                                 int num_points) {
  const Landing landing = land(from, to, T_to_from, num_points, true);
  std::vector<float> distances;
  for (Eigen::Index i = 0; i < landing.images.cols(); ++i)
    distances.push_back(std::sqrt(to.sqDiscDistance(landing, i)));
  return distances;
}

bool isSymmetry(const Eigen::Isometry3d& motion, const PosedSurface& model, double tolerance) {
  const std::vector<float> distances = discDistances(model, model, motion, kRegistration.evidence_points);
  return shareWithin(distances, tolerance * diameterOf(model)) >= kSymmetricShare;
}

bool mayBeSymmetry(const Eigen::Isometry3d& motion, const PosedSurface& scan) {
  const PoseEvidence evidence = poseEvidence(scan, scan, motion);
  return evidence.agreement > kRegistration.symmetric_agreement && evidence.aside < kRegistration.symmetric_aside;
}

PoseEvidence poseEvidence(const PosedSurface& scan, const PosedSurface& model, const Eigen::Isometry3d& T_model_scan) {
  const double scan_size = diameterOf(scan), model_size = diameterOf(model), size = std::min(scan_size, model_size);
  const double noise = std::max(scan.noise, model.noise);
  const double tolerance = std::max(kRegistration.tight_tolerance * size, kRegistration.tight_noises * noise);
  const Landing on_model = land(scan, model, T_model_scan, kRegistration.evidence_points);
  const Landing on_scan = land(model, scan, T_model_scan.inverse(), kRegistration.evidence_points);
  const Overlap of_scan = overlapOf(scan, on_model, model, tolerance, size),
                of_model = overlapOf(model, on_scan, scan, tolerance, size);
  PoseEvidence evidence;
  evidence.overlap_source = of_scan.share();
  evidence.overlap_target = of_model.share();
  evidence.agreement = std::min(of_scan.agreement(), of_model.agreement());
  evidence.on_surface = shareOnSurface(scan, on_model, model);
  const double near = std::max(kRegistration.near_tolerance * size, kRegistration.tight_noises * noise);
  const double far = kRegistration.facing_reach * size;
  const NotMeasured of_model_in_view = notMeasured(model, scan, T_model_scan.inverse(), on_scan, near, far),
                    of_scan_in_view = notMeasured(scan, model, T_model_scan, on_model, near, far);
  evidence.contradicted = std::max(of_model_in_view.contradicted, of_scan_in_view.contradicted);
  evidence.missing = std::max(of_model_in_view.missing, of_scan_in_view.missing);
  evidence.aside = std::max(of_model_in_view.aside, of_scan_in_view.aside);
  // A scan shows what a model lacks. Of two clouds without viewpoints, either may be a part of the other.
  const double off_model = scan.seen && !model.seen ? shareOff(on_model, model, far) : 0.0;
  evidence.outside = std::max({of_model_in_view.outside, of_scan_in_view.outside, off_model});
  evidence.noise = noise / size;
  evidence.size_ratio = scan_size / model_size;
  return evidence;
}

std::string doubtOf(const PoseEvidence& evidence) {
  const auto percent = [](double share) { return std::lround(100.0 * share); };
  std::ostringstream doubt;
  const double ratio = std::max(evidence.size_ratio, 1.0 / evidence.size_ratio);
  if (ratio > kRegistration.other_unit) {
    doubt << "one cloud is " << std::lround(ratio) << " times as large as the other (another unit?)";
    return doubt.str();
  }
  doubt << percent(evidence.overlap_source) << " % of the source lie on the target and "
        << percent(evidence.overlap_target) << " % of the target on the source; where they face each other, "
        << percent(1.0 - evidence.agreement) << " % are apart";
  if (evidence.contradicted + evidence.missing > kRegistration.some_not_measured)
    doubt << "; of the surface that a scanner should have seen, " << percent(evidence.contradicted)
          << " % lie in space it saw to be empty, and " << percent(evidence.missing) << " % were not measured";
  if (evidence.outside > 0.5 * kRegistration.max_outside)
    doubt << "; " << percent(evidence.outside) << " % belong to parts that only one of them has";
  if (evidence.uniqueness < kRegistration.some_uniqueness)
    doubt << ", and it has " << percent(evidence.uniqueness) << " % of the odds of all poses that fit";
  return doubt.str();
}

double poseConfidence(const PoseEvidence& evidence) {
  const std::array<double, kRegistrationFit.size()> terms{
      1.0,
      std::log(evidence.agreement / (1.0 - evidence.agreement)),
      evidence.on_surface,
      evidence.contradicted,
      std::log(evidence.missing + 0.1),
      std::log(std::clamp(evidence.noise, kRegistration.min_noise, kRegistration.max_noise) / 0.001 + 0.5),
      std::abs(std::log(evidence.size_ratio))};
  const double log_odds = std::inner_product(terms.begin(), terms.end(), kRegistrationFit.begin(), 0.0);
  // Surfaces that face each other must mostly agree, and both clouds must have the same parts, whatever else supports
  // the pose.
  const double same_parts = std::max(0.0, 1.0 - 0.5 * evidence.outside / kRegistration.max_outside);
  return std::min({logistic(log_odds), evidence.agreement, same_parts}) * evidence.uniqueness;
}

}  // namespace pcl_symmetry
