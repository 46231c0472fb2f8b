#include "core/detection/plane_families.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <iterator>
#include <utility>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/base/statistics.h"
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

std::vector<ReflectionPlane> planesContaining(const Line3d& line, const std::vector<ReflectionPlane>& planes) {
  std::vector<ReflectionPlane> through;
  std::copy_if(planes.begin(), planes.end(), std::back_inserter(through),
               [&](const ReflectionPlane& plane) { return contains(plane, line); });
  return through;
}

/// For the lines that each two of the first planes share: the planes that contain them, these two among them.
std::vector<std::vector<ReflectionPlane>> bundlesOf(const std::vector<ReflectionPlane>& planes, std::size_t num_first) {
  std::vector<std::vector<ReflectionPlane>> bundles;
  for (std::size_t i = 0; i < std::min(planes.size(), num_first); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (planes[i].angleTo(planes[j]) >= kDetection.families.min_pair_angle)
        bundles.push_back(planesContaining(commonLine({planes[i], planes[j]}), planes));
  return bundles;
}

/// The lattice of the planes that contain a line.
std::optional<PlaneLattice> latticeAbout(const Line3d& line, const std::vector<ReflectionPlane>& planes) {
  std::vector<double> angles;
  for (const ReflectionPlane& plane : planes)
    if (contains(plane, line)) angles.push_back(angleAbout(line, plane));
  if (angles.size() < kDetection.families.min_planes) return std::nullopt;
  for (int fold = 3; fold <= kDetection.families.max_fold; ++fold) {
    std::complex<double> sum = 0.0;
    for (const double angle : angles) sum += std::polar(1.0, 2.0 * fold * angle);
    const double phase = std::arg(sum) / (2.0 * fold), step = kPi / fold;
    double most = 0.0;
    for (const double angle : angles) most = std::max(most, std::abs(std::remainder(angle - phase, step)));
    if (most > std::min(kDetection.families.max_folded * step, kDetection.families.max_off_angle)) continue;
    // Two of the angles give line and phase; each other one falls this close to a plane by chance, and the folds below
    // were tried before.
    const double by_chance = std::min(1.0, 2.0 * std::max(most, 0.25 * kDetection.families.max_folded * step) / step);
    const double chance = fold * std::pow(by_chance, static_cast<double>(angles.size()) - 1.0);
    if (chance > kDetection.families.max_chance) return std::nullopt;
    return PlaneLattice{line, fold, phase, static_cast<int>(angles.size())};
  }
  return std::nullopt;
}

}  // namespace

bool contains(const ReflectionPlane& plane, const Line3d& line, double tolerance) {
  return std::abs(plane.normal().dot(line.direction())) <= std::sin(kDetection.families.contained_angle) &&
         std::abs(plane.signedDistance(line.origin())) <= tolerance;
}

ReflectionPlane PlaneLattice::plane(double k) const {
  return planeThrough(line, phase + k * kPi / fold);
}

std::optional<PlaneLattice> findLattice(const std::vector<ReflectionPlane>& planes) {
  std::optional<PlaneLattice> best;
  for (const std::vector<ReflectionPlane>& through : bundlesOf(planes, kDetection.families.max_pairs)) {
    if (through.size() < kDetection.families.min_planes) continue;
    const std::optional<PlaneLattice> lattice = latticeAbout(commonLine(through), planes);
    if (lattice && (!best || lattice->num_planes > best->num_planes)) best = lattice;
  }
  return best;
}

