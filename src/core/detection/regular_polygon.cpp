#include "core/detection/plane_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <iterator>
#include <utility>

#include "core/base/constants.h"
#include "core/base/lists.h"
#include "core/base/statistics.h"
#include "core/detection/plane_decision.h"
#include "core/geometry/geometry_rules.h"
#include "core/geometry/point_samples.h"
#include "pcl_symmetry/core/closest_point_search.h"

namespace pcl_symmetry {

namespace {

/// Angle of the normal of a plane about a line, in [0, pi).
double angleAbout(const Line3d& line, const ReflectionPlane& plane) {
  const Eigen::Vector3d u = line.direction().unitOrthogonal(), v = line.direction().cross(u);
  const double angle = std::atan2(plane.normal().dot(v), plane.normal().dot(u));
  return angle < 0.0 ? angle + kPi : angle;
}

/// For each common line of two of the first \p num_first planes, all planes that contain it, including these two.
std::vector<std::vector<ReflectionPlane>> bundlesOf(const std::vector<ReflectionPlane>& planes, std::size_t num_first) {
  std::vector<std::vector<ReflectionPlane>> bundles;
  for (std::size_t i = 0; i < std::min(planes.size(), num_first); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      if (planes[i].angleTo(planes[j]) < kDetection.families.min_pair_angle) continue;
      const Line3d line = commonLine({planes[i], planes[j]});
      std::copy_if(planes.begin(), planes.end(), std::back_inserter(bundles.emplace_back()),
                   [&](const ReflectionPlane& plane) { return contains(plane, line); });
    }
  return bundles;
}

/// The folds of points about a line.
class FoldSpectrum {
public:
  /// \param num_slabs number of slabs across the line, each of which is divided into rings of its own.
  FoldSpectrum(const Points& points, const Line3d& line, int num_slabs)
      : squares_(kDetection.folds.max_frequency + kDetection.folds.compared_frequencies + 1, 0.0),
        powers_(squares_.size(), 0.0) {
    const Eigen::Vector3d u = line.direction().unitOrthogonal(), v = line.direction().cross(u);
    std::vector<Position> positions;
    for (const int i : drawSamples(points.cols(), kDetection.folds.spectrum_samples, 1)) {
      const Eigen::Vector3d x = points.col(i).cast<double>() - line.origin();
      const std::complex<double> across(x.dot(u), x.dot(v));
      const double distance = std::abs(across);
      if (distance > 0.0) positions.push_back({x.dot(line.direction()), distance, across / distance});
    }
    inParts(positions.begin(), positions.end(), num_slabs, &Position::height, [&](Positions first, Positions last) {
      inParts(first, last, kDetection.folds.rings, &Position::distance,
              [&](Positions from, Positions to) { addRing(from, to); });
    });
  }

  /// How much of the density of all rings the planes at the best angle explain at a frequency; about 4 by chance.
  double power(int m) const { return 0.5 * (powers_[m] + std::abs(squares_[m])); }
  /// Excess power of the frequency over those on either side; 0 where it may be chance.
  double prominence(int m) const {
    std::vector<double> beside;
    for (int k = std::max(1, m - kDetection.folds.compared_frequencies); k <= m + kDetection.folds.compared_frequencies;
         ++k)
      if (k != m) beside.push_back(power(k));
    const double ratio = power(m) / std::max(median(beside), 1e-30);
    return power(m) >= kDetection.folds.min_power && ratio >= kDetection.folds.stands_out ? ratio : 0.0;
  }
  /// Angle of the normal of a plane, radians.
  double phase(int m) const { return 0.5 * kPi + std::arg(squares_[m]) / (2.0 * m); }

private:
  /// Cylindrical coordinates of a point about the line.
  struct Position {
    double height, distance;
    std::complex<double> direction;
  };
  using Positions = std::vector<Position>::iterator;

  /// Sorts points by a member, and calls back for each of num_parts runs of equal size.
  template <typename Call>
  static void inParts(Positions first, Positions last, int num_parts, double Position::*member, const Call& call) {
    std::sort(first, last, [&](const Position& a, const Position& b) { return a.*member < b.*member; });
    const std::ptrdiff_t size = last - first;
    for (int part = 0; part < num_parts; ++part)
      call(first + size * part / num_parts, first + size * (part + 1) / num_parts);
  }

  void addRing(Positions first, Positions last) {
    std::vector<std::complex<double>> sums(squares_.size(), 0.0);
    for (auto position = first; position != last; ++position) {
      std::complex<double> rotated = 1.0;
      for (std::size_t m = 1; m < sums.size(); ++m) sums[m] += rotated *= position->direction;
    }
    const auto count = static_cast<double>(last - first);
    for (std::size_t m = 1; m < sums.size() && count > 0.0; ++m) {
      squares_[m] += sums[m] * sums[m] / count;
      powers_[m] += std::norm(sums[m]) / count;
    }
  }

