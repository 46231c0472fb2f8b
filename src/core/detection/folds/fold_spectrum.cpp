#include "core/detection/folds/fold_spectrum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <utility>

#include "core/base/constants.h"
#include "core/base/median.h"
#include "core/base/parallel.h"
#include "core/detection/candidates.h"
#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

namespace {

constexpr int kMostFrequency = 60, kAngles = 192;  // derived: 60 folds, as rotations of objects; three angles for each
constexpr int kLeastFold = 3;                      // derived: what is thinner on one side, or flat, has one and two
// Points reflected. chosen: the mean of f has an error of 0.004; of 3000 some folds are lost, of 10 000 no more are
// found.
constexpr int kSpectrumSamples = 5000;
// Frequencies on either side that a frequency is compared with. chosen: few enough that their level is the same.
constexpr int kBeside = 12;
constexpr double kLeastPower = 1e-30;  // derived: below the rounding of sums of 5000 values; avoids a division by 0
// Times the power beside it. chosen: noise alone reaches it in one of a million frequencies; cones of 15 folds with
// noise of two spacings have 30. At half, noise reaches it in one of a thousand, and has 58 to try.
constexpr double kStandsOut = 20.0;
constexpr std::size_t kMostLinePairs = 4;         // planes whose common lines are tried. chosen: 6 lines of 10 ms
constexpr double kLeastLineAngle = 0.1;           // radians. chosen: at smaller angles errors move the line too far
constexpr std::array<int, 3> kDivisors{2, 3, 5};  // derived: of parts of a polygon whose planes may differ

/// Fourier coefficients of the mean of f at the reflected points, by the angle of the plane over half a turn.
std::vector<std::complex<double>> spectrumAbout(const Line3d& line, const NormalizedCloud& cloud, int num_threads) {
  const std::vector<int> samples = drawSamples(cloud.points.cols(), kSpectrumSamples, 1);
  const PlaneLattice fan{line, kAngles, 0.0, 0};
  std::vector<double> mean(kAngles, 0.0);
  parallelBlocks(kAngles, num_threads, [&](std::size_t k) {
    const ReflectionPlane plane = cloud.toInput(fan.plane(static_cast<double>(k)));
    for (const int i : samples)
      mean[k] += cloud.edt(plane.reflect(cloud.points.col(i).cast<double>() * cloud.scale + cloud.center));
  });
  std::vector<std::complex<double>> spectrum(kMostFrequency + kBeside + 1, 0.0);
  for (std::size_t m = 1; m < spectrum.size(); ++m)
    for (int k = 0; k < kAngles; ++k)
      spectrum[m] += mean[k] * std::polar(1.0, -2.0 * kPi * static_cast<double>(m) * k / kAngles);
  return spectrum;
}

/// Power of a frequency, in units of that of those beside it.
double prominence(const std::vector<std::complex<double>>& spectrum, int m) {
  std::vector<double> beside;
  for (int k = std::max(1, m - kBeside); k <= m + kBeside; ++k)
    if (k != m) beside.push_back(std::norm(spectrum[k]));
  return std::norm(spectrum[m]) / std::max(median(beside), kLeastPower);
}

/// What several planes say together.
double confidenceTogether(const std::vector<JudgedPlane>& judged, int first, int step) {
  PlaneEvidence mean = judged[first].evidence;
  // derived: what differs from plane to plane of a cloud
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
double leastTogether(const std::vector<JudgedPlane>& judged) {
  double least = confidenceTogether(judged, 0, 1);
  for (const int divisor : kDivisors)
    if (judged.size() % divisor == 0 && judged.size() > static_cast<std::size_t>(divisor))
      for (int first = 0; first < divisor; ++first) least = std::min(least, confidenceTogether(judged, first, divisor));
  return least;
}

/// \param planes most confident first, input frame.
std::optional<PlaneLattice> bestLattice(const std::vector<SymmetryPlane>& planes, const NormalizedCloud& cloud,
                                        int num_threads) {
  std::vector<ReflectionPlane> likely;
  for (const SymmetryPlane& plane : planes)
    if (const ReflectionPlane normalized = cloud.toNormalized(plane);
        (plane.kind == PlaneKind::Symmetry || plane.kind == PlaneKind::Possible) &&
        !basinTolerance().anySame(likely, normalized))
      likely.push_back(normalized);
  const std::size_t size = std::min(likely.size(), kMostLinePairs);
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (likely[i].angleTo(likely[j]) >= kLeastLineAngle)
        if (const auto lattice = latticeBySpectrum(cloud, commonLine({likely[i], likely[j]}), num_threads))
          return lattice;
  return std::nullopt;
}

}  // namespace

std::optional<PlaneLattice> latticeBySpectrum(const NormalizedCloud& cloud, const Line3d& line, int num_threads) {
  const std::vector<std::complex<double>> spectrum = spectrumAbout(line, cloud, num_threads);
  int fold = 0;
  double most = kStandsOut;
  for (int m = kLeastFold; m <= kMostFrequency; ++m) {
    const double now = prominence(spectrum, m);
    if (now < most) continue;
    most = now;
    fold = m;
  }
  if (fold == 0) return std::nullopt;
  // A polygon has the multiples of its frequency, too; and so have two planes across each other, with the frequency 2.
  for (int m = 2; m < fold; ++m)
    if (fold % m == 0 && prominence(spectrum, m) >= kStandsOut) {
      fold = m;
      break;
    }
  if (fold < kLeastFold) return std::nullopt;
  return PlaneLattice{line, fold, -std::arg(spectrum[fold]) / (2.0 * fold), 0};
}

PlanesAndPolygon withPolygon(std::vector<SymmetryPlane> planes, const NormalizedCloud& cloud, const PlaneJudge& judge,
                             const DetectionOptions& options) {
  if (!cloud.isVolume()) return {std::move(planes), std::nullopt};
  std::stable_sort(planes.begin(), planes.end(),
                   [](const SymmetryPlane& a, const SymmetryPlane& b) { return a.confidence > b.confidence; });
  const std::optional<PlaneLattice> lattice = bestLattice(planes, cloud, options.num_threads);
  if (!lattice) return {std::move(planes), std::nullopt};
  std::vector<Candidate> candidates;
  for (int k = 0; k < lattice->fold; ++k) candidates.push_back({lattice->plane(k), false});
  std::vector<JudgedPlane> judged = judge.judgeWithEvidence(candidates);
  const double together = leastTogether(judged);
  if (together < options.min_confidence) return {std::move(planes), std::nullopt};
  // All planes tell where the polygon lies: those that noise moved away from their place make way.
  planes.erase(std::remove_if(planes.begin(), planes.end(),
                              [&](const SymmetryPlane& plane) {
                                return contains(cloud.toNormalized(plane), lattice->line, kContainedOffset);
                              }),
               planes.end());
  for (JudgedPlane& one : judged) {
    judge.decide(one.plane, std::max(one.plane.confidence, together));
    planes.push_back(std::move(one.plane));
  }
  return {std::move(planes), lattice};
}

}  // namespace pcl_symmetry