namespace {

/// How strongly a frequency stands out of those on both sides of it.
/// \param power of a frequency.
template <typename Power>
double aboveBeside(int m, const Power& power) {
  std::vector<double> beside;
  for (int k = std::max(1, m - kDetection.folds.compared_frequencies); k <= m + kDetection.folds.compared_frequencies;
       ++k)
    if (k != m) beside.push_back(power(k));
  return power(m) / std::max(median(beside), 1e-30);
}

/// The folds of points about a line.
class FoldSpectrum {
public:
  /// \param num_slabs across the line, each of which is cut into rings of its own.
  FoldSpectrum(const Points& points, const Line3d& line, int num_slabs)
      : squares_(kDetection.folds.max_frequency + kDetection.folds.compared_frequencies + 1, 0.0),
        powers_(squares_.size(), 0.0) {
    const Eigen::Vector3d u = line.direction().unitOrthogonal(), v = line.direction().cross(u);
    std::vector<Place> places;
    for (const int i : drawSamples(points.cols(), kDetection.folds.spectrum_samples, 1)) {
      const Eigen::Vector3d x = points.col(i).cast<double>() - line.origin();
      const std::complex<double> across(x.dot(u), x.dot(v));
      const double distance = std::abs(across);
      if (distance > 0.0) places.push_back({x.dot(line.direction()), distance, across / distance});
    }
    inParts(places.begin(), places.end(), num_slabs, &Place::height, [&](Places first, Places last) {
      inParts(first, last, kDetection.folds.rings, &Place::distance,
              [&](Places from, Places to) { addRing(from, to); });
    });
  }

  /// What planes at the best angle explain of the density of all rings at a frequency; 4 by chance.
  double power(int m) const { return 0.5 * (powers_[m] + std::abs(squares_[m])); }
  /// By how much the frequency has more power than those beside it; 0 where that may be chance.
  double prominence(int m) const {
    const double now = aboveBeside(m, [this](int k) { return power(k); });
    return power(m) >= kDetection.folds.min_power && now >= kDetection.folds.stands_out ? now : 0.0;
  }
  /// Angle of the normal of a plane, radians.
  double phase(int m) const { return 0.5 * kPi + std::arg(squares_[m]) / (2.0 * m); }

private:
  /// Where a point lies about the line.
  struct Place {
    double height, distance;
    std::complex<double> direction;
  };
  using Places = std::vector<Place>::iterator;

  /// Sorts indices by a member, and calls for parts that have as many of them each.
  template <typename Call>
  static void inParts(Places first, Places last, int num_parts, double Place::*member, const Call& call) {
    std::sort(first, last, [&](const Place& a, const Place& b) { return a.*member < b.*member; });
    const std::ptrdiff_t size = last - first;
    for (int part = 0; part < num_parts; ++part)
      call(first + size * part / num_parts, first + size * (part + 1) / num_parts);
  }

  void addRing(Places first, Places last) {
    std::vector<std::complex<double>> sums(squares_.size(), 0.0);
    for (auto place = first; place != last; ++place) {
      std::complex<double> turned = 1.0;
      for (std::size_t m = 1; m < sums.size(); ++m) sums[m] += turned *= place->direction;
    }
    const auto count = static_cast<double>(last - first);
    for (std::size_t m = 1; m < sums.size() && count > 0.0; ++m) {
      squares_[m] += sums[m] * sums[m] / count;
      powers_[m] += std::norm(sums[m]) / count;
    }
  }