  std::vector<std::complex<double>> squares_;  ///< by frequency: sums over the rings, with their angles
  std::vector<double> powers_;                 ///< by frequency: sums over the rings, without their angles
};

/// The confidence of several planes by their mean evidence.
double confidenceTogether(const std::vector<MeasuredPlane>& judged, int first, int step) {
  PlaneEvidence mean = judged[first].evidence;
  // Evidence that differs between the planes of one cloud; the rest describes the cloud.
  static constexpr std::array kAveraged{
      &PlaneEvidence::share,    &PlaneEvidence::double_share, &PlaneEvidence::stiffness, &PlaneEvidence::support,
      &PlaneEvidence::conflict, &PlaneEvidence::score,        &PlaneEvidence::unknown};
  for (double PlaneEvidence::*member : kAveraged) {
    double sum = 0.0, count = 0.0;
    for (std::size_t k = first; k < judged.size(); k += step) {
      sum += judged[k].evidence.*member;
      count += 1.0;
    }
    mean.*member = sum / count;
  }
  return planeConfidence(mean);
}

/// The least confidence of a part of the polygon's planes that may be symmetries while the others are not.
double leastTogether(const std::vector<MeasuredPlane>& judged) {
  double least = confidenceTogether(judged, 0, 1);
  for (const int divisor : kDetection.folds.divisors)
    if (judged.size() % divisor == 0 && judged.size() > static_cast<std::size_t>(divisor))
      for (int first = 0; first < divisor; ++first) least = std::min(least, confidenceTogether(judged, first, divisor));
  return least;
}

/// \param planes most confident first, input frame.
std::optional<RegularPolygon> bestPolygon(const std::vector<SymmetryPlane>& planes, const NormalizedCloud& cloud,
                                          const Points& all) {
  const std::vector<ReflectionPlane> likely =
      kSameMaximum.distinct(planesOf(planes, {PlaneKind::Symmetry, PlaneKind::Possible}, cloud));
  for (const std::vector<ReflectionPlane>& through : bundlesOf(likely, kDetection.folds.max_paired_planes))
    if (const auto polygon = polygonBySpectrum(all, commonLine(through))) return polygon;
  return std::nullopt;
}

std::vector<Candidate> candidatesOf(const RegularPolygon& polygon) {
  std::vector<Candidate> candidates;
  for (int k = 0; k < polygon.fold; ++k) candidates.push_back({polygon.plane(k)});
  return candidates;
}

/// Whether the planes halfway between the planes of a polygon are no symmetries of a surface. The points are folded
/// into the sector between two planes, where they are denser by twice the fold and resolve what single planes do not.
/// Reflecting them in the halfway plane must bring clearly fewer of them to within the tolerance of other points than
/// are so close without it.
bool isPolygon(const RegularPolygon& polygon, const Points& points, double tolerance) {
  const double step = kPi / polygon.fold;
  const Eigen::Vector3d up = polygon.line.direction(), across = polygon.plane(0.0).normal(), along = across.cross(up);
  Points folded(3, 3 * points.cols()), halfway(3, points.cols());  // the sector and its reflections on both sides
  std::vector<double> angles{0.0, step};
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d x = points.col(i).cast<double>() - polygon.line.origin();
    const double angle = std::abs(std::remainder(std::atan2(x.dot(across), x.dot(along)), 2.0 * step));
    const double radius = std::hypot(x.dot(across), x.dot(along));
    const auto at = [&](double a) -> Eigen::Vector3f {
      return Eigen::Vector3d(radius * std::cos(a), radius * std::sin(a), x.dot(up)).cast<float>();
    };
    angles.push_back(angle);
    folded.col(3 * i) = at(angle);
    folded.col(3 * i + 1) = at(-angle);
    folded.col(3 * i + 2) = at(2.0 * step - angle);
    halfway.col(i) = at(step - angle);
  }
  // Vertices of a mesh may lie at few angles and are uninformative between them.
  std::sort(angles.begin(), angles.end());
  for (std::size_t i = 1; i < angles.size(); ++i)
    if (angles[i] - angles[i - 1] > kDetection.folds.max_gap * step) return false;
  const std::vector<int> samples = drawSamples(points.cols(), kDetection.folds.halfway_samples, 1);
  const auto search = makeFlannSearch(folded);
  const auto count = static_cast<double>(samples.size());
  const auto shareWithin = [&](const Points& queries) {
    constexpr int kNumClosest = 4;  // three neighbors may be the point itself
    std::vector<int> closest;
    std::vector<float> sq_distances;
    search->search(queries, kNumClosest, closest, sq_distances);
    double within = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      std::size_t k = kNumClosest * i;
      while (k + 1 < kNumClosest * (i + 1) && closest[k] / 3 == samples[i]) ++k;
      within += sq_distances[k] <= tolerance * tolerance ? 1.0 : 0.0;
    }
    return within / count;
  };
  std::vector<int> in_folded;
  for (const int i : samples) in_folded.push_back(3 * i);
  const double own = shareWithin(pointsAt(folded, in_folded)), mapped = shareWithin(pointsAt(halfway, samples));
  const double error = std::sqrt((own * (1.0 - own) + mapped * (1.0 - mapped)) / count);
  return mapped < kSymmetricShare * own - kDetection.folds.errors * error;
}