  std::vector<std::complex<double>> squares_;  ///< by frequency: sums over the rings
  std::vector<double> powers_;                 ///< the same without their angles
};

/// Angle of the normal of a plane of a polygon by the mean of f at the reflected points: by their angle, planes through
/// the line reflect the cloud best there.
/// \return none where the frequency does not stand out of the mean.
std::optional<double> phaseByReflections(const NormalizedCloud& cloud, const Line3d& line, int fold, int num_threads) {
  const std::vector<int> samples = drawSamples(cloud.points.cols(), kDetection.folds.phase_samples, 1);
  const PlaneLattice fan{line, kDetection.folds.angles, 0.0, 0};
  std::vector<double> mean(kDetection.folds.angles, 0.0);
  parallelBlocks(kDetection.folds.angles, num_threads, [&](std::size_t k) {
    const ReflectionPlane plane = cloud.toInput(fan.plane(static_cast<double>(k)));
    for (const int i : samples) mean[k] += cloud.edt(plane.reflect(cloud.toInput(cloud.points.col(i).cast<double>())));
  });
  const auto coefficient = [&](int m) {
    std::complex<double> sum = 0.0;
    for (int k = 0; k < kDetection.folds.angles; ++k)
      sum += mean[k] * std::polar(1.0, 2.0 * kPi * static_cast<double>(m) * k / kDetection.folds.angles);
    return sum;
  };
  const double prominence = aboveBeside(fold, [&](int m) { return std::norm(coefficient(m)); });
  if (prominence < kDetection.folds.reflections_stand_out) return std::nullopt;
  return std::arg(coefficient(fold)) / (2.0 * fold);
}

/// What several planes say together.
double confidenceTogether(const std::vector<MeasuredPlane>& judged, int first, int step) {
  PlaneEvidence mean = judged[first].evidence;
  // What differs from plane to plane of a cloud
  static constexpr std::array kMeans{&PlaneEvidence::share,   &PlaneEvidence::double_share, &PlaneEvidence::hold,
                                     &PlaneEvidence::support, &PlaneEvidence::conflict,     &PlaneEvidence::score,
                                     &PlaneEvidence::unknown};
  for (double PlaneEvidence::*member : kMeans) {
    double sum = 0.0, count = 0.0;
    for (std::size_t k = first; k < judged.size(); k += step) {
      sum += judged[k].evidence.*member;
      count += 1.0;
    }
    mean.*member = sum / count;
  }
  return planeConfidence(mean);
}

/// The least confidence of parts of a polygon that may be symmetries while the others are not.
double leastTogether(const std::vector<MeasuredPlane>& judged) {
  double least = confidenceTogether(judged, 0, 1);
  for (const int divisor : kDetection.folds.divisors)
    if (judged.size() % divisor == 0 && judged.size() > static_cast<std::size_t>(divisor))
      for (int first = 0; first < divisor; ++first) least = std::min(least, confidenceTogether(judged, first, divisor));
  return least;
}

/// \param planes most confident first, input frame.
std::optional<PlaneLattice> bestLattice(const std::vector<SymmetryPlane>& planes, const NormalizedCloud& cloud,
                                        const Points& all, int num_threads) {
  std::vector<ReflectionPlane> likely;
  for (const SymmetryPlane& plane : planes)
    if (const ReflectionPlane normalized = cloud.toNormalized(plane);
        isDecided(plane) && !kSameMaximum.anySame(likely, normalized))
      likely.push_back(normalized);
  for (const std::vector<ReflectionPlane>& through : bundlesOf(likely, kDetection.folds.max_line_pairs))
    if (const auto lattice = latticeBySpectrum(cloud, all, commonLine(through), num_threads)) return lattice;
  return std::nullopt;
}

}  // namespace

std::optional<PlaneLattice> latticeBySpectrum(const NormalizedCloud& cloud, const Points& all, const Line3d& line,
                                              int num_threads) {
  const FoldSpectrum spectrum(all, line, 1);
  int fold = 0;
  double most = 0.0;
  for (int m = kDetection.folds.min_fold; m <= kDetection.folds.max_frequency; ++m) {
    const double now = spectrum.prominence(m);
    if (now <= most) continue;
    most = now;
    fold = m;
  }
  if (fold == 0) return std::nullopt;
  // A polygon has the multiples of its frequency, too; and so have two planes across each other, with the frequency 2.
  for (int m = 2; m < fold; ++m)
    if (fold % m == 0 && spectrum.prominence(m) > 0.0) {
      fold = m;
      break;
    }
  if (fold < kDetection.folds.min_fold) return std::nullopt;
  const std::optional<double> phase = phaseByReflections(cloud, line, fold, num_threads);
  return PlaneLattice{line, fold, phase ? *phase : FoldSpectrum(all, line, kDetection.folds.slabs).phase(fold), 0};
}