/// The polygon of a surface, whose planes are too close to be distinguished individually.
void addClosePlanes(const PlaneSearch& search, DetectionState& state) {
  const NormalizedCloud& cloud = search.cloud;
  std::vector<ReflectionPlane> through;
  for (std::vector<ReflectionPlane>& containing :
       bundlesOf(planesOf(state.answer.planes, {PlaneKind::Symmetry}, cloud), kDetection.families.max_paired_planes))
    if (containing.size() > through.size()) through = std::move(containing);
  if (through.size() < kDetection.families.min_planes) return;
  const Line3d line = commonLine(through);
  std::optional<RegularPolygon> polygon = polygonBySpectrum(cloud.points, line);
  if (!polygon || kPi / polygon->fold > kDetection.decide.slope_angle ||
      !isPolygon(*polygon, cloud.points, search.measure.tolerance()))
    return;
  std::complex<double> sum = 0.0;  // the planes that were found give a better angle
  for (const ReflectionPlane& plane : through)
    if (const double angle = angleAbout(line, plane), step = kPi / polygon->fold;
        std::abs(std::remainder(angle - polygon->phase, step)) <= kDetection.families.max_folded * step)
      sum += std::polar(1.0, 2.0 * polygon->fold * angle);
  if (std::abs(sum) > 0.0) polygon->phase = std::arg(sum) / (2.0 * polygon->fold);
  std::vector<SymmetryPlane> completed;
  for (MeasuredPlane& one : search.judge(candidatesOf(*polygon))) {
    if (one.plane.kind != PlaneKind::Symmetry) return;
    completed.push_back(std::move(one.plane));
  }
  for (SymmetryPlane& plane : state.answer.planes)
    if (!contains(cloud.toNormalized(plane), line)) completed.push_back(std::move(plane));
  state.answer.planes = std::move(completed);
  state.polygon = polygon;
}

}  // namespace

ReflectionPlane RegularPolygon::plane(double k) const {
  return planeThrough(line, phase + k * kPi / fold);
}

std::optional<RegularPolygon> polygonBySpectrum(const Points& all, const Line3d& line) {
  const FoldSpectrum spectrum(all, line, 1);
  int fold = 0;
  double most = 0.0;
  for (int m = kDetection.folds.min_fold; m <= kDetection.folds.max_frequency; ++m) {
    const double prominence = spectrum.prominence(m);
    if (prominence <= most) continue;
    most = prominence;
    fold = m;
  }
  if (fold == 0) return std::nullopt;
  // The multiples of the frequency of a polygon are also strong, and so is frequency 2 for two perpendicular planes.
  for (int m = 2; m < fold; ++m)
    if (fold % m == 0 && spectrum.prominence(m) > 0.0) {
      fold = m;
      break;
    }
  if (fold < kDetection.folds.min_fold) return std::nullopt;
  return RegularPolygon{line, fold, FoldSpectrum(all, line, kDetection.folds.slabs).phase(fold)};
}

void completePolygon(const PlaneSearch& search, DetectionState& state) {
  const NormalizedCloud& cloud = search.cloud;
  if (cloud.isSurface()) return addClosePlanes(search, state);
  if (!cloud.isVolume()) return;
  sortDescending(state.answer.planes, &SymmetryPlane::confidence);
  const std::optional<RegularPolygon> polygon = bestPolygon(state.answer.planes, cloud, search.all_points);
  if (!polygon) return;
  std::vector<MeasuredPlane> of_polygon = search.judge(candidatesOf(*polygon));
  const double together = withOdds(leastTogether(of_polygon), kDetection.folds.odds_of_polygon);
  if (together < search.options.min_confidence) return;
  // All planes determine the polygon; planes that noise moved away from it are dropped.
  eraseIf(state.answer.planes,
          [&](const SymmetryPlane& plane) { return contains(cloud.toNormalized(plane), polygon->line); });
  for (MeasuredPlane& one : of_polygon) {
    if (together > one.plane.confidence)
      changeConfidence(one.plane, together, "the planes of a regular polygon together", search.options);
    state.answer.planes.push_back(std::move(one.plane));
  }
  state.polygon = polygon;
}

}  // namespace pcl_symmetry