namespace {

std::vector<Candidate> planesOf(const PlaneLattice& lattice) {
  std::vector<Candidate> candidates;
  for (int k = 0; k < lattice.fold; ++k) candidates.push_back({lattice.plane(k), false});
  return candidates;
}

/// Whether the planes halfway between those of a lattice are no symmetries of a surface. Folded into the sector between
/// two planes, the points are denser by twice the fold, and resolve what single planes do not. The halfway plane has to
/// bring fewer of them to within the tolerance of others than are so close without it, beyond chance.
bool isPolygon(const PlaneLattice& lattice, const Points& points, double tolerance) {
  const double step = kPi / lattice.fold;
  const Eigen::Vector3d up = lattice.line.direction(), across = lattice.plane(0.0).normal(), along = across.cross(up);
  Points folded(3, 3 * points.cols()), halfway(3, points.cols());  // the sector and its reflections on both sides
  std::vector<double> angles{0.0, step};
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d x = points.col(i).cast<double>() - lattice.line.origin();
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
  // Vertices of a mesh may lie at few angles, and tell nothing about those between.
  std::sort(angles.begin(), angles.end());
  for (std::size_t i = 1; i < angles.size(); ++i)
    if (angles[i] - angles[i - 1] > kDetection.folds.max_gap * step) return false;
  const std::vector<int> samples = drawSamples(points.cols(), kDetection.folds.phase_samples, 1);
  const auto search = makeFlannSearch(folded);
  const auto count = static_cast<double>(samples.size());
  const auto shareWithin = [&](const Points& queries) {
    constexpr int kNumClosest = 4;  // three may be the point itself
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

/// The polygon of a surface, whose planes are closer to each other than single ones are told apart.
void addClosePlanes(const JudgedCloud& judged, Found& found) {
  const NormalizedCloud& cloud = judged.cloud;
  std::vector<ReflectionPlane> symmetries, through;
  for (const SymmetryPlane& plane : found.planes)
    if (plane.kind == PlaneKind::Symmetry) symmetries.push_back(cloud.toNormalized(plane));
  for (std::vector<ReflectionPlane>& containing : bundlesOf(symmetries, kDetection.families.max_pairs))
    if (containing.size() > through.size()) through = std::move(containing);
  if (through.size() < kDetection.families.min_planes) return;
  const Line3d line = commonLine(through);
  std::optional<PlaneLattice> lattice = latticeBySpectrum(cloud, cloud.points, line, judged.options.num_threads);
  if (!lattice || kPi / lattice->fold > kDetection.decide.slope_angle ||
      !isPolygon(*lattice, cloud.points, judged.measure.tolerance()))
    return;
  std::complex<double> sum = 0.0;  // the planes that were found fix the angle better
  for (const ReflectionPlane& plane : through)
    if (const double angle = angleAbout(line, plane), step = kPi / lattice->fold;
        std::abs(std::remainder(angle - lattice->phase, step)) <= kDetection.families.max_folded * step)
      sum += std::polar(1.0, 2.0 * lattice->fold * angle);
  if (std::abs(sum) > 0.0) lattice->phase = std::arg(sum) / (2.0 * lattice->fold);
  std::vector<SymmetryPlane> completed;
  for (MeasuredPlane& one : judged.decision.judge(planesOf(*lattice))) {
    if (one.plane.kind != PlaneKind::Symmetry) return;
    completed.push_back(std::move(one.plane));
  }
  for (SymmetryPlane& plane : found.planes)
    if (!contains(cloud.toNormalized(plane), line)) completed.push_back(std::move(plane));
  found.planes = std::move(completed);
  found.polygon = lattice;
}

}  // namespace

void completePolygon(const JudgedCloud& judged, Found& found) {
  const NormalizedCloud& cloud = judged.cloud;
  if (cloud.kind() == CloudKind::Surface) return addClosePlanes(judged, found);
  if (!kKindRules.has_polygons[cloud.kind()]) return;
  sortFalling(found.planes, &SymmetryPlane::confidence);
  const std::optional<PlaneLattice> lattice = bestLattice(found.planes, cloud, judged.all, judged.options.num_threads);
  if (!lattice) return;
  std::vector<MeasuredPlane> of_lattice = judged.decision.judge(planesOf(*lattice));
  const double together = withOdds(leastTogether(of_lattice), kDetection.folds.odds_of_polygon);
  if (together < judged.options.min_confidence) return;
  // All planes tell where the polygon lies: those that noise moved away are dropped.
  eraseIf(found.planes, [&](const SymmetryPlane& plane) { return contains(cloud.toNormalized(plane), lattice->line); });
  for (MeasuredPlane& one : of_lattice) {
    if (together > one.plane.confidence)
      changeConfidence(one.plane, together, "the planes of a regular polygon together", judged.options);
    found.planes.push_back(std::move(one.plane));
  }
  found.polygon = lattice;
}

}  // namespace pcl_symmetry
